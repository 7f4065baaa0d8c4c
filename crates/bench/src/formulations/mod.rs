//! The known ways of intersecting a ray with a cylinder, side by side.
//!
//! Each is a file of its own, written as its source states it. They are for
//! comparison: the tracer uses [`triple_product`](cyltrace::solid::triple_product).
//!
//! | name | from |
//! |---|---|
//! | `center-dot` | dot products with a unit axis, from the center |
//! | `center-dot-tuned` | the same formula in the triple product's code shape |
//! | `start-cap` | the same algebra from the middle of the first disk |
//! | `projection` | the same coefficients, another normal |
//! | `cross-product` | cross products with a unit axis, one root only |
//! | `cross-product-both` | the same with both roots |
//! | `object-space` | the ray rotated to the cylinder, a tolerance |
//! | `triple-product` | the library's solver |
//! | `triple-product-prepared` | the same with products kept |
//! | `exact` | certified answers, f64 only |
//! | `exact-rounded` | the same with `t` rounded correctly |
//!
//! All share a meaning: the first hit with `t_min <= t <= t_max` on the wall or
//! on a disk that the cylinder has. Each is generic over the precision, and
//! stores a cylinder as its source does, computed in f64 and rounded.

mod adapter;
mod center_dot;
mod center_dot_tuned;
mod cross_product;
mod exact;
mod object_space;
mod projection;
mod start_cap;
#[cfg(test)]
mod tests;
mod textbook;
mod triple_product;

use glam::DVec3;

use adapter::in_precision;
use center_dot::CenterDot;
use center_dot_tuned::CenterDotTuned;
use cross_product::CrossProduct;
use cyltrace::solid::Part;
use exact::Exact;
use object_space::ObjectSpace;
use projection::Projection;
use start_cap::StartCap;
use triple_product::{TripleProduct, TripleProductPrepared};

pub use cyltrace_oracle::cases::Problem;

pub use cross_product::{Facing, Roots};
pub use object_space::DEFAULT_TOLERANCE;

/// The arithmetic of a formulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
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
        self.into()
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

/// A way of intersecting a ray with a cylinder.
pub trait Formulation: Send + Sync {
    /// The name in tables and on the command line, such as `center-dot`.
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

/// What makes a formulation in a precision.
type Maker = fn(Precision) -> Box<dyn Formulation>;

/// Every formulation, in the order of tables.
const MAKERS: [Maker; 11] = [
    |precision| in_precision(CenterDot, precision),
    |precision| in_precision(CenterDotTuned, precision),
    |precision| in_precision(StartCap, precision),
    |precision| in_precision(Projection, precision),
    |precision| cross_product(Roots::First, Facing::Outward, precision),
    |precision| cross_product(Roots::Both, Facing::Outward, precision),
    |precision| object_space(DEFAULT_TOLERANCE, precision),
    |precision| in_precision(TripleProduct, precision),
    |precision| in_precision(TripleProductPrepared, precision),
    |precision| in_precision(Exact::<false>, precision),
    |precision| in_precision(Exact::<true>, precision),
];

/// Every formulation, with its usual arguments, in f32 and then in f64.
#[must_use]
pub fn all() -> Vec<Box<dyn Formulation>> {
    MAKERS
        .iter()
        .flat_map(|make| [make(Precision::F32), make(Precision::F64)])
        .collect()
}

/// The formulation of this name with its usual arguments; `None` for a name
/// that [`all`] does not have in this precision.
#[must_use]
pub fn by_name(name: &str, precision: Precision) -> Option<Box<dyn Formulation>> {
    all()
        .into_iter()
        .find(|known| known.name() == name && known.precision() == precision)
}

/// `cross-product` or, with both roots, `cross-product-both`.
#[must_use]
pub fn cross_product(roots: Roots, facing: Facing, precision: Precision) -> Box<dyn Formulation> {
    in_precision(CrossProduct { roots, facing }, precision)
}

/// `object-space` with the absolute tolerance EPSILON, at least 0, in the units
/// of whatever it is compared with.
#[must_use]
pub fn object_space(tolerance: f64, precision: Precision) -> Box<dyn Formulation> {
    in_precision(ObjectSpace { tolerance }, precision)
}
