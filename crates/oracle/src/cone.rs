//! All hits of a cone, exactly.
//!
//! All points of the boundary that the line goes through are listed: roots of the
//! wall (`taper.rs`) at heights from 0 to `a·a`, and where the line crosses the
//! plane of a disk, if the radius there reaches it. At either height a point of the
//! wall is on the rim and belongs to the disk, if there is one. A line along the
//! wall is on it from disk to disk, one in the plane of a disk from rim to rim.

use std::cmp::Ordering;

use glam::DVec3;

use super::any::{TrueSolid, from_point, is_at_apex};
use super::change::least_change;
use super::composed::{Leaf, Sheet, TrueOperand};
use super::cylinder::TrueHit;
use super::ends::{TrueEnd, hits};
use super::normal::unit;
use super::number::{Exact, ExactVector, Surd, exact, sign, zero};
use super::ray::ExactRay;
use super::taper::{Taper, numbers_of};
use super::taper_points::of;
use cyltrace::math::Ray;
use cyltrace::solid::{Caps, Cone, Part};

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

/// The numbers of a case, as `Taper::new` takes them.
fn numbers(cone: &Cone, ray: &ExactRay) -> Vec<Exact> {
    numbers_of(
        [cone.p0(), cone.p1()],
        [cone.radius0(), cone.radius1()],
        ray,
    )
}

impl TrueSolid for Cone {
    fn hits(&self, ray: &ExactRay) -> Vec<TrueHit> {
        hits_between_disks(&Taper::new(&numbers(self, ray), false), self.caps(), ray)
    }

    fn gap(&self, ray: &Ray) -> f64 {
        // What makes the line touch the wall, go through a rim or the apex, or brings the
        // origin to the surface.
        least_change(numbers(self, &ExactRay::new(ray)), |numbers: &[Exact]| {
            let taper = Taper::new(numbers, false);
            let wall = taper.wall();
            let (rim0, rim1) = (taper.wall_at(&zero()), taper.wall_at(&taper.aa));
            let over_p1 = &taper.ax - &taper.aa;
            vec![wall.discriminant(), rim0, rim1, wall.c, taper.ax, over_p1]
        })
    }

    fn outward_normal(&self, ray: &Ray, hit: &TrueHit) -> Option<DVec3> {
        let (ends, radii) = ([self.p0(), self.p1()], [self.radius0(), self.radius1()]);
        let taper = Taper::new(&numbers_of(ends, radii, &ExactRay::new(ray)), false);
        unit(&match hit.part {
            Part::Side if is_at_apex(ends, radii, ray, hit) => return None,
            Part::Cap0 => taper.a.times(&exact(-1.0)),
            Part::Cap1 => taper.a,
            _ => taper.gradient(&from_point(self.p0(), ray, hit)),
        })
    }

    fn truly_contains(&self, point: DVec3) -> bool {
        let taper = of(
            [self.p0(), self.p1()],
            [self.radius0(), self.radius1()],
            point,
            false,
        );
        sign(&taper.ax) != Ordering::Less
            && taper.ax <= taper.aa
            && sign(&taper.wall().c) != Ordering::Greater
    }
}

impl TrueOperand for Cone {
    fn leaf(&self) -> Leaf {
        let [p0, p1] = [self.p0(), self.p1()].map(ExactVector::new);
        let [r0, r1] = [self.radius0(), self.radius1()].map(exact);
        let (a, delta) = (&p1 - &p0, &r1 - &r0);
        let back = a.times(&exact(-1.0));
        Leaf::within(vec![
            Sheet::wall(&p0, &a, [&r0, &delta, &a.dot(&a)]),
            Sheet::plane(&back, &back.dot(&p0), Some(Part::Cap0)),
            Sheet::plane(&a, &a.dot(&p1), Some(Part::Cap1)),
        ])
    }
}
