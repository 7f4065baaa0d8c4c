//! The wall and the balls of a rounded cone.
//!
//! **Exact normals.** The normal of a ball is the offset from its center. Let the point `x` and
//! the axis `a` be relative to `p0`, `L² = a·a`, the radii `r0` and `r1`, and `Δ = r1 - r0`.
//! The wall is the envelope of the spheres with the centers `s a` and the radii `r0 + Δ s`. At
//! its points `|x - s a|² - (r0 + Δ s)²` is stationary in `s`, which gives
//! `s = (x·a + r0 Δ) / β` with `β = L² - Δ² > 0`. The normal is the sphere's, `x - s a`, times
//! β:
//!
//! ```text
//! n = β x - a (x·a + r0 Δ)                                               (1)
//! ```

use glam::DVec3;

use super::sphere::ball;
use super::{OperandSurface, Vector, minus, scaled};
use crate::solid::composition::bend::Bend;
use crate::solid::composition::piece::{Piece, Pieces, Viewed};
use crate::solid::exact::{Big, Number, difference, dot};
use crate::solid::{Part, RoundedCone};

impl OperandSurface for RoundedCone {
    fn add_pieces(&self, view: &Viewed, pieces: &mut Pieces) {
        let x = view.from_anchor;
        let (r0, r1) = (self.radius0(), self.radius1());
        let a = self.p1() - self.p0();
        let Some(taper) = self.taper() else {
            // One ball contains the other.
            return pieces.push(if r0 >= r1 {
                ball(view, Part::Cap0, DVec3::ZERO, r0)
            } else {
                ball(view, Part::Cap1, a, r1)
            });
        };
        let (length, delta, beta) = (a.length(), r1 - r0, taper.beta());
        let axis = a / length;
        let (cosine, sine) = (beta.sqrt() / length, delta / length);
        // The distances from the first seam and to the second, along the axis.
        let height = x.dot(axis);
        let from_first = height + r0 * sine;
        let to_second = beta / length - from_first;
        let is_wall = view.passes(Part::Side, (-from_first).max(-to_second));
        for (part, from_seam, center, radius, inward) in [
            (Part::Cap0, from_first, DVec3::ZERO, r0, axis),
            (Part::Cap1, to_second, a, r1, -axis),
        ] {
            if !view.passes(part, from_seam) {
                continue;
            }
            if radius == 0.0 {
                let turned = 2.0 * view.own_displacement() / length;
                pieces.push(view.apex(part, inward, cosine, turned));
                return;
            }
            let mut piece = ball(view, part, center, radius);
            if is_wall {
                let around = axis.cross(piece.normal).normalize();
                let along = around.cross(piece.normal).normalize();
                let along = if along.dot(inward) > 0.0 {
                    along
                } else {
                    -along
                };
                let curvature = 1.0 / radius;
                let lengthwise = [curvature, 0.0];
                piece.to_wall = Some(along);
                piece.bend = Bend::new(around, along, curvature, lengthwise);
            }
            return pieces.push(piece);
        }
        let radial = x - axis * height;
        let outward = radial / radial.length();
        let radius = r0 + delta * (from_first * length / beta);
        let along = axis * cosine + outward * sine;
        let turned = 2.0 * view.own_displacement() / length + view.displacement / radius;
        pieces.push(Piece {
            bend: Bend::new(axis.cross(outward), along, 1.0 / radius, [0.0; 2]),
            ..view.flat(Part::Side, outward * cosine - axis * sine, turned)
        });
    }

    fn exact_normal(&self, part: Part, point: DVec3) -> Option<Vector> {
        let (p0, p1) = (self.p0(), self.p1());
        match part {
            Part::Cap0 => return Some(difference(point, p0)),
            Part::Cap1 => return Some(difference(point, p1)),
            _ => {}
        }
        let (x, a): (Vector, Vector) = (difference(point, p0), difference(p1, p0));
        let delta = Big::difference(self.radius1(), self.radius0());
        let beta = dot(&a, &a).minus(&delta.times(&delta));
        let along = dot(&x, &a).plus(&Big::of(self.radius0()).times(&delta));
        Some(minus(&scaled(&x, &beta), &scaled(&a, &along)))
    }
}
