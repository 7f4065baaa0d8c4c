//! The surface of each kind of solid for set operations, one file per kind.

mod cone;
mod cuboid;
mod disk;
mod rounded_cone;
mod sphere;

use glam::DVec3;

use super::piece::{Piece, Pieces, Viewed};
use crate::solid::exact::{Big, Number};
use crate::solid::{AnySolid, Part};
use crate::with_solid;

/// A vector of exact numbers.
pub(super) type Vector = [Big; 3];

/// A kind of solid in set operations.
pub(super) trait OperandSurface {
    /// Adds the pieces of the surface that pass through the point of a view.
    fn add_pieces(&self, view: &Viewed, pieces: &mut Pieces);

    /// An exact outward normal, of any length, of a part at one of its points that is no apex;
    /// `None` for a solid without an inside.
    fn exact_normal(&self, part: Part, point: DVec3) -> Option<Vector>;
}

impl Viewed<'_> {
    /// Adds the pieces that pass through the point.
    pub fn add_pieces(&self, pieces: &mut Pieces) {
        with_solid!(self.solid, solid => solid.add_pieces(self, pieces));
    }
}

/// An exact outward normal of a solid's piece at one of its points; `None` for an apex.
pub(super) fn outward(solid: &AnySolid, piece: &Piece, point: DVec3) -> Option<Vector> {
    if !piece.is_flat_to_first_order() {
        return None;
    }
    with_solid!(solid, solid => solid.exact_normal(piece.part, point))
}

fn scaled(v: &Vector, factor: &Big) -> Vector {
    std::array::from_fn(|i| v[i].times(factor))
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| a[i].minus(&b[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Orientation, Random};
    use crate::solid::composition::piece::{Nearness, Pieces, Viewed};
    use crate::solid::exact::unit;
    use crate::solid::{AnySolid, Caps, Cone, Cuboid, Cylinder, RoundedCone, Sphere};

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
                let direction = to - from;
                let Some(chord) = solid.chord(from - solid.anchor(), direction) else {
                    continue;
                };
                let (part, point) = (chord.enter.part, from + direction * chord.enter.t);
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
