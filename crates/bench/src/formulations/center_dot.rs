//! `center-dot`: dot products from the cylinder's center.
//!
//! With the center C, the unit axis a, the radius R, the height H and
//! `oc = o - C`, the points of the ray on the infinite wall satisfy
//!
//! ```text
//! (d·d - (d·a)²) t² + 2 (d·oc - (d·a)(oc·a)) t + oc·oc - (oc·a)² - R² = 0
//! ```
//!
//! and a point M of the wall is on the cylinder where `|(M - C)·a| <= H/2`.
//! The normal there is `(CM - (CM·a) a) / R`, with `CM = M - C`.
//!
//! What cancels: `oc·oc - (oc·a)²` loses the square of the origin's distance
//! over the radius, and of the length over the radius.
//!
//! Additions: the source is silent about disks. A ray hits them where
//! `(M - C)·a = ∓H/2` and hit where M is within R of the axis, computed as the
//! quadratic computes it: `CM·CM - (CM·a)² <= R²`.

use super::adapter::Solver;
use super::textbook::{CenterRecord, Nearest, Quadratic, disk_normal};
use cyltrace::math::{RayOf, Real, RealVector};
use cyltrace::solid::{Cylinder, Part};

/// The formulation.
#[derive(Clone, Copy, Debug)]
pub(super) struct CenterDot;

impl<S: Real> Solver<S> for CenterDot {
    type Record = CenterRecord<S>;

    fn name(&self) -> &'static str {
        "center-dot"
    }

    fn record(&self, cylinder: &Cylinder) -> Self::Record {
        CenterRecord::of(cylinder)
    }

    #[inline(always)]
    fn first(&self, record: &Self::Record, ray: &RayOf<S>) -> Option<(S, Part)> {
        first(record, ray)
    }

    fn normal(&self, record: &Self::Record, ray: &RayOf<S>, t: S, part: Part) -> S::Vector {
        if part != Part::Side {
            return disk_normal::<S>(record.axis, part);
        }
        let cm = ray.at(t) - record.center;
        (cm - record.axis * cm.dot(record.axis)) / record.radius
    }
}

/// The first hit; `projection` finds it in the same way.
#[inline(always)]
pub(super) fn first<S: Real>(record: &CenterRecord<S>, ray: &RayOf<S>) -> Option<(S, Part)> {
    let (d, axis) = (ray.direction, record.axis);
    let oc = ray.origin - record.center;
    let mut nearest = Nearest::new(ray.t_min, ray.t_max);

    // The wall, at either root.
    let wall = Quadratic::<S>::of_distance(oc, d, axis, record.radius);
    if let Some(roots) = wall.roots() {
        for t in roots {
            let cm = ray.at(t) - record.center;
            if nearest.wants(t) && cm.dot(axis).abs() <= record.half_height {
                nearest.take(t, Part::Side);
            }
        }
    }

    // The disks.
    for (is_there, height, part) in record.disks() {
        let t = (height - oc.dot(axis)) / d.dot(axis);
        if is_there && nearest.wants(t) {
            let cm = ray.at(t) - record.center;
            let along = cm.dot(axis);
            if cm.dot(cm) - along * along <= record.radius * record.radius {
                nearest.take(t, part);
            }
        }
    }
    nearest.found()
}
