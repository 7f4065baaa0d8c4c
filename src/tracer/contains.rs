//! The solids that contain a point.
//!
//! The query is a ray that consists of its origin: `t` from 0 to 0. So the point goes down
//! through placements by the same operations as a ray's origin, and Embree only reports
//! candidates. None is lost: the box of a solid that contains the point contains it too, at
//! `t = 0` of the ray, and `frame` guarantees that no ray misses a box that contains one of its
//! points (`docs/derivations.md`, section 4: the point is below 4 in the frame, so that f32
//! rounds it by at most 2^-23, and boxes are grown by 2^-19 of a radius of at least 1). The
//! callbacks collect solids and never accept a hit, so Embree visits every box.
//!
//! The direction does not matter; it is (1, 1, 1), so that no component is zero unless a
//! placement rotates it.

use glam::DVec3;

use super::frame::LocalRay;
use super::prototype::Prototype;
use super::query::{Query, QueryMode, SolidRef};
use super::{Tracer, normalize_direction};
use crate::math::Ray;
use crate::scene::{Listed, MaterialIndex, PrototypeIndex, SolidList};
use crate::solid::SolidKind;
use crate::with_solid_kind;

/// A solid that contains a point. Ordered by the instance path, then by the primitive.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Containing {
    /// The placements from the root to the prototype, outermost first.
    pub instance: Vec<u32>,
    /// The solid's number within its prototype.
    pub primitive: u32,
    /// The prototype that contains the solid.
    pub prototype: PrototypeIndex,
    /// The kind of solid.
    pub solid: SolidKind,
}

impl Tracer {
    /// The solids that contain a point, in order. Solids are closed: a point of the surface is
    /// contained, and so is one in a tube, because open ends belong to the surface and not to
    /// the solid. No solid contains a point that is not finite.
    ///
    /// The numbers of the point and of the solid are taken as they are, and in the root the
    /// result is exact. Through placements the point is rounded like the origin of a ray.
    ///
    /// In a scene that was built for a view ([`Options::view`](super::Options::view)), the
    /// result is valid only for points in the view.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> Vec<Containing> {
        self.containing(point, Prototype::search)
    }

    /// As [`Tracer::contains`], without Embree: it tests every placement and every solid. It
    /// verifies that the traversal loses nothing, and is very slow.
    #[must_use]
    pub fn contains_exhaustive(&self, point: DVec3) -> Vec<Containing> {
        self.containing(point, Prototype::search_exhaustively)
    }

    /// The material of the last solid that contains a point, in the order of
    /// [`Tracer::contains`], among the solids whose material `counts`. It takes less time than
    /// the list of all of them.
    #[must_use]
    pub fn material_at(
        &self,
        point: DVec3,
        counts: impl Fn(MaterialIndex) -> bool,
    ) -> Option<MaterialIndex> {
        let places = self.places(point, Prototype::search);
        let with_materials = places.into_iter().map(|place| {
            let (kind, record) = (place.member.kind, place.member.record as usize);
            let solids = &self.scene.prototypes[place.prototype.0 as usize].solids;
            let (primitive, material) = with_solid_kind!(kind, S => {
                let list = S::list(solids);
                (list.primitive(record), list.material(record))
            });
            ((place.path, primitive), material)
        });
        let counted = with_materials.filter(|&(_, material)| counts(material));
        let last = counted.max_by(|(place, _), (other, _)| place.cmp(other));
        last.map(|(_, material)| material)
    }

    fn containing(
        &self,
        point: DVec3,
        trace: impl FnOnce(&Prototype, &LocalRay, &mut Query),
    ) -> Vec<Containing> {
        let places = self.places(point, trace).into_iter();
        let mut containing: Vec<_> = places
            .map(|place| {
                let prototype = &self.scene.prototypes[place.prototype.0 as usize];
                let (kind, record) = (place.member.kind, place.member.record);
                Containing {
                    instance: place.path.to_vec(),
                    primitive: prototype.solids.primitive(kind, record as usize),
                    prototype: place.prototype,
                    solid: kind,
                }
            })
            .collect();
        containing.sort_unstable();
        containing
    }

    /// The solids that contain a point, in no order.
    pub(super) fn places(
        &self,
        point: DVec3,
        trace: impl FnOnce(&Prototype, &LocalRay, &mut Query),
    ) -> Vec<SolidRef> {
        let ray = Ray {
            t_max: 0.0,
            ..Ray::new(point, DVec3::ONE)
        };
        let (Some(root), Some((ray, _))) = (&self.root, normalize_direction(&ray)) else {
            return Vec::new();
        };
        let mut query = Query::containing(&ray);
        trace(root, &LocalRay::new(&ray), &mut query);
        let QueryMode::Containing(places) = query.mode else {
            unreachable!("a query keeps its mode");
        };
        places
    }
}
