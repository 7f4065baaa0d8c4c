//! `triple-product`: the library's own solver, and with its products prepared.
//!
//! The formula and why it is accurate are at the top of
//! [`cyltrace::solid::triple_product`], whose code this is. In f64 the record of
//! `triple-product` is the cylinder as stated and the answers are the tracer's;
//! in f32 endpoints and radius are rounded to f32.
//!
//! `triple-product-prepared` keeps what does not depend on the ray: `a`,
//! `|a|²`, `|a|` and `radius² |a|²`. It computes the same numbers,
//! so its answers are the same to the last bit; it spares some products and a
//! root for more memory a cylinder.
//!
//! Normals are those that the library reports, at the solver's `t`.

use glam::DVec3;

use super::adapter::Solver;
use cyltrace::math::{RayOf, Real, RealVector};
use cyltrace::solid::slab::FirstIntersection;
use cyltrace::solid::triple_product::{Axis, StatedAxis, answer};
use cyltrace::solid::{Caps, Cylinder, Part, surface_point};

/// The formulation that stores the cylinder as stated.
#[derive(Clone, Copy, Debug)]
pub(super) struct TripleProduct;

/// A cylinder as stated.
#[derive(Clone, Copy, Debug)]
pub(super) struct StatedRecord<S: Real> {
    p0: S::Vector,
    p1: S::Vector,
    radius: S,
    caps: Caps,
}

impl<S: Real> StatedRecord<S> {
    /// The cylinder, in f64 numbers.
    #[inline]
    pub fn cylinder(&self) -> Cylinder {
        let (p0, p1) = (self.p0.to_f64(), self.p1.to_f64());
        Cylinder::from_valid(p0, p1, self.radius.to_f64(), self.caps)
    }
}

impl<S: Real> Solver<S> for TripleProduct {
    type Record = StatedRecord<S>;

    fn name(&self) -> &'static str {
        "triple-product"
    }

    fn record(&self, cylinder: &Cylinder) -> Self::Record {
        StatedRecord {
            p0: S::Vector::from_f64(cylinder.p0()),
            p1: S::Vector::from_f64(cylinder.p1()),
            radius: S::from_f64(cylinder.radius()),
            caps: cylinder.caps(),
        }
    }

    #[inline(always)]
    fn first(&self, record: &Self::Record, ray: &RayOf<S>) -> Option<(S, Part)> {
        let axis = StatedAxis::<S> {
            a: record.p1 - record.p0,
            radius: record.radius,
        };
        let first = first_of(record.caps, ray);
        let hit = answer(&axis, ray.origin - record.p0, ray.direction, first)?;
        Some((hit.t, hit.part))
    }

    fn normal(&self, record: &Self::Record, ray: &RayOf<S>, t: S, part: Part) -> S::Vector {
        normal(record.p0, record.p1 - record.p0, ray, t, part)
    }
}

/// The formulation that stores products.
#[derive(Clone, Copy, Debug)]
pub(super) struct TripleProductPrepared;

/// A cylinder with every product that the solver takes of it alone.
#[derive(Clone, Copy, Debug)]
pub(super) struct PreparedRecord<S: Real> {
    p0: S::Vector,
    a: S::Vector,
    radius: S,
    aa: S,
    length: S,
    rr_aa: S,
    caps: Caps,
}

impl<S: Real> Axis<S> for PreparedRecord<S> {
    #[inline]
    fn a(&self) -> S::Vector {
        self.a
    }

    #[inline]
    fn radius(&self) -> S {
        self.radius
    }

    #[inline]
    fn aa(&self) -> S {
        self.aa
    }

    #[inline]
    fn length(&self) -> S {
        self.length
    }

    #[inline]
    fn rr_aa(&self) -> S {
        self.rr_aa
    }
}

impl<S: Real> Solver<S> for TripleProductPrepared {
    type Record = PreparedRecord<S>;

    fn name(&self) -> &'static str {
        "triple-product-prepared"
    }

    fn record(&self, cylinder: &Cylinder) -> Self::Record {
        let stated: StatedRecord<S> = TripleProduct.record(cylinder);
        let axis = StatedAxis::<S> {
            a: stated.p1 - stated.p0,
            radius: stated.radius,
        };
        PreparedRecord {
            p0: stated.p0,
            a: axis.a,
            radius: axis.radius,
            aa: axis.aa(),
            length: axis.length(),
            rr_aa: axis.rr_aa(),
            caps: stated.caps,
        }
    }

    #[inline(always)]
    fn first(&self, record: &Self::Record, ray: &RayOf<S>) -> Option<(S, Part)> {
        let first = first_of(record.caps, ray);
        let hit = answer(record, ray.origin - record.p0, ray.direction, first)?;
        Some((hit.t, hit.part))
    }

    fn normal(&self, record: &Self::Record, ray: &RayOf<S>, t: S, part: Part) -> S::Vector {
        normal(record.p0, record.a, ray, t, part)
    }
}

/// Asks for the first hit in the ray's range.
#[inline(always)]
pub(super) fn first_of<S: Real>(caps: Caps, ray: &RayOf<S>) -> FirstIntersection<S> {
    FirstIntersection {
        caps,
        shift: S::ZERO,
        t_min: ray.t_min,
        t_max: ray.t_max,
    }
}

/// The normal that the library reports for a hit. It depends neither on the
/// radius nor on the caps, and `p0` is where it counts from.
fn normal<S: Real>(p0: S::Vector, a: S::Vector, ray: &RayOf<S>, t: S, part: Part) -> S::Vector {
    let cylinder = Cylinder::from_valid(DVec3::ZERO, a.to_f64(), 1.0, Caps::Both);
    let from_p0 = (ray.origin - p0).to_f64() + ray.direction.to_f64() * t.to_f64();
    S::Vector::from_f64(surface_point(&cylinder, part, from_p0).normal)
}
