//! Rays, boxes, roundings and random numbers, on top of glam's f64 vectors.
//!
//! This layer does not depend on the rest of the crate. Numbers are f64, with two
//! exceptions: values for Embree are rounded to f32 in a stated direction, and
//! [`Real`] lets a solver exist in both precisions. [`Lanes`] are eight f64 that
//! the same sources compute at once.

mod bounds;
mod double_double;
mod lanes;
mod morton;
mod orientation;
mod placement;
mod pose;
mod random;
mod ray;
mod real;
mod rotation;
mod rounding;

pub use bounds::Bounds;
pub use double_double::DoubleDouble;
pub use lanes::{LANES, LaneMask, LaneVectors, Lanes};
pub use morton::{morton_code_2, morton_code_3};
pub use orientation::Orientation;
pub use placement::{ChildFromParent, PlacementErrors, frobenius_norm};
pub use pose::Pose;
pub use random::Random;
pub use ray::{DIRECTION_SIZES, GREATEST_ORIGIN, Ray, RayOf, RaySizeError};
pub use real::{Real, RealVector, Wide, wide_cross, wide_square};
pub use rotation::{is_unit, rotation, sin_cos_degrees, unit, unit_or_same};
pub use rounding::{UNIT_ROUNDOFF, f32_above, f32_below, power_of_two, power_of_two_below};
