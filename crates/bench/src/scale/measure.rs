//! One scene after the other, each gone before the next.

use std::sync::Arc;
use std::time::Instant;

use glam::{DAffine3, DQuat, DVec3};

use crate::timing::Timer;
use crate::traversal::{
    Kind, Rays, Sample, Workers, camera_rays, interleave, random_rays, run_ours, sticks,
};
use cyltrace::math::Random;
use cyltrace::scene::{
    ExpectedCounts, ExpectedSolids, PlacedCount, Placement, Prototype, PrototypeIndex, Records,
    Scene,
};
use cyltrace::solid::SolidKind;
use cyltrace::tracer::{Layout, MemoryEstimate, Options, Tracer};
use cyltrace_output::readable;

/// What grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum Series {
    /// Sticks in a cube, 10^3 to 10^7 of them.
    Cylinders,
    /// Places of one prototype of [`Series::STICKS`] sticks, 10^2 to 10^7.
    Placements,
}

impl Series {
    /// Both, in the order of tables.
    pub const ALL: [Self; 2] = [Self::Cylinders, Self::Placements];

    /// The cylinders of the prototype that is placed.
    pub const STICKS: usize = 1000;

    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The numbers that are tried, up to `most`.
    #[must_use]
    pub fn sizes(self, most: usize) -> Vec<usize> {
        let first = match self {
            Self::Cylinders => 3,
            Self::Placements => 2,
        };
        let decades = (first..=7).map(|decade| 10_usize.pow(decade));
        decades.take_while(|&size| size <= most).collect()
    }

    fn scene(self, n: usize, seed: u64) -> Scene {
        match self {
            Self::Cylinders => sticks(n, seed),
            Self::Placements => placements(n, seed),
        }
    }

    /// Bytes that a scene of the series takes, before there is one.
    fn estimate(self, n: usize) -> u64 {
        let contents = |cylinders: usize, placements: usize| {
            let mut solids = ExpectedSolids::default();
            solids.add(SolidKind::Cylinder, cylinders as u64, Records::F64);
            ExpectedCounts {
                name: String::new(),
                solids,
                placed: vec![PlacedCount {
                    of: PrototypeIndex(1),
                    count: placements as u64,
                }],
                values_bytes: 0,
                is_used: true,
            }
        };
        let contents = match self {
            Self::Cylinders => vec![contents(n, 0)],
            Self::Placements => vec![contents(0, n), contents(Self::STICKS, 0)],
        };
        MemoryEstimate::of(&contents, Layout::default(), None).peak_bytes()
    }
}

/// A prototype of sticks in a unit cube, turned at random, `n` times in a cube
/// that has a cell of unit size for each.
fn placements(n: usize, seed: u64) -> Scene {
    let side = libm::cbrt(n as f64);
    let place = |number: u64| {
        let mut random = Random::new(seed, number);
        let position = DVec3::new(random.unit(), random.unit(), random.unit()) * side;
        let axis = random.direction();
        let (sin, cos) = libm::sincos(random.unit() * std::f64::consts::PI);
        let turn = DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos);
        Placement {
            of: PrototypeIndex(1),
            parent_from_child: DAffine3::from_rotation_translation(turn, position),
        }
    };
    let root = Prototype {
        placements: (0..n as u64).map(place).collect(),
        ..Prototype::default()
    };
    let mut scene = sticks(Series::STICKS, seed);
    scene.prototypes.insert(0, root);
    scene
}

/// What is measured.
pub struct Plan {
    /// The greatest number of either series.
    pub most: usize,
    /// Rays of each kind.
    pub rays: usize,
    /// Samples of each time, at least 1.
    pub rounds: usize,
    /// Chooses scenes and rays.
    pub seed: u64,
    /// The threads that trace.
    pub workers: Workers,
    /// Scenes that would take more bytes are left out.
    pub max_memory: u64,
    /// How scenes are built.
    pub options: Options,
}

/// The memory of this program as the system reports it.
pub struct Resident<'a> {
    /// Forgets the greatest size so far, where that can be done.
    pub forget: &'a dyn Fn(),
    /// The greatest resident size since, in bytes.
    pub peak: &'a dyn Fn() -> Option<u64>,
}

/// What was found of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Seconds to build the description's tracer.
    pub build_s: f64,
    /// The bytes of records and of Embree.
    pub bytes: usize,
    /// The program's greatest resident size while the scene was made, built and
    /// traced, if the system reports it.
    pub resident_bytes: Option<u64>,
    /// Camera rays a second.
    pub rays_per_s: f64,
    /// Incoherent rays a second.
    pub incoherent_rays_per_s: f64,
}

/// A scene of a series.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The number of cylinders or of placements.
    pub n: usize,
    /// What was found, or why nothing was.
    pub found: Result<Figures, String>,
}

