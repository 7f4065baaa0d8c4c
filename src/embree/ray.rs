//! Embree's f32 values: rays, boxes, and the hits that Embree finds itself.

use super::sys;
use super::types::{GREATEST_COORDINATE, GeometryId};

/// A ray as Embree traverses it: `origin + t * direction`,
/// `t_near <= t <= t_far`.
///
/// Callers guarantee that origin and direction are finite and below [`GREATEST_COORDINATE`] in
/// size, that `t_near` is finite and not negative, and that `t_far` is not NaN; it may be
/// infinite. An empty range is a miss. Builds with debug assertions check this.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray32 {
    /// The point at `t = 0`.
    pub origin: [f32; 3],
    /// The direction: not zero, of any length.
    pub direction: [f32; 3],
    /// Where the ray starts.
    pub t_near: f32,
    /// Where the ray ends.
    pub t_far: f32,
}

impl Ray32 {
    pub(super) fn to_embree(self) -> sys::RTCRay {
        debug_assert!(self.is_legal(), "Embree would abort on {self:?}");
        let [org_x, org_y, org_z] = self.origin;
        let [dir_x, dir_y, dir_z] = self.direction;
        sys::RTCRay {
            org_x,
            org_y,
            org_z,
            tnear: self.t_near,
            dir_x,
            dir_y,
            dir_z,
            time: 0.0,
            tfar: self.t_far,
            mask: u32::MAX,
            id: 0,
            flags: 0,
        }
    }

    pub(super) fn to_query(self) -> sys::RTCRayHit {
        sys::RTCRayHit {
            ray: self.to_embree(),
            hit: sys::RTCHit {
                geomID: sys::INVALID_ID,
                primID: sys::INVALID_ID,
                instID: [sys::INVALID_ID; _],
                ..Default::default()
            },
        }
    }

    pub(super) fn is_legal(&self) -> bool {
        is_inside(&self.origin)
            && is_inside(&self.direction)
            && (0.0..f32::INFINITY).contains(&self.t_near)
            && !self.t_far.is_nan()
    }
}

/// Whether all coordinates are finite and below [`GREATEST_COORDINATE`].
pub(super) fn is_inside(point: &[f32]) -> bool {
    point.iter().all(|x| x.abs() < GREATEST_COORDINATE)
}

/// The closed box `lower <= x <= upper`, axis by axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Box32 {
    /// Least coordinates.
    pub lower: [f32; 3],
    /// Greatest coordinates.
    pub upper: [f32; 3],
}

impl Box32 {
    /// The empty box, the neutral element of [`Box32::union`].
    pub const EMPTY: Self = Self {
        lower: [f32::INFINITY; 3],
        upper: [f32::NEG_INFINITY; 3],
    };

    /// The least box that contains both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            lower: std::array::from_fn(|axis| self.lower[axis].min(other.lower[axis])),
            upper: std::array::from_fn(|axis| self.upper[axis].max(other.upper[axis])),
        }
    }

    /// Whether Embree accepts it as the bounds of a primitive: not empty, and every coordinate
    /// below [`GREATEST_COORDINATE`]. Embree silently skips a primitive with other bounds.
    #[must_use]
    pub fn is_legal(&self) -> bool {
        is_inside(&self.lower)
            && is_inside(&self.upper)
            && (0..3).all(|axis| self.lower[axis] <= self.upper[axis])
    }

    pub(super) fn from_embree(bounds: &sys::RTCBounds) -> Self {
        Self {
            lower: [bounds.lower_x, bounds.lower_y, bounds.lower_z],
            upper: [bounds.upper_x, bounds.upper_y, bounds.upper_z],
        }
    }

    pub(super) fn to_embree(self) -> sys::RTCBounds {
        let [lower_x, lower_y, lower_z] = self.lower;
        let [upper_x, upper_y, upper_z] = self.upper;
        sys::RTCBounds {
            lower_x,
            lower_y,
            lower_z,
            upper_x,
            upper_y,
            upper_z,
            ..Default::default()
        }
    }
}

/// A hit as Embree reports it, in f32.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NativeHit {
    /// The ray's parameter.
    pub t: f32,
    /// Geometric normal, not normalized; for a triangle it points to the side
    /// from which the vertices run counter-clockwise. Zero for user geometry.
    pub normal: [f32; 3],
    /// First coordinate on the primitive; for a curve, along it. Zero for user
    /// geometry.
    pub u: f32,
    /// Second coordinate on the primitive. Zero for user geometry.
    pub v: f32,
    /// The primitive's number in its geometry.
    pub primitive: u32,
    /// The geometry that was hit; in an instance, its number in the instanced
    /// scene.
    pub geometry: GeometryId,
    /// The instance in which it was hit.
    pub instance: Option<GeometryId>,
}

impl NativeHit {
    pub(super) fn from_embree(query: &sys::RTCRayHit) -> Option<Self> {
        (query.hit.geomID != sys::INVALID_ID).then(|| Self::new(query.ray.tfar, &query.hit))
    }

    pub(super) fn new(t: f32, hit: &sys::RTCHit) -> Self {
        let instance = hit.instID[0];
        Self {
            t,
            normal: [hit.Ng_x, hit.Ng_y, hit.Ng_z],
            u: hit.u,
            v: hit.v,
            primitive: hit.primID,
            geometry: GeometryId(hit.geomID),
            instance: (instance != sys::INVALID_ID).then_some(GeometryId(instance)),
        }
    }
}
