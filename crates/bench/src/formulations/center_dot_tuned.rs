//! `center-dot-tuned`: the formula of `center-dot` in the code shape of the
//! triple product.
//!
//! For a fair comparison of time: what is the formula's and what is the way
//! it is written? A ray that misses the infinite wall leaves before any root
//! and any division, by half of the linear coefficient:
//!
//! ```text
//! a = d·d - (d·axis)²,   b = d·oc - (d·axis)(oc·axis),   c = oc·oc - (oc·axis)² - R²
//! D = b² - a c,   t = (-b ∓ √D) / a
//! ```
//!
//! The overlap with the slab between the disks and the choice of the hit are
//! the very code of the triple product. It loses what `center-dot` loses.

use super::adapter::Solver;
use super::textbook::CenterRecord;
use super::{CenterDot, triple_product};
use cyltrace::math::{RayOf, Real, RealVector};
use cyltrace::solid::slab::{Question, Slab, Wall};
use cyltrace::solid::{Cylinder, Part};

/// The formulation.
#[derive(Clone, Copy, Debug)]
pub(super) struct CenterDotTuned;

impl<S: Real> Solver<S> for CenterDotTuned {
    type Record = CenterRecord<S>;

    fn name(&self) -> &'static str {
        "center-dot-tuned"
    }

    fn record(&self, cylinder: &Cylinder) -> Self::Record {
        CenterRecord::of(cylinder)
    }

    #[inline(always)]
    fn first(&self, record: &Self::Record, ray: &RayOf<S>) -> Option<(S, Part)> {
        let hit = answer(record, ray, triple_product::first_of(record.caps, ray))?;
        Some((hit.t, hit.part))
    }

    fn normal(&self, record: &Self::Record, ray: &RayOf<S>, t: S, part: Part) -> S::Vector {
        CenterDot.normal(record, ray, t, part)
    }
}

/// The roots of the wall.
struct Roots<S> {
    a: S,
    b: S,
    s: S,
}

impl<S: Real> Wall<S> for Roots<S> {
    #[inline(always)]
    fn enter(&self) -> S {
        (-self.b - self.s) / self.a
    }

    #[inline(always)]
    fn leave(&self) -> S {
        (self.s - self.b) / self.a
    }
}

#[inline(always)]
fn answer<S: Real, Q: Question<S>>(
    record: &CenterRecord<S>,
    ray: &RayOf<S>,
    question: Q,
) -> Option<Q::Answer> {
    let (d, axis) = (ray.direction, record.axis);
    let oc = ray.origin - record.center;
    let (d_axis, oc_axis) = (d.dot(axis), oc.dot(axis));
    let a = d.dot(d) - d_axis * d_axis;
    let b = d.dot(oc) - d_axis * oc_axis;
    let c = oc.dot(oc) - oc_axis * oc_axis - record.radius * record.radius;
    let slab = Slab {
        height: record.half_height + record.half_height,
        position: oc_axis + record.half_height,
        slope: d_axis,
    };
    if !(a > S::ZERO) {
        return if c <= S::ZERO {
            question.of_chord(slab.along(c == S::ZERO)?)
        } else {
            None
        };
    }
    let discriminant = b * b - a * c;
    if !(discriminant >= S::ZERO) {
        return None;
    }
    let s = discriminant.sqrt();
    question.of_overlap(&slab.overlap(Roots { a, b, s }))
}
