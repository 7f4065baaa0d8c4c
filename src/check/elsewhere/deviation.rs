//! How far a right mesh may be from the surface that it represents.
//!
//! A mesh that `tessellate` made deviates by a length that is derived for each solid on its
//! own, in the solid's own space, from the number of sides and the fit: `D` of
//! `deviation_of`, on one side of the surface alone, and `E` of `corner_error_of` on both.
//! So an inscribed mesh lies between the depths `D + E` and `-E` of its solid, a circumscribed
//! one between `E` and `-D - E`. A placement maps both surfaces alike, so that this is true in the
//! solid's own space whatever the placement is; what rounding the placement of a vertex adds
//! is proportional to the solid's extent and part of the tolerance.
//!
//! # Why a comment cannot widen the tolerance
//!
//! A file states its segments and fit in comments, which anybody can write. They are used only if
//!
//! - the mesh has no more triangles than `tessellate` makes of the scene with these segments.
//!   The number of triangles rises with the segments, so a comment that states fewer segments
//!   than a mesh was made with is rejected. One that states more makes the tolerance narrower;
//! - the deviation that the file states is no less than the one derived for the scene, which is the
//!   greatest of all solids. So no solid gets more than the file states.
//!
//! Otherwise the stated deviation applies to every solid, and to the rule that it must be
//! less than the least radius. With the comments used, the same rule applies to each solid: what its
//! mesh may lack inward must be less than its radius. For inscribed meshes `D` is at most 0.57
//! radii, at 3 segments. A circumscribed mesh lacks nothing inward: a ray that is deeper in a solid
//! than `E` and misses the mesh is proven wrong at any number of segments.

use crate::mesh_file::{MeshFile, Plan};
use crate::scene::Scene;
use crate::solid::AnySolid;
use crate::solid::tessellation::{Fit, corner_error_of, deviation_of};

/// How far a mesh may be from the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Deviation {
    /// By this length in scene units, everywhere.
    Everywhere(f64),
    /// By what `tessellate` derives for each solid.
    Tessellated {
        /// Sides around an axis.
        segments: u32,
        /// The side of the surface on which the mesh is.
        fit: Fit,
    },
}

/// By how much the mesh of a solid may be off its surface, in the solid's own space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Slack {
    /// Inside of the surface.
    pub inward: f64,
    /// Outside of it.
    pub outward: f64,
}

impl Deviation {
    /// The deviation of a mesh file of a scene, by its comments: see the head of this file.
    /// `None` if they state no deviation.
    #[must_use]
    pub fn stated(file: &MeshFile, scene: &Scene) -> Option<Self> {
        let stated = file.deviation?;
        let made = file.made.filter(|made| {
            Plan::new(scene, made.segments, made.fit).is_ok_and(|plan| {
                file.mesh.triangles.len() as u128 <= plan.triangles() && plan.deviation() <= stated
            })
        });
        Some(match made {
            Some(made) => Self::Tessellated {
                segments: made.segments,
                fit: made.fit,
            },
            None => Self::Everywhere(stated),
        })
    }

    /// The part in scene units that is the same everywhere.
    pub(super) fn everywhere(self) -> f64 {
        match self {
            Self::Everywhere(length) => length,
            Self::Tessellated { .. } => 0.0,
        }
    }

    /// The part that depends on the solid.
    pub(super) fn slack(self, solid: &AnySolid) -> Slack {
        let Self::Tessellated { segments, fit } = self else {
            return Slack::default();
        };
        let error = corner_error_of(solid, segments);
        let deviation = deviation_of(solid, segments, fit) + error;
        match fit {
            Fit::Inscribed => Slack {
                inward: deviation,
                outward: error,
            },
            Fit::Circumscribed => Slack {
                inward: error,
                outward: deviation,
            },
        }
    }
}

impl Slack {
    /// On either side.
    pub fn greatest(self) -> f64 {
        self.inward.max(self.outward)
    }

    /// The same on both sides.
    pub fn both(length: f64) -> Self {
        Self {
            inward: length,
            outward: length,
        }
    }

    /// That of a composition, whose operands may be inside out.
    pub fn of_parts(parts: impl Iterator<Item = Self>) -> Self {
        Self::both(parts.map(Self::greatest).fold(0.0, f64::max))
    }
}
