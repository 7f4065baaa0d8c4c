//! Hits of `cyltrace trace` against exact arithmetic, one cylinder at a time.
//!
//! `CYLTRACE_SCENES=200` is the full run of the placed and the f64 scenes; the
//! f32 scenes are always run in full.
//!
//! With u = 2^-53, `a = p1 - p0`, `x = o - p0`, `n = a × d` and the gap
//! `g = |radius² |n|² - w²| / (radius² |n|²)` of `docs/derivations.md`,
//! section 2, the promises that are tested here are:
//!
//! | inputs | hit and part | `t` on the wall | `t` on a disk |
//! |---|---|---|---|
//! | f32 | right | `8 u (t + (r + |x|) |a| / (|n| √g))` | `8 u (t s + (|x| + |a|) |a| / |a·d|)` |
//! | f64 | right for `g > 20 u (1 + |x|/r + k)`, with `--exact` always | `10 u (t k + (r + |x| + t |d|) |a| / (|n| √g))` | the same |
//!
//! with `s = |a| |d| / |a·d|` and `k = |a| |d| / |n|`: products of f64 inputs
//! round, which is as if the direction were off by a few u.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::hit_rows::Row;
use cyltrace::math::{Random, Ray};
use cyltrace::solid::{Caps, Cylinder, Part};
use cyltrace_oracle::ExactAffine;
use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

const SEED: u64 = 7;
const RAYS: u64 = 1_000;
const UNIT: f64 = f64::EPSILON / 2.0;

/// How the numbers of a scene are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Inputs {
    F32,
    F64,
}

impl Inputs {
    fn round(self, vector: DVec3) -> DVec3 {
        match self {
            Self::F32 => vector.as_vec3().as_dvec3(),
            Self::F64 => vector,
        }
    }
}

/// A cylinder whose radius and length are log-uniform within `sizes`.
fn cylinder(random: &mut Random, inputs: Inputs, radius: [f64; 2], length: [f64; 2]) -> Cylinder {
    let r = random.log_uniform(radius[0], radius[1]);
    let l = random.log_uniform(length[0], length[1]);
    let offset = random.log_uniform(1e-2, 1e2) * l;
    let p0 = inputs.round(random.direction() * offset);
    let p1 = inputs.round(p0 + random.direction() * l);
    let r = inputs.round(DVec3::splat(r)).x;
    let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
    Cylinder::new(p0, p1, r, caps).expect("a cylinder")
}

/// A ray from `distance` away; half of them pass the wall at 1e-3 to 1e-7 of
/// the radius from touching it.
fn ray_at(random: &mut Random, inputs: Inputs, cylinder: &Cylinder, distance: f64) -> Ray {
    let along = cylinder.p1() - cylinder.p0();
    let axis = along.normalize();
    let outward = axis.cross(random.direction()).normalize();
    let middle = cylinder.p0() + along * random.uniform(-0.05, 1.05);
    let (target, heading) = if random.below(2) == 0 {
        let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
        let graze = 1.0 + side * random.log_uniform(1e-7, 1e-3);
        let heading = outward.cross(axis) + axis * random.uniform(-2.0, 2.0);
        (
            middle + outward * (cylinder.radius() * graze),
            heading.normalize(),
        )
    } else {
        let inside = random.uniform(0.0, 1.1) * cylinder.radius();
        (middle + outward * inside, random.direction())
    };
    let origin = inputs.round(target - heading * distance);
    let direction = inputs.round((target - origin) * random.log_uniform(1e-3, 1e3));
    Ray::new(origin, direction)
}

