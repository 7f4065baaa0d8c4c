//! What the Embree layer promises: lifetimes, threads, floating-point mode,
//! panics, memory, and right answers of user and native geometry. A picture
//! proves none of it.

mod balls;
mod collect;
mod docs_bindings;
mod instance;
mod joint;
mod lifetime;
mod locate;
mod native;
mod packets;
mod panics;
mod queries;
