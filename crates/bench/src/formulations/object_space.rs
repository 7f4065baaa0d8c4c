//! `object-space`: the ray is rotated into the cylinder's own frame.
//!
//! In the frame (r, s, t) with the origin at the center and the t axis along
//! the cylinder, the wall is `r² + s² = a²` for `-b <= t <= b`. A rotation
//! matrix takes the ray there, `D + E λ` with D the origin and E the direction,
//! and the ray hits the infinite wall where
//!
//! ```text
//! A λ² + B λ + C = 0,   A = Er² + Es²,   B = 2 (Dr Er + Ds Es),   C = Dr² + Ds² - a²
//! ```
//!
//! The disks are in the planes `t = ∓b`, where `r² + s² <= a²`. Roots are by the
//! textbook formula. The frame is stored rounded, so it is not quite a
//! rotation; C loses the square of the distance to the axis over the radius.
//!
//! The source compares with a tolerance EPSILON. It is absolute: it means
//! something else in every unit of length and of direction, and there is no
//! value that is right. It replaces zero in four places here:
//!
//! 1. a ray with `|A| < EPSILON` is parallel to the axis and has no wall;
//! 2. a ray with `|Et| < EPSILON` is across it and has no disks;
//! 3. a hit is farther along the ray than its start by more than EPSILON, so
//!    that a ray does not hit where it was spawned;
//! 4. the ends, `|t| <= b + EPSILON`, and the disks, `r² + s² <= a² + EPSILON`,
//!    reach beyond themselves, so that no ray slips between wall and disk.
//!
//! Addition: the source leaves open where EPSILON goes and how large it is; the
//! above are its usual places.

use super::adapter::Solver;
use super::textbook::{Nearest, Quadratic, disk_normal};
use cyltrace::math::{RayOf, Real, RealVector};
use cyltrace::solid::angle_frame;
use cyltrace::solid::{Caps, Cylinder, Part};

/// The default tolerance: a size that suits scenes of
/// about unit size in single precision, as the source has in mind.
pub const DEFAULT_TOLERANCE: f64 = 1e-6;

/// The formulation.
#[derive(Clone, Copy, Debug)]
pub(super) struct ObjectSpace {
    /// EPSILON, in the units of whatever it is compared with.
    pub tolerance: f64,
}

/// A cylinder as its frame, radius a and half height b.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameRecord<S: Real> {
    center: S::Vector,
    /// The rows of the rotation into the frame: its axes r, s and t.
    axes: [S::Vector; 3],
    a: S,
    b: S,
    caps: Caps,
}

impl<S: Real> FrameRecord<S> {
    /// The components along r, s and t.
    #[inline]
    fn rotated(&self, v: S::Vector) -> [S; 3] {
        self.axes.map(|axis| axis.dot(v))
    }
}

impl<S: Real> Solver<S> for ObjectSpace {
    type Record = FrameRecord<S>;

    fn name(&self) -> &'static str {
        "object-space"
    }

    fn record(&self, cylinder: &Cylinder) -> Self::Record {
        let (p0, p1) = (cylinder.p0(), cylinder.p1());
        let t = (p1 - p0).normalize();
        let (r, s) = angle_frame(t);
        FrameRecord {
            center: S::Vector::from_f64((p0 + p1) * 0.5),
            axes: [r, s, t].map(S::Vector::from_f64),
            a: S::from_f64(cylinder.radius()),
            b: S::from_f64((p1 - p0).length() * 0.5),
            caps: cylinder.caps(),
        }
    }

    #[inline(always)]
    fn first(&self, record: &Self::Record, ray: &RayOf<S>) -> Option<(S, Part)> {
        let epsilon = S::from_f64(self.tolerance);
        let [dr, ds, dt] = record.rotated(ray.origin - record.center);
        let [er, es, et] = record.rotated(ray.direction);
        let aa = record.a * record.a;
        let mut nearest = Nearest::new(ray.t_min, ray.t_max);
        let starts_before = |lambda: S| lambda - ray.t_min > epsilon;

        // The wall, at either root.
        let wall = Quadratic {
            a: er * er + es * es,
            b: S::from_f64(2.0) * (dr * er + ds * es),
            c: dr * dr + ds * ds - aa,
        };
        if wall.a.abs() >= epsilon
            && let Some(roots) = wall.roots()
        {
            for lambda in roots {
                let t = dt + et * lambda;
                let within = t.abs() <= record.b + epsilon;
                if within && starts_before(lambda) && nearest.wants(lambda) {
                    nearest.take(lambda, Part::Side);
                }
            }
        }

        // The disks.
        if et.abs() >= epsilon {
            let disks = [
                (record.caps.at_p0(), -record.b, Part::Cap0),
                (record.caps.at_p1(), record.b, Part::Cap1),
            ];
            for (is_there, t, part) in disks {
                let lambda = (t - dt) / et;
                let (r, s) = (dr + er * lambda, ds + es * lambda);
                let within = is_there && r * r + s * s <= aa + epsilon;
                if within && starts_before(lambda) && nearest.wants(lambda) {
                    nearest.take(lambda, part);
                }
            }
        }
        nearest.found()
    }

    /// On the wall, the direction of (r, s) rotated back.
    fn normal(&self, record: &Self::Record, ray: &RayOf<S>, t: S, part: Part) -> S::Vector {
        let [across, along, axis] = record.axes;
        if part != Part::Side {
            return disk_normal::<S>(axis, part);
        }
        let [r, s, _] = record.rotated(ray.at(t) - record.center);
        (across * r + along * s).normalize()
    }
}
