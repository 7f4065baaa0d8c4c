//! The colors of surfaces at hits.

use cyltrace::scene::Scene;
use cyltrace::tracer::{HitFields, PartialHit};
use glam::DVec3;

/// The colors of a scene's materials.
pub(crate) struct Colors {
    constant: Vec<DVec3>,
}

impl Colors {
    pub fn new(scene: &Scene) -> Self {
        let materials = scene.materials.iter();
        Self {
            constant: materials.map(|one| one.color.average()).collect(),
        }
    }

    /// The fields of a hit that determine its color.
    pub fn fields(&self) -> HitFields {
        HitFields::empty()
    }

    /// The color of the surface at a hit with at least these fields.
    pub fn at(&self, hit: &PartialHit) -> DVec3 {
        self.constant[usize::from(hit.material().0)]
    }
}
