//! The known ways of intersecting a ray with a cylinder, side by side.
//!
//! Each is a file of its own, written as its source states it. They are for
//! comparison: the tracer uses [`triple_product`](super::triple_product).

use glam::DVec3;

use super::{Cylinder, Part};
use crate::math::Ray;

/// The arithmetic of a formulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Precision {
    /// Single precision.
    F32,
    /// Double precision.
    F64,
}

impl Precision {
    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}

/// What a formulation says of a ray that hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The ray's parameter.
    pub t: f64,
    /// The part of the surface.
    pub part: Part,
    /// The unit normal, outward unless the formulation says otherwise.
    pub normal: DVec3,
}

/// A ray and the one cylinder that it is asked about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Problem {
    /// The cylinder.
    pub cylinder: Cylinder,
    /// The ray.
    pub ray: Ray,
}

/// A way of intersecting a ray with a cylinder.
pub trait Formulation: Send + Sync {
    /// The name in tables and on the command line, such as `centre-dot`.
    fn name(&self) -> &'static str;

    /// The precision it computes in.
    fn precision(&self) -> Precision;

    /// Bytes kept for a cylinder.
    fn bytes(&self) -> usize;

    /// The answer for each problem.
    fn answers(&self, problems: &[Problem]) -> Vec<Option<Answer>>;

    /// The problems in the form that the formulation works on, so that only
    /// its own work is timed.
    fn batch(&self, problems: &[Problem]) -> Box<dyn Batch>;
}

/// Problems that are ready to be solved.
pub trait Batch: Send {
    /// Solves all of them once (hit or miss, `t` and part, no normal) and
    /// answers with a number that depends on every answer.
    fn run(&self) -> u64;
}
