//! cyltrace traces analytic cylinders through Embree: exact hits, no meshes,
//! and the proof beside them.

pub mod bench;
pub mod capi;
pub mod cases;
pub mod check;
pub mod embree;
pub mod math;
pub mod mesh_file;
pub mod oracle;
pub mod render;
pub mod report;
pub mod scene;
pub mod solid;
pub mod stress;
pub mod tracer;

// Compiles and runs the README's Rust examples.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
