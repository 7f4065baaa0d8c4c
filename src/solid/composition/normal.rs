//! The normal of a piece at a stated point as exact numbers.
//!
//! With the point `x` and the axis `a`, both from `p0`, `L² = a·a`, the radii `r0` and `r1`
//! and `Δ = r1 - r0`, an outward normal is a polynomial for every piece that has a tangent
//! plane. Its length is of no account.
//!
//! - **Disk**: `-a` at `p0`, `a` at `p1`.
//! - **Face of a cuboid**: the stated axis, or its opposite.
//! - **Sphere**: the point from the center.
//! - **Wall of a cone or cylinder**: it is where `F = |x|² - (x·a)² / L² - r²` is zero, with the
//!   radius `r = r0 + Δ (x·a) / L²`. The gradient of `F`, times `L⁴ / 2`, is
//!
//!   ```text
//!   n = L² (L² x - a (x·a)) - a Δ (r0 L² + Δ x·a)                          (1)
//!   ```
//!
//! - **Wall of a rounded cone**: it is the envelope of the spheres with the centers `s a` and the
//!   radii `r0 + Δ s`. At its points `|x - s a|² - (r0 + Δ s)²` does not change with `s`, which
//!   gives `s = (x·a + r0 Δ) / β` with `β = L² - Δ² > 0`. The normal is the sphere's, `x - s a`:
//!
//!   ```text
//!   n = β x - a (x·a + r0 Δ)                                               (2)
//!   ```

use glam::DVec3;

use super::piece::Piece;
use crate::solid::exact::{Big, Number, difference, dot, vector};
use crate::solid::{AnySolid, Cone, Cuboid, Part, RoundedCone};

/// A vector of exact numbers.
pub(super) type Vector = [Big; 3];

/// An outward normal of a solid's piece at a point of it; `None` for an apex.
pub(super) fn outward(solid: &AnySolid, piece: &Piece, point: DVec3) -> Option<Vector> {
    if !piece.is_flat_to_first_order() {
        return None;
    }
    match solid {
        AnySolid::Cylinder(one) => Some(of_cone(&one.as_cone(), piece.part, point)),
        AnySolid::Cone(one) => Some(of_cone(one, piece.part, point)),
        AnySolid::RoundedCone(one) => Some(of_rounded_cone(one, piece.part, point)),
        AnySolid::Cuboid(one) => Some(of_cuboid(one, piece.part)),
        AnySolid::Sphere(one) => Some(difference(point, one.center())),
        AnySolid::Disk(_) => None,
    }
}

fn of_cone(cone: &Cone, part: Part, point: DVec3) -> Vector {
    let (p0, p1) = (cone.p0(), cone.p1());
    match part {
        Part::Cap0 => return difference(p0, p1),
        Part::Cap1 => return difference(p1, p0),
        _ => {}
    }
    let (x, a): (Vector, Vector) = (difference(point, p0), difference(p1, p0));
    let (length2, height) = (dot(&a, &a), dot(&x, &a));
    let delta = Big::difference(cone.radius1(), cone.radius0());
    let radius = (Big::of(cone.radius0()).times(&length2)).plus(&delta.times(&height));
    let along = length2.times(&height).plus(&delta.times(&radius));
    minus(&scaled(&x, &length2.times(&length2)), &scaled(&a, &along))
}

fn of_rounded_cone(cone: &RoundedCone, part: Part, point: DVec3) -> Vector {
    let (p0, p1) = (cone.p0(), cone.p1());
    match part {
        Part::Cap0 => return difference(point, p0),
        Part::Cap1 => return difference(point, p1),
        _ => {}
    }
    let (x, a): (Vector, Vector) = (difference(point, p0), difference(p1, p0));
    let delta = Big::difference(cone.radius1(), cone.radius0());
    let beta = dot(&a, &a).minus(&delta.times(&delta));
    let along = dot(&x, &a).plus(&Big::of(cone.radius0()).times(&delta));
    minus(&scaled(&x, &beta), &scaled(&a, &along))
}

fn of_cuboid(cuboid: &Cuboid, part: Part) -> Vector {
    let frame = cuboid.orientation().world_from_object();
    vector(match part {
        Part::XMin => -frame.x_axis,
        Part::XMax => frame.x_axis,
        Part::YMin => -frame.y_axis,
        Part::YMax => frame.y_axis,
        Part::ZMin => -frame.z_axis,
        _ => frame.z_axis,
    })
}

fn scaled(v: &Vector, factor: &Big) -> Vector {
    std::array::from_fn(|i| v[i].times(factor))
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| a[i].minus(&b[i]))
}

#[cfg(test)]
mod tests {
    use super::super::piece::{Nearness, Pieces, Viewed};
    use super::*;
    use crate::math::{Orientation, Random};
    use crate::solid::exact::unit;
    use crate::solid::{Caps, Cylinder, Sphere};

    /// At points within roundings of the surface, exact normals are those of the solids.
    #[test]
    fn normals_are_those_of_the_surface() {
        let (p0, p1) = (DVec3::new(1.0, 2.0, -1.0), DVec3::new(2.0, 4.0, 1.5));
        let turn = Orientation::IDENTITY.rotated(DVec3::new(0.6, 0.0, 0.8), 31.0);
        let solids: [AnySolid; 5] = [
            Cylinder::new(p0, p1, 0.75, Caps::Both).unwrap().into(),
            Cone::new(p0, p1, 0.5, 1.75, Caps::Both).unwrap().into(),
            RoundedCone::new(p0, p1, 1.5, 0.25).unwrap().into(),
            Sphere::new(p0, 1.25).unwrap().into(),
            Cuboid::new(p0, p1.abs(), turn).unwrap().into(),
        ];
        let mut random = Random::new(31, 0);
        for (solid, parts) in solids.iter().zip([3, 3, 3, 1, 6]) {
            let mut seen = Vec::new();
            for _ in 0..400 {
                let from = solid.center() + random.direction() * 10.0;
                let to = solid.center() + random.direction() * 0.5;
                let way = to - from;
                let Some(chord) = solid.chord(from - solid.anchor(), way) else {
                    continue;
                };
                let (part, point) = (chord.enter.part, from + way * chord.enter.t);
                let from_anchor = point - solid.anchor();
                let mut pieces = Pieces::new();
                let view = Viewed {
                    leaf: 0,
                    solid,
                    from_anchor,
                    displacement: 0.0,
                    nearness: Nearness::Within {
                        distance: 0.0,
                        named: &[part],
                    },
                };
                view.add_pieces(&mut pieces);
                let piece = pieces.iter().find(|piece| piece.part == part);
                let exact = outward(solid, piece.expect("it is named"), point);
                let found = unit(&exact.expect("no apex"));
                let expected = solid.surface_point(part, from_anchor).normal;
                assert!(found.distance(expected) < 1e-13, "{solid:?} {part:?}");
                if !seen.contains(&part) {
                    seen.push(part);
                }
            }
            assert_eq!(seen.len(), parts, "{solid:?}: {seen:?}");
        }
    }
}
