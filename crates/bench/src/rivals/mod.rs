//! What analytic cylinders are compared with: Embree's own curve, meshes of
//! any fineness, and the whole tracer on the same scene.
//!
//! They answer whole queries: Embree walks its tree to a primitive, and
//! intersects it by itself or calls back. So their times are not those of
//! solvers; [`tracer`](Traced) is the row to compare them with.
//!
//! *Errors* are found on a scene a problem, built for it alone, in which the
//! one cylinder, curve or mesh is at its stated place: nothing but the rival's
//! own f32 is to blame. What Embree cannot take (coordinates beyond its
//! limit, ends that coincide in f32) counts as a miss. *Times* are of one
//! scene of cylinders apart from one another ([`Spaced`]), the same for all.

mod native;
mod shape;
mod spaced;
mod traced;

use glam::DVec3;

use crate::formulations::{Answer, Batch, Formulation, Precision, Problem};
use cyltrace::solid::{Caps, Cylinder};

pub(super) use native::ray_for_embree;
pub use native::{Native, SIDES};
pub use shape::Shape;
pub use spaced::Spaced;
pub use traced::Traced;

/// What answers by whole scenes.
trait Rival: Send + Sync {
    /// What tables say of it.
    fn row(&self) -> Row;

    /// The answer for a problem whose cylinder is a scene of its own; `None`
    /// also where the scene or the ray is refused.
    fn answer(&self, problem: &Problem) -> Option<Answer>;

    /// One scene and rays into it, ready to be timed.
    fn timed(&self, spaced: Spaced) -> Box<dyn Batch>;
}

/// See [`Formulation`].
struct Row {
    name: &'static str,
    precision: Precision,
    bytes: usize,
}

impl<R: Rival> Formulation for R {
    fn name(&self) -> &'static str {
        self.row().name
    }

    fn precision(&self) -> Precision {
        self.row().precision
    }

    fn bytes(&self) -> usize {
        self.row().bytes
    }

    fn answers(&self, problems: &[Problem]) -> Vec<Option<Answer>> {
        problems
            .iter()
            .map(|problem| self.answer(problem))
            .collect()
    }

    fn batch(&self, problems: &[Problem]) -> Box<dyn Batch> {
        self.timed(Spaced::new(problems, CYLINDERS_TIMED))
    }
}

/// Cylinders in the scene that is timed. The finest mesh has 4096 triangles a
/// cylinder, a million in all; fewer cylinders would leave too little of a
/// tree to walk.
const CYLINDERS_TIMED: usize = 256;

/// Cylinders whose memory is measured: with both disks, side by side.
fn measured_cylinders() -> Vec<Cylinder> {
    (0..CYLINDERS_TIMED)
        .map(|index| {
            let p0 = DVec3::X * (4 * index) as f64;
            Cylinder::new(p0, p0 + DVec3::Z * 3.0, 1.0, Caps::Both)
                .expect("a length and a radius of usual size")
        })
        .collect()
}
