//! Embree behind a safe surface: devices, scenes, user geometry, triangle
//! meshes, straight curves, spheres, disks and instances, queries of single rays and of packets of
//! up to sixteen, and all hits of a ray with triangles or curves.
//!
//! This layer knows neither solids nor scene files. A geometry written in
//! Rust implements [`UserGeometry`]; its answers travel in a [`Query`], a value
//! of the caller's own type that every callback of one ray receives, or in the
//! like of a packet. Embree 3 and 4 look the same from here: `shim.c` owns their
//! differences.
//!
//! Rays must be finite: distributions build Embree with its assertions on, and
//! those end the process on a NaN, an infinity or a coordinate beyond
//! [`GREATEST_COORDINATE`]. Callers guarantee it; [`Ray32`] says what exactly.
//!
//! # Invariants
//! Every `unsafe` block of this layer rests on one or more of these:
//!
//! 1. **Handles are alive.** A handle newtype owns one reference of Embree's
//!    and gives it back in its `Drop`, so a handle that can be named is valid.
//! 2. **Scenes go first.** [`Scene`] and [`SceneBuilder`] drop the Embree scene
//!    (with it, its geometries), then the user data, then the scenes that it has
//!    instances of, then the device; a device gives its handle back before its
//!    memory counters. So every pointer that Embree keeps outlives the Embree
//!    object that keeps it.
//! 3. **User data has one type and is shared.** The data pointer of a geometry
//!    and its callbacks are set together, for the same type, from an `Arc`
//!    that is never written to; `UserGeometry` is `Send + Sync`, so any thread
//!    may read it.
//! 4. **A query pointer is a `&mut Q` of the query that runs,** or the
//!    `&mut Q::Packet` if the context says that it is a packet's. It is made from
//!    one by [`Scene`], goes through Embree untouched in the context of that
//!    query, and callbacks of the query run on the calling thread, one at a
//!    time. A geometry's `Query` is its scene's `Q`; the filter function that
//!    collects hits `H` is set in scenes whose `Q` is `Vec<H>`, by code that
//!    exists for those only; of their `Packet` there is no value. An instanced scene has the `Q` of the scene that
//!    it is placed in, so that callbacks in an instance get the same pointer. A nested query borrows from the reference
//!    its callback was given and ends before it.
//! 5. **Builders write, scenes read.** Until [`SceneBuilder::commit`] one owner
//!    has the Embree scene and no query can run; afterwards nothing is
//!    written, and Embree's queries may run on any number of threads.
//! 6. **Bindings are of the installed headers.** `build.rs` generates them, and
//!    [`Device::new`] refuses a library that writes another hit layout. It tries
//!    a single ray: what may differ between libraries is how many words of
//!    instances end a hit, and the layouts of packets have the same words, one
//!    a lane.
//! 7. **Callback arguments are whole.** Embree passes a structure that is valid
//!    for the call, in the layout of its headers; rays and hits in it are
//!    arrays by component, `N` lanes each.
//! 8. **No unwinding.** A panic in a callback ends the process and names the
//!    callback, so no frame of Embree's is ever unwound.
//! 9. **The processor has the instructions.** Code for an instruction set is
//!    called where [`MaxIsa`] found the processor to have it
//!    every feature that the code is compiled with.
//!
//! # What is left out, and why
//! | Embree | why |
//! |---|---|
//! | instances of more than one level, instance arrays | further levels are user geometry: f64 transforms, any depth |
//! | ray streams | gone in Embree 4 |
//! | filter functions but the one that collects, ray masks | a user geometry itself accepts or refuses; all masks are ones |
//! | motion blur, subdivision, grids, ray-facing disks, other curves | nothing here moves or is made of them |
//! | point queries, collision | other questions than rays ask |
//! | updates of a committed scene | a committed scene is read-only, which is what makes it shareable |

#![allow(
    unsafe_code,
    reason = "calls into C; each block names the invariants it rests on"
)]

mod abort;
mod attach_user;
mod callback;
mod collect;
mod device;
mod error;
mod float_mode;
mod geometry;
mod instance;
mod isa;
mod joint;
mod kernel;
mod native;
mod packet;
mod prefetch;
mod probe;
mod query;
mod ray;
mod ray_set;
mod scene;
mod sys;
mod types;
mod user;

pub use collect::MeshHit;
pub use device::{Device, DeviceOptions};
pub use error::Error;
pub use float_mode::with_flushed_denormals;
pub use isa::{MaxIsa, UnknownIsa};
pub use joint::JointCommit;
pub use kernel::{Instructions, Kernel};
pub use packet::{Coherence, Rays32};
pub(crate) use prefetch::prefetch;
pub use query::{NoPackets, Query};
pub use ray::{Box32, NativeHit, Ray32};
pub use ray_set::{GREATEST_PACKET, RayNumbers, RaySet};
pub use scene::{Scene, SceneBuilder};
pub use types::{GREATEST_COORDINATE, GeometryId, PacketWidth, Version};
pub use user::{Reached, UserGeometry};
