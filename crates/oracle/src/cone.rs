//! All hits of a cone, exactly.
//!
//! All points of the boundary that the line goes through are listed: roots of the
//! wall (`taper.rs`) at heights from 0 to `a·a`, and where the line crosses the
//! plane of a disk, if the radius there reaches it. At either height a point of the
//! wall is on the rim and belongs to the disk, if there is one. A line along the
//! wall is on it from disk to disk, one in the plane of a disk from rim to rim.

use std::cmp::Ordering;

use super::change::least_change;
use super::cylinder::TrueHit;
use super::ends::{TrueEnd, hits};
use super::number::{Exact, Surd, sign, zero};
use super::ray::ExactRay;
use super::taper::{Taper, numbers_of};
use cyltrace::math::Ray;
use cyltrace::solid::{Caps, Cone, Cylinder, Part};

/// All points in the ray's range in which it meets the surface, in order; a
/// tangent is an entry and an exit.
#[must_use]
pub fn cone_hits(cone: &Cone, ray: &ExactRay) -> Vec<TrueHit> {
    hits_between_disks(&Taper::new(&numbers(cone, ray), false), cone.caps(), ray)
}

/// The same of a cylinder, which is the cone of equal radii.
#[must_use]
pub(super) fn cylinder_hits(cylinder: &Cylinder, ray: &ExactRay) -> Vec<TrueHit> {
    let ends = [cylinder.p0(), cylinder.p1()];
    let numbers = numbers_of(ends, [cylinder.radius(); 2], ray);
    hits_between_disks(&Taper::new(&numbers, false), cylinder.caps(), ray)
}

fn hits_between_disks(taper: &Taper, caps: Caps, ray: &ExactRay) -> Vec<TrueHit> {
    let (ax, ad, aa) = (&taper.ax, &taper.ad, &taper.aa);
    let along = taper.is_along();
    let mut points = Vec::new();
    let disk_at = |to_p0: Ordering, to_p1: Ordering| match (to_p0, to_p1) {
        (Ordering::Less, _) | (_, Ordering::Greater) => None,
        (Ordering::Equal, _) => Some(Some(Part::Cap0)),
        (_, Ordering::Equal) => Some(Some(Part::Cap1)),
        _ => Some(None),
    };
    for t in taper.wall_points() {
        let (to_p0, to_p1) = (t.sign_of_line(ax, ad), t.sign_of_line(&(ax - aa), ad));
        if let Some(cap) = disk_at(to_p0, to_p1) {
            points.push(TrueEnd {
                t,
                cap,
                on_side: true,
            });
        }
    }
    if sign(ad) == Ordering::Equal {
        let lies_on = disk_at(sign(ax), ax.cmp(aa)).flatten();
        return hits(&points, lies_on, caps, ray);
    }
    for (part, height) in [(Part::Cap0, zero()), (Part::Cap1, aa.clone())] {
        let to_rim = sign(&taper.wall_at(&height));
        if to_rim != Ordering::Greater {
            points.push(TrueEnd {
                t: Surd::quotient(height - ax, ad.clone()),
                cap: Some(part),
                on_side: to_rim == Ordering::Equal,
            });
        }
    }
    hits(&points, along.then_some(Part::Side), caps, ray)
}

/// The least change, the same relative change for every number of the case, after
/// which its answer may be another: to first order, that which makes the line touch
/// the wall, go through a rim or the apex, or brings the origin to the surface.
/// Events that are out of the ray's range count too, so that it is a lower bound.
///
/// # Panics
/// When the ray is not valid.
#[must_use]
pub fn cone_gap(cone: &Cone, ray: &Ray) -> f64 {
    least_change(numbers(cone, &ExactRay::new(ray)), |numbers: &[Exact]| {
        let taper = Taper::new(numbers, false);
        let wall = taper.wall();
        let (rim0, rim1) = (taper.wall_at(&zero()), taper.wall_at(&taper.aa));
        let over_p1 = &taper.ax - &taper.aa;
        vec![wall.discriminant(), rim0, rim1, wall.c, taper.ax, over_p1]
    })
}

/// The numbers of a case, as `Taper::new` takes them.
fn numbers(cone: &Cone, ray: &ExactRay) -> Vec<Exact> {
    numbers_of(
        [cone.p0(), cone.p1()],
        [cone.radius0(), cone.radius1()],
        ray,
    )
}
