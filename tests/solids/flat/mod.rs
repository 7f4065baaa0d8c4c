//! Spheres, cuboids and disks against exact arithmetic, family by family.
//!
//! `CYLTRACE_CASES` sets the number of cases of a family with f32 inputs; with f64
//! inputs there are a tenth of them.

mod judged;

use std::fmt::Debug;
use std::ops::AddAssign;

use cyltrace::math::{Random, Ray, UNIT_ROUNDOFF, power_of_two_below};
use cyltrace::solid::{ChordEnd, ConvexSolid, Disk, Sphere};
use cyltrace_oracle::cases::{CuboidFamily, DiskFamily, Inputs, SphereFamily};
use cyltrace_oracle::{Exact, ExactAffine, ExactRay, ExactVector, TrueChord, exact, to_f64};
use glam::{DAffine3, DVec3};
use judged::{Judged, between};
use rayon::prelude::*;

const SEED: u64 = 6;

fn case_count() -> u64 {
    std::env::var("CYLTRACE_CASES").map_or(10_000, |count| count.parse().expect("a number"))
}

/// What a family came to.
#[derive(Clone, Debug, Default)]
struct Tally {
    cases: u64,
    hits: u64,
    tangents: u64,
    /// Where the answer differs from that of the exact numbers as stated.
    wrong: u64,
    /// Errors of `t` in ulps of f32, that of the rounding to f32 not counted.
    offs: Vec<f64>,
    /// The share of the bound of the error that a point used.
    share: f64,
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.cases += other.cases;
        self.hits += other.hits;
        self.tangents += other.tangents;
        self.wrong += other.wrong;
        self.offs.extend(other.offs);
        self.share = self.share.max(other.share);
    }
}

impl Tally {
    fn quantile(&mut self, share: f64) -> f64 {
        self.offs.sort_by(f64::total_cmp);
        let last = self.offs.len().saturating_sub(1);
        self.offs
            .get((last as f64 * share) as usize)
            .copied()
            .unwrap_or(0.0)
    }
}

/// The size of the error of `t` in ulps of f32 of the true one.
fn off(t: f64, truth: &Exact) -> f64 {
    let size = to_f64(truth).abs();
    let error = to_f64(&(exact(t) - truth)).abs();
    if error == 0.0 {
        return 0.0;
    }
    error / (power_of_two_below(size) * f64::from(f32::EPSILON))
}

/// Whether the solver has the truth's answer: hit or miss, parts, and in range.
fn agrees<S: Judged>(solid: &S, ray: &Ray, truth: Option<&TrueChord>) -> bool {
    let found = solid.chord(ray.origin - solid.anchor(), ray.direction);
    let (Some(found), Some(truth)) = (&found, truth) else {
        return found.is_none() == truth.is_none();
    };
    let [enter, leave] = truth.ends();
    let intersections = found.intersections(solid.caps(), 0.0, ray.t_min, ray.t_max);
    let hits = truth.hits(&ExactRay::new(ray));
    found.enter.part == enter.part
        && found.leave.part == leave.part
        && found.lies_on == truth.lies_on
        && intersections
            .map(|hit| (hit.part, hit.crossing))
            .eq(hits.iter().map(|hit| (hit.part, hit.crossing)))
}