/// A ray nearly along the axis: at an angle of 1e-1 to 1e-8, from beyond the
/// ends or between them, 1e-3 to 1e-12 of the radius from touching the wall.
fn ray_along(random: &mut Random, inputs: Inputs, cylinder: &Cylinder, _distance: f64) -> Ray {
    let along = cylinder.p1() - cylinder.p0();
    let axis = along.normalize();
    let outward = axis.cross(random.direction()).normalize();
    let sign = |random: &mut Random| if random.below(2) == 0 { 1.0 } else { -1.0 };
    let graze = 1.0 + sign(random) * random.log_uniform(1e-12, 1e-3);
    let target =
        cylinder.p0() + along * random.uniform(0.2, 0.8) + outward * (cylinder.radius() * graze);
    let heading = axis + outward.cross(axis) * random.log_uniform(1e-8, 1e-1);
    let way = sign(random) * random.log_uniform(0.1, 10.0) * along.length();
    let origin = inputs.round(target - heading * way);
    Ray::new(origin, inputs.round(target - origin))
}

/// What the judge of a scene found.
#[derive(Default)]
struct Tally {
    rays: AtomicU64,
    hits: AtomicU64,
    unpromised: AtomicU64,
    /// The greatest `|t - t*|` over its bound, in units of 1e-6.
    worst_t: AtomicU64,
}

impl Tally {
    fn note_t(&self, used: f64) {
        self.worst_t
            .fetch_max((used * 1e6) as u64, Ordering::Relaxed);
    }

    fn report(&self, name: &str) {
        let [rays, hits, unpromised, worst] =
            [&self.rays, &self.hits, &self.unpromised, &self.worst_t]
                .map(|count| count.load(Ordering::Relaxed));
        println!(
            "{name}: {rays} rays, {hits} hits, {unpromised} within the band of no promise, \
             t used at most {:.3} of its bound",
            worst as f64 * 1e-6
        );
        assert!(
            hits > rays / 4 && hits < rays,
            "{name}: the cases are lopsided"
        );
    }
}

/// Judges one ray of a scene without placements.
fn judge(
    (inputs, is_exact): (Inputs, bool),
    cylinder: &Cylinder,
    ray: &Ray,
    row: Option<&Row>,
    tally: &Tally,
) {
    let truth = cyltrace_oracle::first_hit(cylinder, ray);
    let case = || {
        format!(
            "seed {SEED}, {inputs:?}, {cylinder:?}, ray {}",
            test_support::bits(ray)
        )
    };
    let a = cylinder.p1() - cylinder.p0();
    let x = ray.origin - cylinder.p0();
    let d = ray.direction;
    let n = a.cross(d).length();
    let (a_size, x_size, d_size, r) = (a.length(), x.length(), d.length(), cylinder.radius());
    let k = a_size * d_size / n;
    tally.rays.fetch_add(1, Ordering::Relaxed);

    let found = row.map(|row| row.part.as_str());
    let expected = truth.hit.as_ref().map(|hit| hit.part.name());
    if found != expected {
        let is_apart = truth.wall_gap > 20.0 * UNIT * (1.0 + x_size / r + k);
        let promised = is_exact || inputs == Inputs::F32 || is_apart;
        assert!(
            !promised,
            "{found:?} instead of {expected:?}, gap {:e}: {}",
            truth.wall_gap,
            case()
        );
        tally.unpromised.fetch_add(1, Ordering::Relaxed);
        return;
    }
    let (Some(row), Some(hit)) = (row, &truth.hit) else {
        return;
    };
    tally.hits.fetch_add(1, Ordering::Relaxed);

    assert_eq!(row.crossing, hit.crossing.name(), "{}", case());
    let t = hit.t_f64();
    let off = cyltrace_oracle::to_f64(&(cyltrace_oracle::exact(row.t) - &hit.t)).abs();
    let bound = match hit.part {
        Part::Side => {
            let reach = a_size / (n * truth.wall_gap.sqrt());
            match inputs {
                Inputs::F32 => 8.0 * (t.abs() + (r + x_size) * reach),
                Inputs::F64 => 10.0 * (t.abs() * k + (r + x_size + t.abs() * d_size) * reach),
            }
        }
        Part::Cap0 | Part::Cap1 => {
            let ad = a.dot(d).abs();
            8.0 * (t.abs() * a_size * d_size + (x_size + a_size) * a_size) / ad
        }
        part => panic!("a cylinder has no part {}", part.name()),
    };
    let used = off / (UNIT * bound);
    assert!(
        used <= 1.0,
        "t = {:e} is off by {off:e}, {used} of the bound: {}",
        row.t,
        case()
    );
    tally.note_t(used);

    let distance =
        cyltrace_oracle::distance_to_part(cylinder, hit.part, &ExactAffine::identity(), row.point);
    assert!(
        distance <= row.error,
        "{distance:e} from the surface, {row:?}: {}",
        case()
    );
    let largest = cylinder
        .p0()
        .abs()
        .max(cylinder.p1().abs())
        .max_element()
        .max(r);
    assert!(
        row.error <= 1e-12 * largest,
        "error {:e}: {}",
        row.error,
        case()
    );
}

