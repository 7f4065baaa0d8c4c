//! What is on each side of glass.
//!
//! The index of refraction on a side of a surface is that of the solids of glass that contain the
//! start of a ray to that side, which lies beyond all rounding errors of the surface. Where several
//! contain it, the last in the order of placements and primitives counts. So solids may overlap,
//! touch and lie in each other, and a surface within its own material has no effect.

use cyltrace::math::Bounds;
use cyltrace::scene::MaterialKind;
use glam::DVec3;

use super::View;

impl View<'_> {
    /// The index of refraction at a point.
    pub(super) fn ior_at(&self, point: DVec3) -> f64 {
        if !self.has_glass || !self.bounds.meets(&Bounds::at(point)) {
            return 1.0;
        }
        let scene = self.tracer.scene();
        let containing = self.tracer.contains(point);
        let iors = containing.iter().rev().filter_map(|solid| {
            let solids = &scene.prototypes[solid.prototype.0 as usize].solids;
            let material = solids.material(solid.solid, solid.primitive)?;
            match scene.materials[usize::from(material.0)].kind {
                MaterialKind::Glass { ior, .. } => Some(ior),
                _ => None,
            }
        });
        iors.into_iter().next().unwrap_or(1.0)
    }
}
