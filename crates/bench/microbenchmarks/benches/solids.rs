//! Time per ray of the solver of each kind of solid beside the cylinder's, by
//! criterion, for rays of ordinary cases, of cases from afar and of origins on the
//! surface.
//!
//! `cargo bench -p microbenchmarks --bench solids`; a kind as argument picks one. What a solver gets right
//! is measured by `cyltrace stress`.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use cyltrace::solid::{AnySolid, ConvexSolid};
use cyltrace_oracle::cases::{AnyFamily, Case, Inputs};
use glam::DVec3;

const SEED: u64 = 3;
/// As many as `solvers` times: of 2000 the branch predictor learns a good part by
/// heart.
const CASES: u64 = 8_192;

/// The families by which kinds are compared, the same rows for each.
const FAMILIES: [[&str; 3]; 6] = [
    ["nominal", "far", "surf_in"],
    ["cone-uniform", "cone-far", "cone-from-wall"],
    [
        "rounded-cone-uniform",
        "rounded-cone-far",
        "rounded-cone-from-wall",
    ],
    ["sphere-uniform", "sphere-far", "sphere-surface"],
    ["cuboid-uniform", "cuboid-far", "cuboid-surface"],
    ["disk-uniform", "disk-far", "disk-surface"],
];

/// A solid, where its ray starts as seen from it, and the ray's direction.
type Line<S> = (S, DVec3, DVec3);

fn time<S: ConvexSolid>(
    criterion: &mut Criterion,
    name: &str,
    of: impl Fn(&AnySolid) -> Option<S>,
) {
    let family: AnyFamily = name.parse().expect("a family");
    let line = |index| {
        let Case { solid, ray } = family.case(SEED, index, Inputs::F32);
        let solid = of(&solid).expect("a solid of the family's kind");
        (solid, ray.origin - solid.anchor(), ray.direction)
    };
    let lines: Vec<Line<S>> = (0..CASES).map(line).collect();
    let mut group = criterion.benchmark_group(S::KIND.name());
    group.throughput(Throughput::Elements(CASES));
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            for (solid, x, d) in black_box(&lines) {
                black_box(solid.first(*x, *d, 0.0, 0.0, f64::INFINITY));
            }
        });
    });
    group.finish();
}

/// Kinds take turns, so that none has the machine's better minutes.
fn solids(criterion: &mut Criterion) {
    macro_rules! one {
        ($name:expr, $kind:ident) => {
            time(criterion, $name, |solid| match solid {
                AnySolid::$kind(solid) => Some(*solid),
                _ => None,
            })
        };
    }
    let [cylinders, cones, rounded_cones, spheres, cuboids, disks] = FAMILIES;
    for row in 0..3 {
        one!(cylinders[row], Cylinder);
        one!(cones[row], Cone);
        one!(rounded_cones[row], RoundedCone);
        one!(spheres[row], Sphere);
        one!(cuboids[row], Cuboid);
        one!(disks[row], Disk);
    }
}

criterion_group!(benches, solids);
criterion_main!(benches);
