//! The library's own tracer from end to end: f64 rays, Embree's tree, the
//! solver in the callback, and the point, normal and error bound of the hit.

use std::sync::Arc;

use super::spaced::Spaced;
use super::{Rival, Row, measured_cylinders};
use crate::formulations::{Answer, Batch, Precision, Problem};
use cyltrace::math::Ray;
use cyltrace::scene::{CylinderRecord, MaterialIndex, Prototype, Scene, Solids};
use cyltrace::solid::Cylinder;
use cyltrace::tracer::{Options, Tracer, TracerError};

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
}

impl Rival for Traced {
    fn row(&self) -> Row {
        Row {
            name: Self::NAME,
            precision: Precision::F64,
            bytes: self.bytes,
        }
    }

    fn answer(&self, problem: &Problem) -> Option<Answer> {
        let tracer = Tracer::new(scene_of(&[problem.cylinder]), &self.options).ok()?;
        let hit = tracer.closest(&problem.ray)?;
        Some(Answer {
            t: hit.t,
            part: hit.part,
            normal: hit.normal,
        })
    }

    fn timed(&self, spaced: Spaced) -> Box<dyn Batch> {
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
        solids: Solids::of_cylinders((0..).zip(cylinders).map(|(primitive, cylinder)| {
            CylinderRecord::new(cylinder, primitive, MaterialIndex::default())
        })),
        ..Prototype::default()
    };
    Arc::new(Scene::new(vec![root]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formulations::Formulation;
    use crate::samples::{self, Shifted};

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
