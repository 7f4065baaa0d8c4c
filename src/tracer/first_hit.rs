//! The minimal result of a query.

use super::query::{Nearest, SolidSlot};
use crate::scene::{PrototypeIndex, Scene};
use crate::solid::SolidKind;

/// The first hit of a ray: its parameter and its solid, which a query finds before any other
/// field is computed. Embree's own queries return the same. [`Tracer::hit`](super::Tracer::hit)
/// computes the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstHit {
    /// The ray's parameter.
    pub t: f64,
    /// The hit of the normalized ray.
    pub(super) nearest: Nearest,
}

impl FirstHit {
    /// The prototype that contains the solid.
    #[must_use]
    pub fn prototype(&self) -> PrototypeIndex {
        self.nearest.place.prototype
    }

    /// The solid's number within its prototype, in the scene that was traced.
    ///
    /// # Panics
    /// When the hit belongs to another scene.
    #[must_use]
    pub fn primitive(&self, scene: &Scene) -> u32 {
        let SolidSlot { kind, record } = self.nearest.place.member;
        let prototype = &scene.prototypes[self.prototype().0 as usize];
        prototype.solids.primitive(kind, record as usize)
    }

    /// The kind of solid.
    #[must_use]
    pub fn solid(&self) -> SolidKind {
        self.nearest.place.member.kind
    }

    /// The placements from the root to the prototype, outermost first.
    #[must_use]
    pub fn instance(&self) -> &[u32] {
        &self.nearest.place.path
    }

    /// From a hit of the normalized ray, and the factor from its `t` to the caller's.
    #[inline]
    pub(super) fn new(nearest: Nearest, factor: f64) -> Self {
        Self {
            t: nearest.t * factor,
            nearest,
        }
    }
}
