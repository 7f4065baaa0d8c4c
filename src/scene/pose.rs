//! The pose of a solid: rotations about x, y and z, then those of the list `rotate`,
//! all about the solid's own center, then the translation `translate`.
//!
//! Missing keys change nothing, not even by a rounding. The points of a rotated solid
//! are `center + R (point - center)`, rounded to f64; from then on they are exact
//! numbers like those of any other solid.

use std::ops::Range;

use glam::DVec3;
use toml::Spanned;

use super::error::SceneError;
use super::rigid_motion::RigidMotion;
use super::solid_keys::{PoseKeys, RotationKeys};
use super::solids::{SceneSolid, SolidKeys};
use super::source::Source;
use super::values::{Keys, Number, vector};
use crate::math::{Orientation, unit};
use crate::solid::{AnySolid, Composition};
use crate::with_solid;

/// A rotation about a center that is given later, and a translation.
pub(super) struct Motion<'a> {
    source: &'a Source,
    /// The place of errors about the moved solid.
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
            "the rotation axis is zero: it must be a direction, of any length",
        )
    })
}

/// The solid of a table in its pose.
pub(super) fn solid<K: SolidKeys + ?Sized>(
    source: &Source,
    keys: &K,
) -> Result<AnySolid, SceneError> {
    let unmoved = keys.unmoved(source)?;
    let motion = Motion::new(source, &keys.pose(), keys.place())?;
    motion.of_solid(&unmoved, unmoved.center())
}

impl<'a> Motion<'a> {
    /// The motion of a pose's keys, for the solid at `place` in the file.
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

    /// Moves a composition, all parts about one center.
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

    /// Moves a solid about a center.
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
                    .error(place, format!("after the solid is rotated and translated, {error}"))
            })
        })
    }
}
