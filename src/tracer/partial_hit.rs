//! A hit with only some fields computed.
//!
//! Most callers need few fields of a hit, and some fields cost as much as the query that finds
//! it: `u` takes an arc tangent, the error bound and the margin of spawned rays take norms of
//! every placement, the path takes an allocation. [`HitFields`] selects fields; a
//! [`PartialHit`] returns those and `None` for the others.

use bitflags::bitflags;
use glam::DVec3;

use super::Hit;
use crate::math::Ray;
use crate::scene::{MaterialIndex, PrototypeIndex};
use crate::solid::{Crossing, Part, SolidKind};

bitflags! {
    /// A set of the fields of a [`Hit`] that are computed on request. All its other fields are
    /// always present.
    ///
    /// A field has the same bits in every set that contains it.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
    pub struct HitFields: u8 {
        /// [`Hit::point`].
        const POINT = 1;
        /// [`Hit::normal`].
        const NORMAL = 1 << 1;
        /// [`Hit::u`] and [`Hit::v`].
        const UV = 1 << 2;
        /// [`Hit::error`].
        const ERROR = 1 << 3;
        /// [`Hit::instance`].
        const PATH = 1 << 4;
        /// The input of [`Hit::spawn`].
        const SPAWN = 1 << 5;
    }
}

/// A [`Hit`] with the fields that were requested.
///
/// # Example
/// ```
/// # use std::sync::Arc;
/// # use cyltrace::math::Ray;
/// # use cyltrace::scene::{CylinderRecord, MaterialIndex, Prototype, Scene, Solids};
/// # use cyltrace::solid::{Caps, Cylinder};
/// # use cyltrace::tracer::{HitFields, Options, Tracer};
/// # use glam::DVec3;
/// # let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z, 0.5, Caps::Both).unwrap();
/// # let record = CylinderRecord::new(&cylinder, 0, MaterialIndex(0));
/// # let root = Prototype { solids: Solids::of_cylinders([record]), ..Prototype::default() };
/// # let tracer = Tracer::new(Arc::new(Scene::new(vec![root])), &Options::default()).unwrap();
/// let ray = Ray::new(DVec3::new(2.0, 0.0, 0.5), DVec3::NEG_X);
/// let hit = tracer.closest_with(&ray, HitFields::NORMAL).expect("a hit");
/// assert_eq!((hit.t(), hit.normal()), (1.5, Some(DVec3::X)));
/// assert_eq!(hit.point(), None);
/// ```
#[derive(Clone, Debug)]
pub struct PartialHit {
    /// Floating-point fields that were not requested are NaN, the path is empty.
    hit: Hit,
    fields: HitFields,
}

impl PartialHit {
    /// A hit whose other fields have no meaning.
    pub(super) fn new(hit: Hit, fields: HitFields) -> Self {
        Self { hit, fields }
    }

    /// The fields that were requested.
    #[must_use]
    pub fn fields(&self) -> HitFields {
        self.fields
    }

    /// As [`Hit::t`].
    #[must_use]
    pub fn t(&self) -> f64 {
        self.hit.t
    }

    /// As [`Hit::prototype`].
    #[must_use]
    pub fn prototype(&self) -> PrototypeIndex {
        self.hit.prototype
    }

    /// As [`Hit::solid`].
    #[must_use]
    pub fn solid(&self) -> SolidKind {
        self.hit.solid
    }

    /// As [`Hit::primitive`].
    #[must_use]
    pub fn primitive(&self) -> u32 {
        self.hit.primitive
    }

    /// As [`Hit::part`].
    #[must_use]
    pub fn part(&self) -> Part {
        self.hit.part
    }

    /// As [`Hit::crossing`].
    #[must_use]
    pub fn crossing(&self) -> Crossing {
        self.hit.crossing
    }

    /// As [`Hit::material`].
    #[must_use]
    pub fn material(&self) -> MaterialIndex {
        self.hit.material
    }

    /// As [`Hit::point`], if [`HitFields::POINT`] was requested.
    #[must_use]
    pub fn point(&self) -> Option<DVec3> {
        self.requested(HitFields::POINT, self.hit.point)
    }

    /// As [`Hit::normal`], if [`HitFields::NORMAL`] was requested.
    #[must_use]
    pub fn normal(&self) -> Option<DVec3> {
        self.requested(HitFields::NORMAL, self.hit.normal)
    }

    /// [`Hit::u`] and [`Hit::v`], if [`HitFields::UV`] was requested.
    #[must_use]
    pub fn uv(&self) -> Option<(f64, f64)> {
        self.requested(HitFields::UV, (self.hit.u, self.hit.v))
    }

    /// As [`Hit::error`], if [`HitFields::ERROR`] was requested.
    #[must_use]
    pub fn error(&self) -> Option<f64> {
        self.requested(HitFields::ERROR, self.hit.error)
    }

    /// As [`Hit::instance`], if [`HitFields::PATH`] was requested.
    #[must_use]
    pub fn instance(&self) -> Option<&[u32]> {
        self.requested(HitFields::PATH, &self.hit.instance)
    }

    /// As [`Hit::spawn`], if [`HitFields::SPAWN`] was requested.
    #[must_use]
    pub fn spawn(&self, direction: DVec3) -> Option<Ray> {
        self.requested(HitFields::SPAWN, &self.hit)
            .map(|hit| hit.spawn(direction))
    }

    fn requested<T>(&self, field: HitFields, value: T) -> Option<T> {
        self.fields.contains(field).then_some(value)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DAffine3;

    use super::*;
    use crate::scene::{CylinderRecord, Placement, Prototype, Scene, Solids};
    use crate::solid::{Caps, Cylinder};
    use crate::tracer::{Options, Tracer};

    /// Each field costs time only if it is requested.
    #[test]
    fn fields_that_are_not_requested_are_not_worked_out() {
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z, 0.5, Caps::Both).unwrap();
        let record = CylinderRecord::new(&cylinder, 0, MaterialIndex(0));
        let root = Prototype {
            placements: vec![Placement {
                of: PrototypeIndex(1),
                parent_from_child: DAffine3::from_scale(DVec3::splat(2.0)),
            }],
            ..Prototype::default()
        };
        let child = Prototype {
            solids: Solids::of_cylinders(vec![record]),
            ..Prototype::default()
        };
        let scene = Arc::new(Scene::new(vec![root, child]));
        let tracer = Tracer::new(scene, &Options::default()).unwrap();
        let ray = Ray::new(DVec3::new(3.0, 0.0, 0.5), DVec3::NEG_X);
        for field in HitFields::all() {
            let hit = tracer.closest_with(&ray, field).unwrap().hit;
            // A spawned ray starts beside the point, along the normal, by the error and more.
            let with_spawn = |wanted| field == wanted || field == HitFields::SPAWN;
            assert_eq!(
                hit.normal.is_nan(),
                !with_spawn(HitFields::NORMAL),
                "{field:?}"
            );
            assert_eq!(
                hit.error.is_nan(),
                !with_spawn(HitFields::ERROR),
                "{field:?}"
            );
            assert_eq!(hit.u.is_nan(), field != HitFields::UV, "{field:?}");
            assert_eq!(
                hit.spawn_offset.is_nan(),
                field != HitFields::SPAWN,
                "{field:?}"
            );
            assert_eq!(
                hit.instance.is_empty(),
                field != HitFields::PATH,
                "{field:?}"
            );
        }
    }
}
