//! `projection`: the implicit surface of points whose part across the axis has
//! the length of the radius.
//!
//! With a point c of the axis and its unit direction a, the projection of
//! `x - c` onto the axis is `y = <x - c, a> a`, and the infinite wall is
//!
//! ```text
//! |(x - c) - <x - c, a> a|² = r²
//! ```
//!
//! With `x = o + t d` the coefficients of t are those of `center-dot`, whose
//! code it shares, disks included. What differs is the normal: the gradient of
//! the implicit function, `(x - c) - y`, normalised where `center-dot` divides
//! by the radius, so that it has length 1 even where x is off the wall.
//!
//! Additions: c is the center, and the ends are those of `center-dot`.

use super::adapter::Solver;
use super::center_dot;
use super::textbook::{CenterRecord, disk_normal};
use cyltrace::math::{RayOf, Real, RealVector};
use cyltrace::solid::{Cylinder, Part};

/// The formulation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projection;

impl<S: Real> Solver<S> for Projection {
    type Record = CenterRecord<S>;

    fn name(&self) -> &'static str {
        "projection"
    }

    fn record(&self, cylinder: &Cylinder) -> Self::Record {
        CenterRecord::of(cylinder)
    }

    #[inline(always)]
    fn first(&self, record: &Self::Record, ray: &RayOf<S>) -> Option<(S, Part)> {
        center_dot::first(record, ray)
    }

    fn normal(&self, record: &Self::Record, ray: &RayOf<S>, t: S, part: Part) -> S::Vector {
        if part != Part::Side {
            return disk_normal::<S>(record.axis, part);
        }
        let from_center = ray.at(t) - record.center;
        let y = record.axis * from_center.dot(record.axis);
        (from_center - y).normalize()
    }
}
