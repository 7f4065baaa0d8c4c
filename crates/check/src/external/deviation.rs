//! By how much a right mesh may be off its surface.
//!
//! The deviation of a mesh made by `tessellate` is derived for each solid,
//! in the solid's own space, from the number of sides and the fit: `D` of
//! `deviation_of`, on one side of the surface alone, and `E` of `corner_error_of` on both.
//! The mesh lies between two solids, within `E`:
//!
//! - of a cylinder, a cone or a disk, all rings are scaled by one factor, at most `1 - D/R` or
//!   `1 + D/R` in the middle of a side or at a corner, with `R` the greatest radius, while the
//!   planes of the ends stay. So an inscribed mesh lies between the solid with its radii times
//!   `1 - D/R` and the solid itself, a circumscribed one between the solid and that with its radii
//!   times `1 + D/R`. A plate is not uncertain along its axis because it is wide;
//! - of the other kinds, depths are off: between `D` and 0 inward, or 0 and `D` outward.
//!
//! A placement maps surface and mesh alike, so this is true in the solid's own space for any
//! placement. The rounding of a placed vertex is proportional to the solid's extent
//! and part of the tolerance.
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

use cyltrace::meshes::{MeshFile, Plan};
use cyltrace::scene::Scene;
use cyltrace::solid::AnySolid;
use cyltrace::solid::tessellation::{Fit, corner_error_of, deviation_of};

use crate::solids::{Shape, shape};

/// By how much a mesh may be off the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Deviation {
    /// By this length in scene units, everywhere.
    Everywhere(f64),
    /// By the length that `tessellate` derives for each solid.
    Tessellated {
        /// Sides around an axis.
        segments: u32,
        /// The side of the surface on which the mesh lies.
        fit: Fit,
    },
}

/// By how much the mesh of a solid may be off its surface, in the solid's own space: see the head
/// of this file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slack {
    /// The radii of the inner solid, relative to the true ones.
    inner_scale: f64,
    /// The radii of the outer one.
    pub outer_scale: f64,
    /// How far inside of the inner one the mesh may lie.
    pub inward: f64,
    /// How far outside of the outer one.
    pub outward: f64,
    /// The distance from the surface is at most this.
    pub greatest: f64,
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
            return Slack::NONE;
        };
        let error = corner_error_of(solid, segments);
        let deviation = deviation_of(solid, segments, fit);
        let share = match fit {
            Fit::Inscribed => -deviation / solid.radius(),
            Fit::Circumscribed => deviation / solid.radius(),
        };
        let mut slack = Slack {
            greatest: deviation + error,
            ..Slack::both(error)
        };
        let has_disks = shape(solid).with_radii_scaled(1.0).is_some();
        let (affected, by) = match (has_disks, fit) {
            (true, Fit::Inscribed) => (&mut slack.inner_scale, share),
            (true, Fit::Circumscribed) => (&mut slack.outer_scale, share),
            (false, Fit::Inscribed) => (&mut slack.inward, deviation),
            (false, Fit::Circumscribed) => (&mut slack.outward, deviation),
        };
        *affected += by;
        slack
    }
}

impl Slack {
    /// On the surface.
    pub const NONE: Self = Self {
        inner_scale: 1.0,
        outer_scale: 1.0,
        inward: 0.0,
        outward: 0.0,
        greatest: 0.0,
    };

    /// The same on both sides.
    pub fn both(length: f64) -> Self {
        Self {
            inward: length,
            outward: length,
            greatest: length,
            ..Self::NONE
        }
    }

    /// The slack of a composition, whose operands may be inside out.
    pub fn of_parts(parts: impl Iterator<Item = Self>) -> Self {
        Self::both(parts.map(|part| part.greatest).fold(0.0, f64::max))
    }

    /// The inner one of both solids.
    pub fn inner(&self, shape: &Shape) -> Shape {
        shape.with_radii_scaled(self.inner_scale).unwrap_or(*shape)
    }

    /// The outer one.
    pub fn outer(&self, shape: &Shape) -> Shape {
        shape.with_radii_scaled(self.outer_scale).unwrap_or(*shape)
    }

    /// The rest of a solid's radius where its mesh lacks most.
    pub fn spare_radius(&self, radius: f64) -> f64 {
        self.inner_scale * radius - self.inward
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::solid::{Caps, Cylinder, Sphere};
    use glam::DVec3;

    #[test]
    fn mesh_of_a_cylinder_is_between_cylinders_and_that_of_a_ball_between_depths() {
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z, 2.0, Caps::Both).expect("a cylinder");
        let solid = AnySolid::from(cylinder);
        // Six sides: cos(π/6) = √3/2.
        let slack = |fit, solid| Deviation::Tessellated { segments: 6, fit }.slack(solid);
        let radius = |shape: Shape| {
            let outline = shape.get().outline();
            assert_eq!(outline.length, 1.0);
            outline.radius
        };
        let own = shape(&solid);
        let inscribed = slack(Fit::Inscribed, &solid);
        assert!((radius(inscribed.inner(&own)) - 3.0_f64.sqrt()).abs() < 1e-14);
        assert_eq!(radius(inscribed.outer(&own)), 2.0);
        let circumscribed = slack(Fit::Circumscribed, &solid);
        assert_eq!(radius(circumscribed.inner(&own)), 2.0);
        assert!((radius(circumscribed.outer(&own)) - 4.0 / 3.0_f64.sqrt()).abs() < 1e-14);
        assert!(circumscribed.inward < 1e-13 && circumscribed.outward < 1e-13);
        let ball = AnySolid::from(Sphere::new(DVec3::ZERO, 2.0).expect("a ball"));
        let inscribed = slack(Fit::Inscribed, &ball);
        assert!(inscribed.inward > 0.1 && inscribed.outward < 1e-13);
        assert_eq!(inscribed.greatest, inscribed.inward);
    }
}
