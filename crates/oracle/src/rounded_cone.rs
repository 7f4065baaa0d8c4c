//! All hits of a rounded cone, exactly.
//!
//! With `a = p1 - p0`, `Δ = r1 - r0`, the cone that touches both balls meets them in
//! circles at the heights `a·q = -r0 Δ` and `a·a - r1 Δ`. A point of the sphere around
//! `p0` is on the hull's boundary up to the first height, one of that around `p1`
//! from the second on, and one of the wall between the two. If these are not in
//! this order, one ball contains the other and is the hull.

use std::cmp::Ordering;

use super::change::least_change;
use super::cylinder::TrueHit;
use super::ends::{TrueEnd, hits};
use super::number::{Exact, sign};
use super::ray::ExactRay;
use super::taper::{Taper, numbers_of};
use cyltrace::math::Ray;
use cyltrace::solid::{Caps, Part, RoundedCone};

/// All points in the ray's range in which it meets the surface, in order; a
/// tangent is an entry and an exit.
#[must_use]
pub fn rounded_cone_hits(solid: &RoundedCone, ray: &ExactRay) -> Vec<TrueHit> {
    let taper = Taper::new(&numbers(solid, ray), true);
    let (r0, r1) = (ray.length(solid.radius0()), ray.length(solid.radius1()));
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

/// The least change as of [`cone_gap`](super::cone_gap), of the spheres, the wall
/// and the seams.
///
/// # Panics
/// When the ray is not valid.
#[must_use]
pub fn rounded_cone_gap(solid: &RoundedCone, ray: &Ray) -> f64 {
    least_change(
        numbers(solid, &ExactRay::new(ray)),
        |numbers: &[Exact]| {
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
        },
    )
}

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
