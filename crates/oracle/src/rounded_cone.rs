//! All hits of a rounded cone, exactly.
//!
//! With `a = p1 - p0`, `Δ = r1 - r0`, the cone that touches both balls meets them in
//! circles at the heights `a·q = -r0 Δ` and `a·a - r1 Δ`. A point of the sphere around
//! `p0` is on the hull's boundary up to the first height, one of that around `p1`
//! from the second on, and one of the wall between the two. If these are not in
//! this order, one ball contains the other and is the hull.

use std::cmp::Ordering;

use glam::DVec3;

use super::any::{TrueSolid, from_point, is_at_apex};
use super::change::least_change;
use super::composed::{Leaf, Sheet, TrueOperand};
use super::cylinder::TrueHit;
use super::ends::{TrueEnd, hits};
use super::normal::unit;
use super::number::{Exact, ExactVector, exact, sign};
use super::ray::ExactRay;
use super::taper::{Taper, numbers_of};
use super::taper_points::of;
use cyltrace::math::Ray;
use cyltrace::solid::{Caps, Part, RoundedCone};

/// The heights of the circles in which the wall touches the balls.
fn seams(taper: &Taper, r0: &Exact, r1: &Exact) -> (Exact, Exact) {
    (-(r0 * &taper.delta), &taper.aa - r1 * &taper.delta)
}

/// The numbers of a case, as `Taper::new` takes them.
fn numbers(solid: &RoundedCone, ray: &ExactRay) -> Vec<Exact> {
    let ends = [solid.p0(), solid.p1()];
    let radii = [solid.radius0(), solid.radius1()];
    numbers_of(ends, radii, ray)
}

impl TrueSolid for RoundedCone {
    fn hits(&self, ray: &ExactRay) -> Vec<TrueHit> {
        let taper = Taper::new(&numbers(self, ray), true);
        let (r0, r1) = (ray.length(self.radius0()), ray.length(self.radius1()));
        let is_hull = sign(&taper.beta) == Ordering::Greater;
        let (seam0, seam1) = seams(&taper, &r0, &r1);
        let (to_seam0, to_seam1) = (&taper.ax - seam0, &taper.ax - seam1);
        let mut points = Vec::new();
        let spheres = [(Part::Cap0, 0.0, &r0), (Part::Cap1, 1.0, &r1)];
        for (part, share, radius) in spheres {
            let is_outer = (part == Part::Cap0) == (r0 >= r1);
            for t in taper.ball(share, radius).roots() {
                let is_there = if !is_hull {
                    is_outer
                } else if part == Part::Cap0 {
                    t.sign_of_line(&to_seam0, &taper.ad) != Ordering::Greater
                } else {
                    t.sign_of_line(&to_seam1, &taper.ad) != Ordering::Less
                };
                if is_there {
                    points.push(TrueEnd {
                        t,
                        cap: Some(part),
                        on_side: false,
                    });
                }
            }
        }
        let wall = if is_hull {
            taper.wall_points()
        } else {
            Vec::new()
        };
        for t in wall {
            let is_there = t.sign_of_line(&to_seam0, &taper.ad) == Ordering::Greater
                && t.sign_of_line(&to_seam1, &taper.ad) == Ordering::Less;
            if is_there {
                points.push(TrueEnd {
                    t,
                    cap: None,
                    on_side: true,
                });
            }
        }
        let lies_on = (is_hull && taper.is_along()).then_some(Part::Side);
        hits(&points, lies_on, Caps::Both, ray)
    }

    fn gap(&self, ray: &Ray) -> f64 {
        // As of a cone, of the spheres, the wall and the seams.
        least_change(numbers(self, &ExactRay::new(ray)), |numbers: &[Exact]| {
            let taper = Taper::new(numbers, true);
            let (r0, r1) = (&numbers[6], &numbers[7]);
            let (wall, ball0, ball1) = (taper.wall(), taper.ball(0.0, r0), taper.ball(1.0, r1));
            let (seam0, seam1) = seams(&taper, r0, r1);
            vec![
                wall.discriminant(),
                ball0.discriminant(),
                ball1.discriminant(),
                taper.wall_at(&seam0),
                taper.wall_at(&seam1),
                wall.c,
                ball0.c,
                ball1.c,
                taper.beta,
            ]
        })
    }

    fn outward_normal(&self, ray: &Ray, hit: &TrueHit) -> Option<DVec3> {
        let (ends, radii) = ([self.p0(), self.p1()], [self.radius0(), self.radius1()]);
        unit(&match hit.part {
            _ if is_at_apex(ends, radii, ray, hit) => return None,
            Part::Cap0 => from_point(self.p0(), ray, hit),
            Part::Cap1 => from_point(self.p1(), ray, hit),
            _ => {
                let numbers = numbers_of(ends, radii, &ExactRay::new(ray));
                Taper::new(&numbers, true).gradient(&from_point(self.p0(), ray, hit))
            }
        })
    }

    fn truly_contains(&self, point: DVec3) -> bool {
        let radii = [self.radius0(), self.radius1()];
        let taper = of([self.p0(), self.p1()], radii, point, true);
        let [r0, r1] = radii.map(exact);
        let above = &taper.ax + &r0 * &taper.delta;
        let ball = |share, radius| sign(&taper.ball(share, radius).c) != Ordering::Greater;
        let is_hull = sign(&taper.beta) == Ordering::Greater;
        let is_between = is_hull && sign(&above) != Ordering::Less && above <= taper.beta;
        ball(0.0, &r0) || ball(1.0, &r1) || is_between && sign(&taper.wall().c) != Ordering::Greater
    }
}

impl TrueOperand for RoundedCone {
    fn leaf(&self) -> Leaf {
        let [p0, p1] = [self.p0(), self.p1()].map(ExactVector::new);
        let [r0, r1] = [self.radius0(), self.radius1()].map(exact);
        let (a, delta) = (&p1 - &p0, &r1 - &r0);
        let beta = a.dot(&a) - &delta * &delta;
        let mut sheets = vec![
            Sheet::sphere(&p0, &r0, Part::Cap0),
            Sheet::sphere(&p1, &r1, Part::Cap1),
        ];
        if sign(&beta) == Ordering::Greater {
            // 0 <= a·q + r0 Δ <= β
            let seam = a.dot(&p0) - &r0 * &delta;
            sheets.push(Sheet::plane(&a.times(&exact(-1.0)), &-&seam, None));
            sheets.push(Sheet::plane(&a, &(seam + &beta), None));
            sheets.push(Sheet::wall(&p0, &a, [&r0, &delta, &beta]));
        }
        Leaf::within_either(sheets)
    }
}