/// Everything that is promised of one case.
fn judge<S: Judged>(stated: &S, ray: &Ray) -> Tally {
    let mut tally = Tally {
        cases: 1,
        ..Tally::default()
    };
    let stated_truth = stated.true_chord(ray);
    if !agrees(stated, ray, stated_truth.as_ref()) {
        // The difference of origin and anchor is rounded, which changes no number
        // by more than half an ulp; the rest is what is of second order.
        let gap = stated.gap(ray);
        assert!(
            gap <= UNIT_ROUNDOFF * (1.0 + 1e-6),
            "{stated:?} {ray:?}: {gap:e}"
        );
        tally.wrong += 1;
    }

    // What the solver is given, as exact numbers: no exception.
    let solid = stated.around_zero();
    let x = ray.origin - stated.anchor();
    let ray = Ray { origin: x, ..*ray };
    let truth = solid.true_chord(&ray);
    let show = || format!("{stated:?} {ray:?}: {:?}", solid.chord(x, ray.direction));
    assert!(agrees(&solid, &ray, truth.as_ref()), "{}", show());

    let found = solid.chord(x, ray.direction);
    let is_inside = found.is_some_and(|chord| chord.enter.t <= 0.0 && 0.0 <= chord.leave.t);
    assert_eq!(is_inside, solid.contains(x), "{}", show());
    assert_eq!(is_inside, solid.truly_holds(x), "{}", show());

    let back = solid.chord(x, -ray.direction);
    let (Some(chord), Some(truth)) = (found, truth) else {
        assert_eq!(back, None, "{}", show());
        return tally;
    };
    let turned = |end: ChordEnd| ChordEnd { t: -end.t, ..end };
    let back = back.expect("a line is met from both sides");
    assert_eq!(
        (chord.enter, chord.leave, chord.lies_on),
        (turned(back.leave), turned(back.enter), back.lies_on),
        "{}",
        show()
    );

    tally.hits = 1;
    tally.tangents = u64::from(chord.enter.t == chord.leave.t);
    assert!(chord.enter.t <= chord.leave.t, "{}", show());
    for (end, true_end) in [chord.enter, chord.leave].into_iter().zip(truth.ends()) {
        tally.offs.push(off(end.t, &true_end.t));
        let met = stated.surface_point(end.part, x + ray.direction * end.t);
        let distance = stated.distance(end.part, met.point);
        tally.share = tally.share.max(distance / met.error);
        assert!(distance <= met.error, "{distance:e} > {met:?}: {}", show());
        assert!(
            (met.normal.length() - 1.0).abs() <= 16.0 * UNIT_ROUNDOFF,
            "{}",
            show()
        );
        assert!(
            (0.0..=1.0).contains(&met.u()) && (0.0..=1.0).contains(&met.v),
            "{}",
            show()
        );
        let bounds = stated.bounds().grown(met.error);
        let point = met.point;
        assert!(
            bounds.lower.cmple(point).all() && point.cmple(bounds.upper).all(),
            "{}",
            show()
        );
        // The nearest point of the surface is where the ray is, to within the
        // roundings of the way there.
        let true_point =
            &ExactVector::new(ray.origin) + &ExactVector::new(ray.direction).times(&true_end.t);
        let way = (&true_point - &between(stated.anchor(), point)).length();
        let t_error = to_f64(&(exact(end.t) - &true_end.t)).abs() * ray.direction.length();
        let along = (ray.direction * end.t).length();
        let roundings = 32.0 * UNIT_ROUNDOFF * (x.length() + along) + 2.0 * t_error;
        assert!(way <= met.error + roundings, "{way:e} {met:?}: {}", show());
    }
    tally
}

/// Judges a family; with f32 inputs nothing may be wrong.
fn judge_family<S: Judged>(
    name: &dyn Debug,
    inputs: Inputs,
    case: impl Fn(u64) -> Option<(S, Ray)> + Sync,
) -> Tally {
    let count = match inputs {
        Inputs::F32 => case_count(),
        Inputs::F64 => case_count() / 10,
    };
    let mut tally = (0..count)
        .into_par_iter()
        .filter_map(|index| case(index).map(|(solid, ray)| judge(&solid, &ray)))
        .reduce(Tally::default, |mut sum, other| {
            sum += other;
            sum
        });
    let quantile = tally.quantile(0.999);
    let most = tally.quantile(1.0);
    println!(
        "{name:?} {}: {} cases, {} hits, {} tangents, {} wrong, t p99.9 {:.6}, most {most:.2e}, point {:.2}",
        inputs.name(),
        tally.cases,
        tally.hits,
        tally.tangents,
        tally.wrong,
        0.5 + quantile,
        tally.share
    );
    assert!(
        10 * tally.cases > 9 * count,
        "{name:?}: {} cases",
        tally.cases
    );
    assert!(
        10 * tally.hits > tally.cases,
        "{name:?}: {} hits",
        tally.hits
    );
    if inputs == Inputs::F32 {
        assert_eq!(tally.wrong, 0, "{name:?}");
        assert!(0.5 + quantile <= 0.501, "{name:?}: {quantile}");
    }
    tally
}

#[test]
fn spheres_agree_with_exact_arithmetic() {
    for inputs in Inputs::ALL {
        for family in SphereFamily::ALL {
            let tally = judge_family(&family, inputs, |index| family.case(SEED, index, inputs));
            if family == SphereFamily::Tangent {
                assert_eq!(tally.tangents, tally.cases);
            }
        }
    }
}

#[test]
fn cuboids_agree_with_exact_arithmetic() {
    for inputs in Inputs::ALL {
        for family in CuboidFamily::ALL {
            let tally = judge_family(&family, inputs, |index| family.case(SEED, index, inputs));
            if matches!(family, CuboidFamily::Edge | CuboidFamily::Corner) {
                assert!(
                    20 * tally.tangents > tally.cases,
                    "{family:?}: {}",
                    tally.tangents
                );
            }
        }
    }
}

