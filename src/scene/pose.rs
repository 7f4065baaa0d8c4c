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
use super::solids::SceneSolid;
use super::source::Source;
use super::values::{Keys, Number};
use crate::math::{Orientation, unit};
use crate::solid::{AnySolid, Composition};
use crate::with_solid;

/// A turn about a center that is not known yet, and a translation.
pub(super) struct Motion<'a> {
    source: &'a Source,
    /// The place of errors about the solid where it is moved to.
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
    /// The motion that the keys of a pose state, for what is at `place` in the file.
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
        let motion = RigidMotion {
            turn: self.turn,
            center,
            translation: self.translation,
        };
        with_solid!(solid, solid => {
            solid.moved(&motion).map(AnySolid::from).map_err(|error| {
                let place = self.place.clone();
                self.source
                    .error(place, format!("where the solid is moved to, {error}"))
            })
        })
    }
}

/// A turn about a center and a translation. What is not stated changes no bit.
pub(super) struct RigidMotion {
    turn: Option<Orientation>,
    center: DVec3,
    translation: Option<DVec3>,
}

impl RigidMotion {
    /// Where it takes a point.
    pub fn point(&self, point: DVec3) -> DVec3 {
        let turned = self.turn.map_or(point, |turn| {
            self.center + turn.to_world(point - self.center)
        });
        self.translation.map_or(turned, |by| turned + by)
    }

    /// Where it turns a direction.
    pub fn direction(&self, direction: DVec3) -> DVec3 {
        self.turn.map_or(direction, |turn| turn.to_world(direction))
    }

    /// The orientation of what had this one before.
    pub fn orientation(&self, before: Orientation) -> Orientation {
        self.turn.map_or(before, |turn| before.then(turn))
    }
}
