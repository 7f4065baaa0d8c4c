//! `start-cap`: dot products from the middle of the first disk.
//!
//! With C the middle of the disk at the start, the unit axis V and `X = O - C`,
//! a point `P = O + D t` has the axial position `m = D·V t + X·V`, and it is on
//! the infinite wall where `|P - C - V m| = r`:
//!
//! ```text
//! (D·D - (D·V)²) t² + 2 (D·X - (D·V)(X·V)) t + X·X - (X·V)² - r² = 0
//! ```
//!
//! It is on the cylinder where `0 <= m <= length`; the normal is
//! `P - C - V m`, normalised. The algebra is that of `center-dot` seen from
//! another point, and loses the same; m is linear in t, without the point.
//!
//! Additions: the source names the caps but not their test. A ray hits a disk where
//! m is 0 or `length`, and hit where `|P - C - V m|² <= r²`.

use super::adapter::Solver;
use super::textbook::{Nearest, Quadratic, disk_normal};
use cyltrace::math::{RayOf, Real, RealVector};
use cyltrace::solid::{Caps, Cylinder, Part};

/// The formulation.
#[derive(Clone, Copy, Debug)]
pub(super) struct StartCap;

/// A cylinder as the middle of its first disk, unit axis, radius and length.
#[derive(Clone, Copy, Debug)]
pub(super) struct StartRecord<S: Real> {
    start: S::Vector,
    axis: S::Vector,
    radius: S,
    length: S,
    caps: Caps,
}

impl<S: Real> Solver<S> for StartCap {
    type Record = StartRecord<S>;

    fn name(&self) -> &'static str {
        "start-cap"
    }

    fn record(&self, cylinder: &Cylinder) -> Self::Record {
        let along = cylinder.p1() - cylinder.p0();
        StartRecord {
            start: S::Vector::from_f64(cylinder.p0()),
            axis: S::Vector::from_f64(along.normalize()),
            radius: S::from_f64(cylinder.radius()),
            length: S::from_f64(along.length()),
            caps: cylinder.caps(),
        }
    }

    #[inline(always)]
    fn first(&self, record: &Self::Record, ray: &RayOf<S>) -> Option<(S, Part)> {
        let (d, axis) = (ray.direction, record.axis);
        let x = ray.origin - record.start;
        let (d_axis, x_axis) = (d.dot(axis), x.dot(axis));
        let mut nearest = Nearest::new(ray.t_min, ray.t_max);

        // The wall, at either root.
        let wall = Quadratic::<S>::of_distance(x, d, axis, record.radius);
        if let Some(roots) = wall.roots() {
            for t in roots {
                let m = d_axis * t + x_axis;
                if nearest.wants(t) && S::ZERO <= m && m <= record.length {
                    nearest.take(t, Part::Side);
                }
            }
        }

        // The disks.
        let disks = [
            (record.caps.at_p0(), S::ZERO, Part::Cap0),
            (record.caps.at_p1(), record.length, Part::Cap1),
        ];
        for (is_there, m, part) in disks {
            let t = (m - x_axis) / d_axis;
            if is_there && nearest.wants(t) {
                let from_middle = ray.at(t) - record.start - axis * m;
                if from_middle.dot(from_middle) <= record.radius * record.radius {
                    nearest.take(t, part);
                }
            }
        }
        nearest.found()
    }

    fn normal(&self, record: &Self::Record, ray: &RayOf<S>, t: S, part: Part) -> S::Vector {
        if part != Part::Side {
            return disk_normal::<S>(record.axis, part);
        }
        let x = ray.origin - record.start;
        let m = ray.direction.dot(record.axis) * t + x.dot(record.axis);
        (ray.at(t) - record.start - record.axis * m).normalize()
    }
}