fn toml(cylinder: &Cylinder) -> String {
    let vector = |v: DVec3| format!("[{:e}, {:e}, {:e}]", v.x, v.y, v.z);
    let caps = match cylinder.caps() {
        Caps::None => "none",
        Caps::P0 => "p0",
        Caps::P1 => "p1",
        Caps::Both => "both",
    };
    format!(
        "p0 = {}\np1 = {}\nradius = {:e}\ncaps = \"{caps}\"\n",
        vector(cylinder.p0()),
        vector(cylinder.p1()),
        cylinder.radius()
    )
}

fn scene_count(default: u64) -> u64 {
    std::env::var("CYLTRACE_SCENES").map_or(default, |count| count.parse().expect("a number"))
}

fn one_cylinder_scenes(
    name: &str,
    inputs: Inputs,
    scenes: u64,
    ray_of: fn(&mut Random, Inputs, &Cylinder, f64) -> Ray,
) {
    let tally = Tally::default();
    (0..scenes).into_par_iter().for_each(|scene| {
        let mut random = Random::new(SEED, scene);
        let cylinder = cylinder(&mut random, inputs, [1e-4, 1e4], [1e-4, 1e4]);
        let distance = random.log_uniform(1e-4, 1e4);
        let rays: Vec<Ray> = (0..RAYS)
            .map(|_| ray_of(&mut random, inputs, &cylinder, distance))
            .collect();
        let folder = tempfile::tempdir().unwrap();
        let text = format!("[[cylinder]]\n{}", toml(&cylinder));
        for (options, is_exact) in [(&[][..], false), (&["--exact"], true)] {
            let rows = crate::hit_rows::trace(folder.path(), &text, &rays, options);
            for (ray, row) in rays.iter().zip(&rows) {
                judge((inputs, is_exact), &cylinder, ray, row.as_ref(), &tally);
            }
        }
    });
    tally.report(name);
}

#[test]
fn f32_inputs_agree_with_exact_arithmetic() {
    one_cylinder_scenes("f32 inputs", Inputs::F32, 200, ray_at);
}

#[test]
fn f64_inputs_agree_outside_their_band() {
    one_cylinder_scenes("f64 inputs", Inputs::F64, scene_count(60), ray_at);
}

#[test]
fn rays_nearly_along_the_axis_agree_outside_their_band() {
    one_cylinder_scenes("along the axis", Inputs::F64, scene_count(60), ray_along);
}

/// A rotation, scales from 0.1 to 10 that differ by axis, and a translation.
fn placement(random: &mut Random, size: f64) -> DAffine3 {
    let rotation = |random: &mut Random| {
        let axis = random.direction();
        let across = axis.cross(random.direction()).normalize();
        DMat3::from_cols(axis, across, axis.cross(across))
    };
    let mut scale = || random.log_uniform(0.1, 10.0);
    let scales = DMat3::from_diagonal(DVec3::new(scale(), scale(), scale()));
    let matrix = rotation(random) * scales * rotation(random);
    DAffine3::from_mat3_translation(
        matrix,
        random.direction() * (size * random.uniform(0.0, 100.0)),
    )
}

