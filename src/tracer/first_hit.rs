//! The least that a query answers.

use super::query::{Nearest, SolidSlot};
use crate::scene::{PrototypeIndex, Scene};
use crate::solid::SolidKind;

/// Where a ray first meets a surface, and which: what a query finds out before
/// anything is worked out of it, as Embree's own queries do.
/// [`Tracer::hit`](super::Tracer::hit) has the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstHit {
    /// The ray's parameter.
    pub t: f64,
    /// The hit of the ray in use, whose direction is of usual length.
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
    /// When the hit is of another scene.
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

    /// A hit of the ray in use, with the factor that turns its `t` back.
    #[inline]
    pub(super) fn new(nearest: Nearest, factor: f64) -> Self {
        Self {
            t: nearest.t * factor,
            nearest,
        }
    }
}
