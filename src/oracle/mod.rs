//! Exact truth about rays and cylinders.
//!
//! Everything here is computed in exact binary arithmetic of any length, with
//! formulas that the solvers do not use, and shares no code with them. It is
//! some thousand times slower than a solver and decides what is right.

mod cylinder;
mod number;

pub use cylinder::{CylinderTruth, TrueHit, first_hit};
pub use number::{Exact, ExactVector, exact, to_f64};
