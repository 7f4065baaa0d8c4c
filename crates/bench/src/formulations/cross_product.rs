//! `cross-product`: cross products with the axis, from the center.
//!
//! With the unit axis a, `oc = o - center`, `m = a × oc` and `n = a × d`, a
//! point of the ray is on the infinite wall where `|m + t n| = r`:
//!
//! ```text
//! |n|² t² + 2 (m·n) t + |m|² - r² = 0
//! ```
//!
//! The source takes the smallest positive root i *before* it looks at the
//! height, and a hit needs `|ci·a| <= h/2`, `ci` from the center to i. So a
//! ray whose first root is beyond an open end misses the inside of the wall
//! behind it: [`Roots::First`]. [`Roots::Both`] goes on to the second root.
//!
//! Its normal is `cn = (ci - (ci·a) a) / r`, turned to the side on which the
//! ray starts, `sgn((o - i)·cn) cn`: [`Facing::Viewer`]. The library's own
//! normals are outward.
//!
//! `|m|² - r²` still loses the square of the distance to the axis over the
//! radius, but not that of the length: `|m|` is the distance across the axis.
//!
//! Additions: "positive" is "within the ray's range" here. The source is silent
//! about disks; they are hit where `|a × ci| <= r` in the plane of an end.

use super::adapter::Solver;
use super::textbook::{CenterRecord, Nearest, Quadratic, disk_normal};
use cyltrace::math::{RayOf, Real, RealVector};
use cyltrace::solid::{Cylinder, Part};

/// Which roots of the quadratic are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Roots {
    /// The first within the ray's range, as in the source.
    First,
    /// The second too, when the first is beyond an end.
    Both,
}

/// To which side a normal points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Out of the solid.
    Outward,
    /// To the side of the surface on which the ray starts.
    Viewer,
}

/// The formulation.
#[derive(Clone, Copy, Debug)]
pub(super) struct CrossProduct {
    pub roots: Roots,
    pub facing: Facing,
}

impl<S: Real> Solver<S> for CrossProduct {
    type Record = CenterRecord<S>;

    fn name(&self) -> &'static str {
        match self.roots {
            Roots::First => "cross-product",
            Roots::Both => "cross-product-both",
        }
    }

    fn record(&self, cylinder: &Cylinder) -> Self::Record {
        CenterRecord::of(cylinder)
    }

    #[inline(always)]
    fn first(&self, record: &Self::Record, ray: &RayOf<S>) -> Option<(S, Part)> {
        let (d, axis) = (ray.direction, record.axis);
        let oc = ray.origin - record.center;
        let mut nearest = Nearest::new(ray.t_min, ray.t_max);

        // The wall.
        let (m, n) = (axis.cross(oc), axis.cross(d));
        let wall = Quadratic {
            a: n.dot(n),
            b: S::from_f64(2.0) * m.dot(n),
            c: m.dot(m) - record.radius * record.radius,
        };
        if let Some(roots) = wall.roots() {
            for t in roots {
                if !nearest.wants(t) {
                    continue;
                }
                let ci = ray.at(t) - record.center;
                if ci.dot(axis).abs() <= record.half_height {
                    nearest.take(t, Part::Side);
                }
                if self.roots == Roots::First {
                    break;
                }
            }
        }

        // The disks.
        for (is_there, height, part) in record.disks() {
            let t = (height - oc.dot(axis)) / d.dot(axis);
            if is_there && nearest.wants(t) {
                let across = axis.cross(ray.at(t) - record.center);
                if across.dot(across) <= record.radius * record.radius {
                    nearest.take(t, part);
                }
            }
        }
        nearest.found()
    }

    fn normal(&self, record: &Self::Record, ray: &RayOf<S>, t: S, part: Part) -> S::Vector {
        let i = ray.at(t);
        let ci = i - record.center;
        let outward = match part {
            Part::Side => (ci - record.axis * ci.dot(record.axis)) / record.radius,
            Part::Cap0 | Part::Cap1 => disk_normal::<S>(record.axis, part),
            part => unreachable!("a cylinder has no part {}", part.name()),
        };
        match self.facing {
            Facing::Viewer if (ray.origin - i).dot(outward) < S::ZERO => -outward,
            Facing::Viewer | Facing::Outward => outward,
        }
    }
}
