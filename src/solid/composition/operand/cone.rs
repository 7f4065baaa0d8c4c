//! The wall and the disks of a cone, or of a cylinder, which is a cone of equal radii.
//!
//! **Exact normals.** Let the point `x` and the axis `a` be relative to `p0`, `L² = a·a`, the
//! radii `r0` and `r1`, and `Δ = r1 - r0`. The normal of a disk is `-a` at `p0` and `a` at
//! `p1`. The wall is where `F = |x|² - (x·a)² / L² - r²` is zero, with the radius
//! `r = r0 + Δ (x·a) / L²`. The gradient of `F`, times `L⁴ / 2`, is
//!
//! ```text
//! n = L² (L² x - a (x·a)) - a Δ (r0 L² + Δ x·a)                          (1)
//! ```

use glam::DVec3;

use super::{OperandSurface, Vector, minus, scaled};
use crate::solid::composition::bend::Bend;
use crate::solid::composition::piece::{Piece, Pieces, Viewed};
use crate::solid::exact::{Big, Number, difference, dot};
use crate::solid::{Cone, Cylinder, Part};

impl OperandSurface for Cylinder {
    fn add_pieces(&self, view: &Viewed, pieces: &mut Pieces) {
        self.as_cone().add_pieces(view, pieces);
    }

    fn exact_normal(&self, part: Part, point: DVec3) -> Option<Vector> {
        self.as_cone().exact_normal(part, point)
    }
}

impl OperandSurface for Cone {
    fn add_pieces(&self, view: &Viewed, pieces: &mut Pieces) {
        let (a, [r0, r1]) = (self.p1() - self.p0(), [self.radius0(), self.radius1()]);
        let x = view.from_anchor;
        let length = a.length();
        let axis = a / length;
        let turned = 2.0 * view.own_displacement() / length;
        let slope = (r1 - r0) / length;
        let cosine = 1.0 / libm::hypot(1.0, slope);
        let height = x.dot(axis);
        for (part, radius, from, out) in [
            (Part::Cap0, r0, height.abs(), -axis),
            (Part::Cap1, r1, (height - length).abs(), axis),
        ] {
            if !view.passes(part, from) {
                continue;
            }
            if radius == 0.0 {
                pieces.push(view.apex(part, -out, cosine, turned));
                return;
            }
            pieces.push(view.flat(part, out, turned));
        }
        let radial = x - axis * height;
        let (distance, radius) = (radial.length(), r0 + slope * height);
        if view.passes(Part::Side, (distance - radius).abs() * cosine) {
            let outward = radial / distance;
            let curvature = cosine / radius;
            let along = (axis + outward * slope) * cosine;
            pieces.push(Piece {
                bend: Bend::new(axis.cross(outward), along, curvature, [0.0; 2]),
                ..view.flat(
                    Part::Side,
                    (outward - axis * slope) * cosine,
                    turned + view.displacement * curvature,
                )
            });
        }
    }

    fn exact_normal(&self, part: Part, point: DVec3) -> Option<Vector> {
        let (p0, p1) = (self.p0(), self.p1());
        match part {
            Part::Cap0 => return Some(difference(p0, p1)),
            Part::Cap1 => return Some(difference(p1, p0)),
            _ => {}
        }
        let (x, a): (Vector, Vector) = (difference(point, p0), difference(p1, p0));
        let (length2, height) = (dot(&a, &a), dot(&x, &a));
        let delta = Big::difference(self.radius1(), self.radius0());
        let radius = (Big::of(self.radius0()).times(&length2)).plus(&delta.times(&height));
        let along = length2.times(&height).plus(&delta.times(&radius));
        Some(minus(
            &scaled(&x, &length2.times(&length2)),
            &scaled(&a, &along),
        ))
    }
}