#[test]
fn disks_agree_with_exact_arithmetic() {
    for inputs in Inputs::ALL {
        for family in DiskFamily::ALL {
            judge_family(&family, inputs, |index| family.case(SEED, index, inputs));
        }
    }
}

/// Points of the surface and their neighbours, of which about half are inside.
fn judge_containment<S: Judged>(case: impl Fn(u64) -> Option<(S, Ray)>) {
    let (mut inside, mut outside) = (0, 0);
    for index in 0..case_count() / 10 {
        let Some((solid, ray)) = case(index) else {
            continue;
        };
        let x = ray.origin - solid.anchor();
        let Some(chord) = solid.chord(x, ray.direction) else {
            continue;
        };
        let end = chord.enter;
        let point = solid
            .surface_point(end.part, x + ray.direction * end.t)
            .point;
        let step = |axis: DVec3, up: bool| {
            let next = |x: f64| if up { x.next_up() } else { x.next_down() };
            DVec3::select(axis.cmpne(DVec3::ZERO), point.map(next), point)
        };
        let mut near = vec![point, solid.anchor(), point * f64::MAX];
        for axis in DVec3::AXES {
            near.extend([step(axis, true), step(axis, false)]);
        }
        for point in near.into_iter().filter(|point| point.is_finite()) {
            let truth = solid.truly_holds(point);
            assert_eq!(solid.contains(point), truth, "{solid:?} {point:?}");
            *(if truth { &mut inside } else { &mut outside }) += 1;
        }
        assert!(!solid.contains(DVec3::new(f64::NAN, point.y, point.z)));
        assert!(!solid.contains(DVec3::INFINITY));
    }
    assert!(
        inside.min(outside) * 20 > inside.max(outside),
        "{inside} inside, {outside} outside"
    );
}

#[test]
fn containment_is_exact_next_to_the_surface() {
    for inputs in Inputs::ALL {
        for family in [
            SphereFamily::Uniform,
            SphereFamily::Tangent,
            SphereFamily::Scale,
        ] {
            judge_containment(|index| family.case(SEED, index, inputs));
        }
        for family in [CuboidFamily::Edge, CuboidFamily::Face, CuboidFamily::Scale] {
            judge_containment(|index| family.case(SEED, index, inputs));
        }
        for family in [DiskFamily::ExactRim, DiskFamily::WithinPlane] {
            judge_containment(|index| family.case(SEED, index, inputs));
        }
    }
}

/// The corners are `center + F⁻¹ y`, here by the adjugate.
#[test]
fn bounds_of_cuboids_hold_their_exact_corners() {
    for family in [
        CuboidFamily::Uniform,
        CuboidFamily::Thin,
        CuboidFamily::Scale,
    ] {
        for index in 0..case_count() / 10 {
            let Some((cuboid, _)) = family.case(SEED, index, Inputs::F64) else {
                continue;
            };
            let rows = cuboid.orientation().world_from_object().transpose();
            let (adjugate, determinant) = ExactAffine::new(&DAffine3::from_mat3(rows)).adjugate();
            let bounds = cuboid.bounds();
            let scaled = |v: DVec3| ExactVector::new(v).times(&determinant);
            let (lower, upper) = (scaled(bounds.lower), scaled(bounds.upper));
            for corner in 0..8 {
                let side = |bit: u32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
                let own = cuboid.half_widths() * DVec3::new(side(0), side(1), side(2));
                let corner = &scaled(cuboid.center()) + &adjugate.times(&ExactVector::new(own));
                for axis in 0..3 {
                    let within = lower.0[axis] <= corner.0[axis] && corner.0[axis] <= upper.0[axis];
                    assert!(within, "{cuboid:?} {own} {bounds:?}");
                }
            }
        }
    }
}

#[test]
fn numbers_that_are_none_are_misses() {
    let mut random = Random::new(SEED, 0);
    for family in CuboidFamily::ALL {
        let Some((cuboid, ray)) = family.case(SEED, 1, Inputs::F32) else {
            continue;
        };
        let sphere = Sphere::new(cuboid.center(), cuboid.half_widths().x).unwrap();
        let disk = Disk::new(cuboid.center(), DVec3::Z, cuboid.half_widths().x).unwrap();
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let axis = random.below(3) as usize;
            let (mut x, mut d) = (ray.origin, ray.direction);
            x[axis] = bad;
            d[axis] = bad;
            for (x, d) in [(x, ray.direction), (ray.origin, d)] {
                assert_eq!(cuboid.chord(x, d), None);
                assert_eq!(sphere.chord(x, d), None);
                assert_eq!(disk.chord(x, d), None);
            }
        }
    }
}
