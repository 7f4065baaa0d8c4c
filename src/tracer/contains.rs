//! Which solids hold a point.
//!
//! The point is asked about as a ray that is nothing but its origin: `t` from 0 to
//! 0. So it goes down through placements by the very operations of a ray's origin,
//! and Embree only finds candidates. None is lost: a solid that contains the point
//! has it in its box, at `t = 0` of the ray, and that a ray is not kept from a box in
//! which it has a point is what `frame` promises of all rays (`docs/derivations.md`,
//! section 4: the point is below 4 in the frame, so that f32 rounds it by at most
//! 2^-23, and boxes are grown by 2^-19 of a radius of at least 1). The callbacks
//! collect and never accept, so that Embree goes on to the last box.
//!
//! The direction plays no part; it is (1, 1, 1) so that no component of it is zero
//! where nothing is turned.

use glam::DVec3;

use super::frame::LocalRay;
use super::prototype::Prototype;
use super::query::{Query, QueryMode};
use super::{Tracer, normalize_direction};
use crate::math::Ray;
use crate::scene::PrototypeIndex;
use crate::solid::SolidKind;

/// A solid that contains a point. Ordered by the instance path, then by the
/// primitive.
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
    /// The solids that hold a point, in order. Solids are closed: a point of the
    /// surface counts, and so does one in a tube, for ends that are open belong to
    /// the surface and not to the solid. None hold a point that is not finite.
    ///
    /// The point's numbers and the solid's are taken as they are, and in the root the
    /// answer is exact. Through placements the point is rounded as the origin of a ray.
    ///
    /// Of a scene that was built for a view ([`Options::view`](super::Options::view))
    /// it is known only what contains points in that.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> Vec<Containing> {
        self.containing(point, Prototype::search)
    }

    /// As [`Tracer::contains`], without Embree: every placement and every solid is
    /// asked. It is the witness that the traversal loses nothing, and very slow.
    #[must_use]
    pub fn contains_exhaustive(&self, point: DVec3) -> Vec<Containing> {
        self.containing(point, Prototype::search_exhaustively)
    }

    fn containing(
        &self,
        point: DVec3,
        trace: impl FnOnce(&Prototype, &LocalRay, &mut Query),
    ) -> Vec<Containing> {
        let ray = Ray {
            t_max: 0.0,
            ..Ray::new(point, DVec3::ONE)
        };
        let (Some(root), Some((ray, _))) = (&self.root, normalize_direction(&ray)) else {
            return Vec::new();
        };
        let mut query = Query::holding(&ray);
        trace(root, &LocalRay::new(&ray), &mut query);
        let QueryMode::Containing(places) = query.keep else {
            unreachable!("the query keeps what it was told to keep");
        };
        let mut containing: Vec<_> = places
            .into_iter()
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
}
