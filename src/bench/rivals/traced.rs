//! The library's own tracer from end to end: f64 rays, Embree's tree, the
//! solver in the callback, and the point, normal and error bound of the hit.

use std::sync::Arc;

use glam::DVec3;

use super::spaced::Spaced;
use super::{CYLINDERS_TIMED, measured_cylinders};
use crate::math::Ray;
use crate::scene::{
    Camera, CylinderRecord, Film, Frame, Integrator, MaterialIndex, Projection, Prototype,
    RenderSettings, Scene,
};
use crate::solid::Cylinder;
use crate::solid::formulations::{Answer, Batch, Formulation, Precision, Problem};
use crate::tracer::{Options, Tracer, TracerError};

/// Cylinders as the tracer keeps them.
#[derive(Debug)]
pub struct Traced {
    options: Options,
    bytes: usize,
}

impl Traced {
    /// The name in tables.
    pub const NAME: &str = "tracer";

    /// Makes ready to trace, and measures what is kept for a cylinder.
    ///
    /// # Errors
    /// When Embree cannot be set up.
    pub fn new(options: Options) -> Result<Self, TracerError> {
        let cylinders = measured_cylinders();
        let tracer = Tracer::new(scene_of(&cylinders), &options)?;
        let statistics = tracer.statistics();
        let bytes = statistics.embree_bytes + statistics.records_bytes;
        Ok(Self {
            options,
            bytes: bytes / cylinders.len(),
        })
    }

    /// The answer for a problem whose cylinder is a scene of its own; `None`
    /// also where the tracer refuses the scene.
    fn answer(&self, problem: &Problem) -> Option<Answer> {
        let tracer = Tracer::new(scene_of(&[problem.cylinder]), &self.options).ok()?;
        let hit = tracer.closest(&problem.ray)?;
        Some(Answer {
            t: hit.t,
            part: hit.part,
            normal: hit.normal,
        })
    }
}

impl Formulation for Traced {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn precision(&self) -> Precision {
        Precision::F64
    }

    fn bytes(&self) -> usize {
        self.bytes
    }

    fn answers(&self, problems: &[Problem]) -> Vec<Option<Answer>> {
        problems
            .iter()
            .map(|problem| self.answer(problem))
            .collect()
    }

    fn batch(&self, problems: &[Problem]) -> Box<dyn Batch> {
        let spaced = Spaced::new(problems, CYLINDERS_TIMED);
        Box::new(TracedBatch {
            tracer: Tracer::new(scene_of(&spaced.cylinders), &self.options)
                .expect("Embree takes a scene of cylinders of usual size"),
            rays: spaced.rays,
        })
    }
}

/// One scene and rays into it.
struct TracedBatch {
    tracer: Tracer,
    rays: Vec<Ray>,
}

impl Batch for TracedBatch {
    fn run(&self) -> u64 {
        self.rays.iter().fold(0, |sum: u64, ray| {
            let hit = self.tracer.closest(ray);
            sum.wrapping_add(hit.map_or(0, |hit| hit.t.to_bits()))
        })
    }
}

/// A scene of these cylinders and nothing else.
fn scene_of(cylinders: &[Cylinder]) -> Arc<Scene> {
    let root = Prototype {
        cylinders: (0..)
            .zip(cylinders)
            .map(|(primitive, cylinder)| {
                CylinderRecord::new(cylinder, primitive, MaterialIndex::default())
            })
            .collect(),
        ..Prototype::default()
    };
    Arc::new(Scene {
        prototypes: vec![root],
        materials: Vec::new(),
        camera: Camera {
            projection: Projection::Orthographic { height: None },
            frame: Frame::Auto,
        },
        film: Film {
            width: 1,
            height: 1,
        },
        render: RenderSettings {
            integrator: Integrator::default(),
            spp: 1,
        },
        sun: None,
        sky: None,
        background: DVec3::ZERO,
        skipped_rows: 0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::samples::{self, Shifted};

    #[test]
    fn tracer_answers_as_its_solver_does() {
        const SEED: u64 = 8;
        let problems = samples::problems(SEED, 100);
        let traced = Traced::new(Options::default()).unwrap();
        let found = traced.answers(&problems);
        for (index, expected) in Shifted(0.0).answers(&problems).iter().enumerate() {
            let pair = (found[index], expected);
            let agree = match pair {
                (Some(found), Some(expected)) => {
                    found.part == expected.part && (found.t - expected.t).abs() < 1e-12
                }
                (found, expected) => found.is_none() && expected.is_none(),
            };
            assert!(agree, "seed {SEED}, case {index}: {pair:?}");
        }
        // A record is 64 bytes; Embree's tree and ids come on top.
        assert!((64..1000).contains(&traced.bytes()), "{}", traced.bytes());
    }
}
