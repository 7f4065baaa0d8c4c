//! How solids are turned and moved by the keys of their pose: about x, y and z,
//! then by the list `rotate`, each about the solid's own center, then along
//! `translate`.
//!
//! What is not stated changes nothing, not even by a rounding. The points of a turned
//! solid are `center + R (point - center)`, rounded to f64; from then on they are
//! exact numbers as those of any other solid.

use std::ops::Range;

use glam::DVec3;
use toml::Spanned;

use super::error::SceneError;
use super::settings::vector;
use super::solid_keys::{PoseKeys, RotationKeys};
use super::source::Source;
use super::values::{Keys, Number};
use crate::math::{Orientation, unit};
use crate::solid::{AnySolid, Composition, Cone, Cuboid, Cylinder, Disk, RoundedCone, Sphere};

/// A turn about a center that is not known yet, and a translation.
pub(super) struct Motion<'a> {
    source: &'a Source,
    /// Where to point at when a solid is none where it is moved to.
    place: Range<usize>,
    turn: Option<Orientation>,
    translation: Option<DVec3>,
}

/// The rotations about x, y and z, in this order.
pub(super) fn about_axes(degrees: [Option<Number>; 3]) -> Orientation {
    let [x, y, z] = degrees.map(|degrees| degrees.map_or(0.0, |degrees| degrees.0));
    Orientation::IDENTITY.rotated_x(x).rotated_y(y).rotated_z(z)
}

/// The axis of a rotation, a unit vector.
pub(super) fn axis(source: &Source, turn: &RotationKeys) -> Result<DVec3, SceneError> {
    unit(vector(&turn.axis)).ok_or_else(|| {
        source.error(
            turn.axis.span(),
            "the rotation axis is zero: it needs a direction, of any length",
        )
    })
}

impl<'a> Motion<'a> {
    /// The motion that the keys of a pose state, of what stands at `place`.
    pub fn new(
        source: &'a Source,
        keys: &PoseKeys,
        place: Range<usize>,
    ) -> Result<Self, SceneError> {
        let mut turn = about_axes(keys.about_axes);
        for Keys(next) in keys.rotate {
            turn = turn.rotated(axis(source, next)?, next.degrees.0);
        }
        Ok(Self {
            source,
            place: keys.translate.map_or(place, Spanned::span),
            turn: (turn != Orientation::IDENTITY).then_some(turn),
            translation: keys.translate.map(vector),
        })
    }

    /// A composition, all of it turned about one center.
    pub fn of_composition(
        &self,
        composition: Composition,
        center: DVec3,
    ) -> Result<Composition, SceneError> {
        let all = |parts: Vec<Composition>| {
            let parts = parts.into_iter();
            let parts = parts.map(|part| self.of_composition(part, center));
            parts.collect::<Result<Vec<_>, _>>()
        };
        Ok(match composition {
            Composition::Solid(solid) => Composition::Solid(self.of_solid(&solid, center)?),
            Composition::Union(parts) => Composition::Union(all(parts)?),
            Composition::Intersection(parts) => Composition::Intersection(all(parts)?),
            Composition::Difference(parts) => Composition::Difference(all(parts)?),
        })
    }

    /// A solid, turned about a center.
    pub fn of_solid(&self, solid: &AnySolid, center: DVec3) -> Result<AnySolid, SceneError> {
        if self.turn.is_none() && self.translation.is_none() {
            return Ok(*solid);
        }
        self.moved(solid, center).map_err(|error| {
            let place = self.place.clone();
            self.source
                .error(place, format!("where the solid is moved to, {error}"))
        })
    }

    fn moved(&self, solid: &AnySolid, center: DVec3) -> Result<AnySolid, String> {
        let direction = |direction| self.turn.map_or(direction, |turn| turn.to_world(direction));
        let point = |point: DVec3| {
            let turned = match self.turn {
                Some(turn) => center + turn.to_world(point - center),
                None => point,
            };
            self.translation.map_or(turned, |by| turned + by)
        };
        match solid {
            AnySolid::Cylinder(one) => {
                let ends = (point(one.p0()), point(one.p1()));
                any_solid(Cylinder::new(ends.0, ends.1, one.radius(), one.caps()))
            }
            AnySolid::Cone(one) => {
                let ends = (point(one.p0()), point(one.p1()));
                let radii = (one.radius0(), one.radius1());
                any_solid(Cone::new(ends.0, ends.1, radii.0, radii.1, one.caps()))
            }
            AnySolid::RoundedCone(one) => {
                let ends = (point(one.p0()), point(one.p1()));
                any_solid(RoundedCone::new(
                    ends.0,
                    ends.1,
                    one.radius0(),
                    one.radius1(),
                ))
            }
            AnySolid::Sphere(one) => any_solid(Sphere::new(point(one.center()), one.radius())),
            AnySolid::Cuboid(one) => {
                let orientation = one.orientation();
                let orientation = self.turn.map_or(orientation, |turn| orientation.then(turn));
                any_solid(Cuboid::new(
                    point(one.center()),
                    one.half_widths(),
                    orientation,
                ))
            }
            AnySolid::Disk(one) => any_solid(Disk::new(
                point(one.center()),
                direction(one.normal()),
                one.radius(),
            )),
        }
    }
}

/// A solid of its kind, or why it is none.
fn any_solid<S: Into<AnySolid>, E: ToString>(solid: Result<S, E>) -> Result<AnySolid, String> {
    solid.map(Into::into).map_err(|error| error.to_string())
}
