//! cyltrace traces analytic cylinders and solids like them through Embree: exact hits,
//! no meshes.

pub mod embree;
pub mod math;
pub mod meshes;
pub mod scene;
pub mod solid;
pub mod tracer;

// Compiles and runs the README's Rust examples.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
