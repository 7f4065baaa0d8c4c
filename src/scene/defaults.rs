//! The default values of a scene, for keys missing from a file and for scenes made
//! without a file.

use glam::DVec3;

use super::background::Background;
use super::description::{
    Camera, Film, Frame, Integrator, Projection, Prototype, RenderSettings, Sampler, Scene,
};
use super::illustration::Illustration;
use super::material::Material;

pub(super) const FOV_DEGREES: f64 = 40.0;

pub(super) const FILM: Film = Film {
    width: 1280,
    height: 720,
};

pub(super) const RENDER: RenderSettings = RenderSettings {
    integrator: Integrator::Sun,
    spp: 4,
    sampler: Sampler::Sobol,
    max_depth: 16,
    ao_distance: f64::INFINITY,
};

/// The reflectance of solids without a material.
const REFLECTANCE: f64 = 0.5;

/// The material of solids without a material.
pub(super) fn material() -> Material {
    Material::diffuse("", DVec3::splat(REFLECTANCE))
}

impl Scene {
    /// A scene of these prototypes, with default values otherwise. The first
    /// prototype is the root.
    #[must_use]
    pub fn new(prototypes: Vec<Prototype>) -> Self {
        Self {
            prototypes,
            materials: vec![material()],
            camera: Camera {
                projection: Projection::Perspective {
                    fov_degrees: FOV_DEGREES,
                },
                frame: Frame::Auto,
                lens: None,
            },
            film: FILM,
            render: RENDER,
            sun: None,
            sky: None,
            clear_sky: None,
            environment: None,
            lights: Vec::new(),
            clips: Vec::new(),
            legend: None,
            illustration: Illustration::default(),
            background: Background::DEFAULT,
            skipped_rows: 0,
            notes: Vec::new(),
        }
    }
}
