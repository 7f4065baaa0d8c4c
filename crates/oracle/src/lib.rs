//! Exact truth about rays and solids.
//!
//! Everything here is computed in exact binary arithmetic of any length, with
//! formulas that the solvers do not use, and shares no code with them. It is
//! some thousand times slower than a solver and decides what is right.

mod affine;
mod any;
pub mod cases;
mod change;
mod chord;
mod composed;
mod cone;
mod cuboid;
mod cylinder;
mod disk;
mod distance;
mod ends;
mod gap;
mod normal;
mod number;
mod ray;
mod rounded_cone;
mod sphere;
mod taper;
mod taper_points;
mod true_cylinder;

pub use affine::{ExactAffine, ExactMatrix};
pub use any::{
    TrueSolid, first_hit_of_any, gap_of_any, hits_of_any, outward_normal_of_any,
    placed_hits_of_any, truth,
};
pub use chord::TrueChord;
pub use composed::{ComposedHit, ComposedTruth, Face};
pub use cuboid::cuboid_chord;
pub use cylinder::{CylinderTruth, TrueHit, first_hit, placed_first_hit};
pub use disk::disk_chord;
pub use distance::distance_to_part;
pub use gap::gap;
pub use number::{Exact, ExactVector, exact, to_f64};
pub use ray::ExactRay;
pub use sphere::sphere_chord;
pub use taper_points::{distance_to_cone, distance_to_rounded_cone};
