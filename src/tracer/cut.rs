//! The faces where clip planes cut solids.
//!
//! A solid is cut at the point where the ray reaches the plane if it contains that point, exactly
//! as [`Tracer::contains`] does for the rounded point. A solid with open ends has no inside, so
//! its cut is open too.

use std::borrow::Borrow;
use std::cmp::Ordering;

use super::prototype::Prototype;
use super::query::SolidRef;
use super::traced::TracedSolid;
use super::{Hit, HitFields, PartialHit, Tracer};
use crate::math::{Ray, UNIT_ROUNDOFF};
use crate::scene::{Clip, Listed, MaterialIndex, MaterialKind, SolidList};
use crate::solid::{Crossing, Part};
use crate::with_solid_kind;

/// Bounds the roundings of a point of the plane, in units of 2^-53 of what it is computed from:
/// four of the difference and its product with the normal, and three of the point, doubled.
const ROUNDINGS: f64 = 16.0;

impl Tracer {
    /// The face in which a plane cuts a solid at the ray's parameter `t`, which is that of the
    /// plane: a hit of the part [`Part::Cut`] with the plane's normal and `u = v = 0`. Where
    /// several solids are cut, it is the first in the order of [`Tracer::contains`], among those
    /// that are not of glass if there are any. `None` if none is cut.
    #[must_use]
    pub fn cut(&self, ray: &Ray, t: f64, clip: &Clip) -> Option<PartialHit> {
        let point = ray.at(t);
        let cut = self.places(point, Prototype::search).into_iter();
        let cut = cut.filter_map(|place| Some((self.closed(&place)?, place)));
        let glass = |material: MaterialIndex| {
            let kind = self.scene.materials[usize::from(material.0)].kind;
            matches!(kind, MaterialKind::Glass { .. })
        };
        let order = |((primitive, material), place): &((u32, MaterialIndex), SolidRef),
                     ((other, other_material), other_place): &((u32, MaterialIndex), SolidRef)|
         -> Ordering {
            let by_kind = glass(*material).cmp(&glass(*other_material));
            by_kind.then_with(|| (&place.path, primitive).cmp(&(&other_place.path, other)))
        };
        let ((primitive, material), place) = cut.min_by(order)?;
        let seen = (clip.point - ray.origin).length() + ray.origin.length() + point.length();
        let error = ROUNDINGS * UNIT_ROUNDOFF * seen;
        let hit = Hit {
            t,
            point,
            error,
            normal: clip.normal,
            u: 0.0,
            v: 0.0,
            prototype: place.prototype,
            solid: place.member.kind,
            primitive,
            part: Part::Cut,
            crossing: Crossing::Enter,
            instance: place.path.to_vec(),
            material: clip.material.unwrap_or(material),
            spawn_offset: error,
        };
        Some(PartialHit::new(hit, HitFields::all()))
    }

    /// The number and the material of a solid with an inside.
    fn closed(&self, place: &SolidRef) -> Option<(u32, MaterialIndex)> {
        let solids = &self.scene.prototypes[place.prototype.0 as usize].solids;
        let record = place.member.record as usize;
        with_solid_kind!(place.member.kind, S => {
            let list = S::list(solids);
            let solid = list.solid(record);
            TracedSolid::is_closed(solid.borrow())
                .then(|| (list.primitive(record), list.material(record)))
        })
    }
}
