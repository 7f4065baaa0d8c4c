//! Time per ray of every formulation, by criterion: hits and misses apart; and
//! time per pair of eight lanes, under the target features of the build.
//!
//! `cargo bench -p microbenchmarks --bench solvers`; a name as argument picks formulations. The
//! cases are ordinary ones, so this says what a formulation costs and nothing
//! of what it gets wrong: that is `cyltrace bench accuracy`.

use std::array::from_fn;
use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use cyltrace::math::{LANES, LaneMask, LaneVectors, Lanes, Random, Ray};
use cyltrace::solid::lanes::{self, AllCapped, CylinderLanes, RayLanes};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace_bench::formulations::Problem;
use glam::DVec3;

const SEED: u64 = 3;
/// So many as `cyltrace bench accuracy` times: of 2000 the branch predictor learns
/// a good part by heart.
const PROBLEMS: usize = 8_192;

/// Capped cylinders of ordinary size, rays from some lengths away that are
/// aimed up to two radii from the axis. All numbers are f32.
fn problem(random: &mut Random) -> Problem {
    let round = |v: DVec3| v.as_vec3().as_dvec3();
    let p0 = round(random.direction() * random.uniform(0.0, 2.0));
    let along = random.direction() * random.uniform(0.5, 4.0);
    let radius = random.uniform(0.1, 1.0);
    let target = p0
        + along * random.uniform(-0.2, 1.2)
        + along.cross(random.direction()).normalize() * (radius * random.uniform(0.0, 2.0));
    let origin = round(target + random.direction() * random.uniform(5.0, 20.0));
    let direction = round((target - origin) * random.uniform(0.1, 1.0));
    let radius = round(DVec3::splat(radius)).x;
    let cylinder = Cylinder::new(p0, round(p0 + along), radius, Caps::Both).expect("a cylinder");
    Problem {
        cylinder,
        ray: Ray::new(origin, direction),
    }
}

/// Problems of which all are hits, or all are misses.
fn problems(are_hits: bool) -> Vec<Problem> {
    let mut random = Random::new(SEED, u64::from(are_hits));
    std::iter::repeat_with(|| problem(&mut random))
        .filter(|problem| {
            let truth = cyltrace_oracle::first_hit(&problem.cylinder, &problem.ray);
            truth.hit.is_some() == are_hits
        })
        .take(PROBLEMS)
        .collect()
}

fn solvers(criterion: &mut Criterion) {
    for (name, are_hits) in [("hits", true), ("misses", false)] {
        let problems = problems(are_hits);
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(PROBLEMS as u64));
        for formulation in cyltrace_bench::formulations::all() {
            let batch = formulation.batch(&problems);
            let id = BenchmarkId::new(formulation.name(), formulation.precision().name());
            group.bench_function(id, |bencher| bencher.iter(|| black_box(&batch).run()));
        }
        group.finish();
    }
}

/// The problems by eights. Whether the ray or the cylinder is the same in all
/// lanes makes no difference to what is computed.
fn groups(problems: &[Problem]) -> Vec<(CylinderLanes<AllCapped>, RayLanes)> {
    let group = |chunk: &[Problem]| {
        let each = |of: fn(&Problem) -> DVec3| LaneVectors::of(&from_fn(|lane| of(&chunk[lane])));
        let number = |of: fn(&Problem) -> f64| Lanes(from_fn(|lane| of(&chunk[lane])));
        let p0 = each(|problem| problem.cylinder.p0());
        let cylinders = CylinderLanes {
            axis: each(|problem| problem.cylinder.p1()) - p0,
            radius: number(|problem| problem.cylinder.radius()),
            caps: AllCapped,
        };
        let rays = RayLanes {
            from_p0: each(|problem| problem.ray.origin) - p0,
            direction: each(|problem| problem.ray.direction),
            shift: Lanes::splat(0.0),
            t_min: number(|problem| problem.ray.t_min),
            t_max: number(|problem| problem.ray.t_max),
        };
        (cylinders, rays)
    };
    problems.chunks_exact(LANES).map(group).collect()
}

fn eight_lanes(criterion: &mut Criterion) {
    for (name, are_hits) in [("hits", true), ("misses", false)] {
        let problems = problems(are_hits);
        let mut benchmarks = criterion.benchmark_group(name);
        benchmarks.throughput(Throughput::Elements(PROBLEMS as u64));
        let groups = groups(&problems);
        let active = LaneMask::splat(true);
        benchmarks.bench_function("triple-product/8 lanes", |bencher| {
            bencher.iter(|| {
                for (cylinders, rays) in black_box(&groups) {
                    black_box(lanes::first(cylinders, rays, &active));
                }
            });
        });
        benchmarks.finish();
    }
}

criterion_group!(benches, solvers, eight_lanes);
criterion_main!(benches);
