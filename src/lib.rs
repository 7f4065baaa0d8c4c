//! Ray tracing of analytic cylinders, cones, spheres, boxes, disks and their set operations
//! through Embree: hits are computed in f64 from the surface itself, never from a mesh.
//!
//! A [`scene::Scene`] is loaded from a file or made in code, a [`tracer::Tracer`] builds it
//! for Embree, and rays are traced one by one or in batches, from any number of threads:
//!
//! ```
//! use std::path::Path;
//! use std::sync::Arc;
//!
//! use cyltrace::glam::DVec3;
//! use cyltrace::math::Ray;
//! use cyltrace::tracer::{Options, Tracer};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = cyltrace::scene::load(Path::new("scenes/minimal.toml"))?;
//! let tracer = Tracer::new(Arc::new(scene), &Options::default())?;
//!
//! // A row of rays straight down, traced as a batch.
//! let ray = |x: f64| Ray::new(DVec3::new(x, 0.1, 10.0), DVec3::NEG_Z);
//! let rays: Vec<Ray> = (-20..20).map(|x| ray(0.1 * f64::from(x))).collect();
//! let mut hits = Vec::new();
//! tracer.closest_batch(&rays, &mut hits);
//!
//! for hit in hits.iter().flatten() {
//!     println!("t = {}: the {} of {}", hit.t, hit.part.name(), hit.solid.name());
//!     // The point is at most this far from the surface.
//!     assert!(hit.error < 1e-14);
//! }
//! assert_eq!(hits[10], tracer.closest(&rays[10]));
//! # Ok(())
//! # }
//! ```
//!
//! - [`math`]: rays, placements and bounds;
//! - [`solid`]: the kinds of solids and their solvers;
//! - [`scene`]: scene files, tables and what they describe;
//! - [`tracer`]: hits of rays with scenes;
//! - [`meshes`]: meshes of solids, written and read;
//! - [`embree`]: Embree's scenes, made safe.
//!
//! # Features
//! - `three-mf`: scene files may contain beam lattices from 3MF files;
//! - `counters`: counts callbacks and solves, for benchmarks.

/// The vectors and matrices of this library's interface.
pub use glam;

pub mod embree;
pub mod math;
pub mod meshes;
pub mod scene;
pub mod solid;
pub mod tracer;

// Compiles and runs the example in Rust of the guide.
#[cfg(doctest)]
#[doc = include_str!("../docs/guide.md")]
struct Guide;
