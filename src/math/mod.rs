//! Rays, boxes, transforms and random numbers, on top of glam's f64 vectors.
//!
//! This layer knows nothing of the rest of the crate. Everything here is f64;
//! f32 appears only where a value is handed to Embree, and is then rounded in
//! a stated direction.

mod bounds;
mod random;
mod ray;

pub use bounds::Bounds;
pub use random::Random;
pub use ray::Ray;