/// Through a placement: no difference but for gaps below 1e-8, `t` within
/// `1e-6 (t + r/|d|)` always and within 1e-13 in the median.
#[test]
fn placed_cylinders_agree_with_exact_arithmetic() {
    let tally = Tally::default();
    let relative: Vec<f64> = (0..scene_count(60))
        .into_par_iter()
        .flat_map_iter(|scene| {
            let mut random = Random::new(SEED, 1_000_000 + scene);
            let length = random.log_uniform(1e-4, 1e4);
            let slenderness = random.log_uniform(1.0, 1e3);
            let radius = length / slenderness;
            let cylinder = cylinder(&mut random, Inputs::F64, [radius, radius], [length, length]);
            let place = placement(&mut random, length);
            let rays: Vec<Ray> = (0..RAYS)
                .map(|_| {
                    let distance = length * random.log_uniform(0.01, 10.0);
                    let ray = ray_at(&mut random, Inputs::F64, &cylinder, distance);
                    Ray {
                        origin: place.transform_point3(ray.origin),
                        direction: place.transform_vector3(ray.direction),
                        ..ray
                    }
                })
                .collect();
            let row = |i: usize| {
                let (m, t) = (place.matrix3.row(i), place.translation[i]);
                format!("[{:e}, {:e}, {:e}, {t:e}]", m.x, m.y, m.z)
            };
            let text = format!(
                "[[prototype]]\nname = \"one\"\n[[prototype.cylinder]]\n{}\
                 [[instance]]\nof = \"one\"\nmatrix = [{}, {}, {}]\n",
                toml(&cylinder),
                row(0),
                row(1),
                row(2)
            );
            let folder = tempfile::tempdir().unwrap();
            let rows = crate::hit_rows::trace(folder.path(), &text, &rays, &[]);
            let judged = rays.iter().zip(&rows);
            judged
                .filter_map(|(ray, row)| judge_placed(&cylinder, &place, ray, row.as_ref(), &tally))
                .collect::<Vec<_>>()
        })
        .collect();
    tally.report("placed");
    let mut sorted = relative;
    sorted.sort_by(f64::total_cmp);
    let median = sorted[sorted.len() / 2];
    println!("placed: median of |t - t*| / (t* + r/|d|) is {median:e}");
    assert!(median <= 1e-13, "{median:e}");
}

/// Answers with the error of `t` relative to `t* + r/|d|`.
fn judge_placed(
    cylinder: &Cylinder,
    place: &DAffine3,
    ray: &Ray,
    row: Option<&Row>,
    tally: &Tally,
) -> Option<f64> {
    let exact_place = ExactAffine::new(place);
    let truth = cyltrace_oracle::placed_first_hit(cylinder, &exact_place, ray);
    let case = || {
        format!(
            "seed {SEED}, {cylinder:?}, {place:?}, ray {}",
            test_support::bits(ray)
        )
    };
    tally.rays.fetch_add(1, Ordering::Relaxed);
    let found = row.map(|row| row.part.as_str());
    let expected = truth.hit.as_ref().map(|hit| hit.part.name());
    if found != expected {
        assert!(
            truth.wall_gap < 1e-8,
            "{found:?} instead of {expected:?}, gap {:e}: {}",
            truth.wall_gap,
            case()
        );
        tally.unpromised.fetch_add(1, Ordering::Relaxed);
        return None;
    }
    let (row, hit) = (row?, truth.hit?);
    tally.hits.fetch_add(1, Ordering::Relaxed);
    let off = cyltrace_oracle::to_f64(&(cyltrace_oracle::exact(row.t) - &hit.t)).abs();
    let local_direction = place.matrix3.inverse() * ray.direction;
    let relative = off / (row.t.abs() + cylinder.radius() / local_direction.length());
    assert!(
        relative <= 1e-6,
        "t = {:e} is off by {off:e}: {}",
        row.t,
        case()
    );
    tally.note_t(relative / 1e-6);
    let distance = cyltrace_oracle::distance_to_part(cylinder, hit.part, &exact_place, row.point);
    assert!(
        distance <= row.error,
        "{distance:e} from the surface, {row:?}: {}",
        case()
    );
    Some(relative)
}