/// The outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    /// The threads that traced.
    pub threads: usize,
    /// Rows by series, in the order of [`Series::ALL`].
    pub rows: [Vec<Row>; 2],
}

impl Scale {
    /// The number of steps that [`Scale::measure`] reports.
    #[must_use]
    pub fn steps(plan: &Plan) -> usize {
        let sizes = Series::ALL.map(|series| series.sizes(plan.most).len());
        sizes.iter().sum()
    }

    /// Measures everything; `after_step` is called as often as [`Scale::steps`]
    /// says.
    #[must_use]
    pub fn measure(
        plan: &Plan,
        resident: &Resident<'_>,
        timer: &mut dyn Timer,
        after_step: &mut dyn FnMut(),
    ) -> Self {
        let rows = Series::ALL.map(|series| {
            let sizes = series.sizes(plan.most).into_iter();
            let row = |n| {
                (resident.forget)();
                let found = measure(plan, series, n, timer).map(|found| Figures {
                    resident_bytes: (resident.peak)(),
                    ..found
                });
                after_step();
                Row { n, found }
            };
            sizes.map(row).collect()
        });
        Self {
            threads: plan.workers.threads,
            rows,
        }
    }

    /// The rows of a series.
    #[must_use]
    pub fn of(&self, series: Series) -> &[Row] {
        match series {
            Series::Cylinders => &self.rows[0],
            Series::Placements => &self.rows[1],
        }
    }
}

fn measure(
    plan: &Plan,
    series: Series,
    n: usize,
    timer: &mut dyn Timer,
) -> Result<Figures, String> {
    let estimate = series.estimate(n);
    if estimate > plan.max_memory {
        return Err(format!(
            "it needs about {} of memory, more than the {} that --max-memory allows",
            readable(estimate),
            readable(plan.max_memory)
        ));
    }
    let scene = Arc::new(series.scene(n, plan.seed));
    let start = Instant::now();
    let built = Tracer::new(Arc::clone(&scene), &plan.options);
    let build_s = start.elapsed().as_secs_f64();
    let tracer = built.map_err(|error| error.to_string())?;
    let bounds = tracer.bounds();
    let mut rate = |kind, rays| {
        let rays = Rays::new(kind, rays);
        let sample = Sample {
            workers: &plan.workers,
            count: plan.rays,
            run: Box::new(|range| run_ours(&tracer, &rays, range, true)),
        };
        let times = interleave(timer, &[sample], plan.rounds);
        plan.rays as f64 / times[0].sample().median
    };
    let rays_per_s = rate(Kind::Coherent, camera_rays(&scene, &bounds, plan.rays));
    let random = random_rays(&bounds, plan.rays, plan.seed);
    let incoherent_rays_per_s = rate(Kind::Incoherent, random);
    let statistics = tracer.statistics();
    Ok(Figures {
        build_s,
        bytes: statistics.embree_bytes + statistics.records_bytes,
        resident_bytes: None,
        rays_per_s,
        incoherent_rays_per_s,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::timing::WallClock;

    #[test]
    fn sizes_are_decades_up_to_the_most() {
        assert_eq!(Series::Cylinders.sizes(20_000), [1000, 10_000]);
        assert_eq!(Series::Placements.sizes(1000), [100, 1000]);
        assert_eq!(Series::Placements.sizes(usize::MAX).len(), 6);
        assert!(Series::Cylinders.sizes(999).is_empty());
    }

    #[test]
    fn measure_memory_is_of_each_scene_alone_and_what_does_not_fit_is_left_out() {
        let plan = Plan {
            most: 10_000,
            rays: 256,
            rounds: 1,
            seed: 2,
            workers: Workers::new(1).unwrap(),
            max_memory: Series::Placements.estimate(1000),
            options: Options::default(),
        };
        let resident = Resident {
            forget: &|| {},
            peak: &|| Some(7),
        };
        let mut steps = 0;
        let mut after = || steps += 1;
        let found = Scale::measure(&plan, &resident, &mut WallClock, &mut after);
        assert_eq!((steps, Scale::steps(&plan)), (5, 5));
        let [cylinders, placements] = &found.rows;
        let small = cylinders[0].found.as_ref().unwrap();
        assert!((100_000..300_000).contains(&small.bytes), "{}", small.bytes);
        assert_eq!(small.resident_bytes, Some(7));
        assert!(cylinders[1].found.is_err(), "10^4 cylinders do not fit");
        let bytes = |row: &Row| row.found.as_ref().unwrap().bytes;
        let (few, more) = (bytes(&placements[0]), bytes(&placements[1]));
        // 900 more placements of some 150 to 500 bytes each.
        assert!(few > small.bytes / 2, "the prototype counts: {few}");
        assert!((100_000..500_000).contains(&(more - few)), "{few} {more}");
        assert!(found.fits(Series::Placements).bytes.is_some());
        assert_eq!(found.fits(Series::Cylinders).bytes, None);
    }
}
