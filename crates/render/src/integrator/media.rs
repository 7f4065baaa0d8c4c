//! What is on each side of glass.
//!
//! The index of refraction on a side of a surface is that of the solids of glass that contain the
//! start of a ray to that side, which lies beyond all rounding errors of the surface. Where several
//! contain it, the last in the order of placements and primitives counts. So solids may overlap,
//! touch and lie in each other, and a surface within its own material has no effect.

use cyltrace::math::{Bounds, Ray};
use cyltrace::scene::{MaterialIndex, MaterialKind};
use cyltrace::solid::Part;
use cyltrace::tracer::PartialHit;
use glam::DVec3;

use super::segment::Path;
use super::{View, facing_normal, normal};

impl View<'_> {
    /// The index of refraction around the start of what clip planes leave of a camera ray: 1 at a
    /// plane, as solids in front of it are removed.
    pub(super) fn ior_before(&self, ray: &Ray) -> f64 {
        match self.clips.start(ray) {
            true => 1.0,
            false => self.ior_at(ray.origin),
        }
    }

    /// The cut face where a path in glass leaves what clip planes leave.
    pub(super) fn cut_from_inside(
        &self,
        path: &Path,
        hit: Option<&PartialHit>,
    ) -> Option<PartialHit> {
        match hit {
            None if path.ior != 1.0 => self.clips.at_end(self.tracer, &path.ray),
            _ => None,
        }
    }

    /// The index of refraction behind a surface that a path reaches. Nothing is behind a plane
    /// that it leaves through.
    pub(super) fn ior_behind(&self, path: &Path, hit: &PartialHit) -> f64 {
        let side = facing_normal(&path.ray, hit);
        let is_outward = normal(hit).dot(side) < 0.0;
        match hit.part() == Part::Cut && is_outward {
            true => 1.0,
            false => self.ior_at(self.spawn(hit, -side).origin),
        }
    }

    /// The index of refraction at a point.
    pub(super) fn ior_at(&self, point: DVec3) -> f64 {
        if !self.has_glass || !self.bounds.meets(&Bounds::at(point)) {
            return 1.0;
        }
        let materials = &self.tracer.scene().materials;
        let ior = |material: MaterialIndex| match materials[usize::from(material.0)].kind {
            MaterialKind::Glass { ior, .. } => Some(ior),
            _ => None,
        };
        let material = self.tracer.material_at(point, |one| ior(one).is_some());
        material.and_then(ior).unwrap_or(1.0)
    }
}
