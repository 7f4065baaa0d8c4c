//! Eight lanes against the scalar solver: the same hits and the same bits of
//! `t`, on every family of hard cases.
//!
//! Each group of eight is asked as it is drawn, rays and cylinders in pairs, and
//! as the tracer asks: one ray against eight cylinders, eight rays against one
//! cylinder. The range is the ray's own, or begins or ends at, just before or
//! just behind a hit, so that either end of the chord decides.
//!
//! Other kinds are solved eight rays at a time by their quick solvers, which leave cases
//! open: those that they don't are compared.

use std::array::from_fn;

use cyltrace::math::{LANES, LaneMask, LaneVectors, Lanes, Random, Ray};
use cyltrace::solid::lanes::{
    self, AllCapped, AllOpen, CylinderLanes, LaneCaps, MixedCaps, RayLanes,
};
use cyltrace::solid::quick::QuickLanes;
use cyltrace::solid::{Caps, ConvexSolid, Cylinder, Intersection, RayOrigin, triple_product};
use cyltrace::with_solid;
use cyltrace_oracle::cases::Problem;
use cyltrace_oracle::cases::{AnyFamily, Case, Family, Inputs};
use glam::DVec3;
use rayon::prelude::*;

const SEED: u64 = 51;
/// Groups of eight cases, for each family and kind of inputs.
const GROUPS: u64 = 2_000;

/// A ray as the tracer asks for it: its origin may be `shift` along the whole ray.
#[derive(Clone, Copy, Debug)]
struct Asked {
    ray: Ray,
    shift: f64,
}

/// Eight pairs and the lanes that are asked for.
struct Group {
    cylinders: [Cylinder; LANES],
    rays: [Asked; LANES],
    active: u8,
}

impl Group {
    /// The cylinders with these caps.
    fn with_caps(&self, caps: impl Fn(usize) -> Caps) -> Self {
        let recapped = |lane: usize| {
            let cylinder = &self.cylinders[lane];
            Cylinder::new(cylinder.p0(), cylinder.p1(), cylinder.radius(), caps(lane))
                .expect("it was one before")
        };
        Self {
            cylinders: from_fn(recapped),
            ..*self
        }
    }

    /// What the scalar solver answers, as bits.
    fn scalar(&self, lane: usize) -> Option<u64> {
        let (cylinder, asked) = (&self.cylinders[lane], &self.rays[lane]);
        let from_p0 = asked.ray.origin - cylinder.p0();
        let Ray {
            direction,
            t_min,
            t_max,
            ..
        } = asked.ray;
        triple_product::first(cylinder, from_p0, direction, asked.shift, t_min, t_max)
            .map(|intersection| intersection.t.to_bits())
    }

    /// Fails where the lanes answer otherwise; how many hits there are.
    fn verify(&self, caps: impl LaneCaps, family: Family, index: u64) -> u64 {
        let p0 = LaneVectors::of(&self.cylinders.map(|cylinder| cylinder.p0()));
        let cylinders = CylinderLanes {
            axis: LaneVectors::of(&self.cylinders.map(|cylinder| cylinder.p1())) - p0,
            radius: Lanes(self.cylinders.map(|cylinder| cylinder.radius())),
            caps,
        };
        let rays = RayLanes {
            from_p0: LaneVectors::of(&self.rays.map(|asked| asked.ray.origin)) - p0,
            direction: LaneVectors::of(&self.rays.map(|asked| asked.ray.direction)),
            shift: Lanes(self.rays.map(|asked| asked.shift)),
            t_min: Lanes(self.rays.map(|asked| asked.ray.t_min)),
            t_max: Lanes(self.rays.map(|asked| asked.ray.t_max)),
        };
        let (is_hit, t) = lanes::first(&cylinders, &rays, &LaneMask::from_bits(self.active));
        let mut hits = 0;
        for lane in 0..LANES {
            let is_active = self.active >> lane & 1 == 1;
            let expected = if is_active { self.scalar(lane) } else { None };
            let answered = is_hit.0[lane].then(|| t.0[lane].to_bits());
            assert_eq!(
                answered,
                expected,
                "seed {SEED}, family {}, group {index}, lane {lane}: {:?} {:?}",
                family.name(),
                self.cylinders[lane],
                self.rays[lane],
            );
            hits += u64::from(expected.is_some());
        }
        hits
    }
}

/// Moves the range's ends to where the answer may change, and the origin
/// along the ray.
fn asked(random: &mut Random, problem: &Problem) -> Asked {
    let Problem { cylinder, ray } = problem;
    let shift = match random.below(3) {
        0 => random.uniform(-4.0, 4.0),
        _ => 0.0,
    };
    let mut asked = Asked { ray: *ray, shift };
    let from_p0 = ray.origin - cylinder.p0();
    if let Some(chord) = triple_product::chord(cylinder, from_p0, ray.direction) {
        let mut limit = || {
            let end = [chord.enter.t, chord.leave.t][random.below(2) as usize] + shift;
            [end, end.next_up(), end.next_down()][random.below(3) as usize]
        };
        let (one, other) = (limit(), limit());
        match random.below(4) {
            0 => asked.ray.t_min = one,
            1 => asked.ray.t_max = one,
            2 => (asked.ray.t_min, asked.ray.t_max) = (one, other),
            _ => {}
        }
    }
    asked
}

/// Eight cases of a family.
fn group(family: Family, inputs: Inputs, index: u64) -> Group {
    let mut random = Random::new(SEED, index);
    let problems: [Problem; LANES] =
        from_fn(|lane| family.case(SEED, index * LANES as u64 + lane as u64, inputs));
    let mut rays = from_fn(|lane| asked(&mut random, &problems[lane]));
    let mut cylinders = problems.map(|problem| problem.cylinder);
    match random.below(3) {
        0 => rays = [rays[0]; LANES],
        1 => cylinders = [cylinders[0]; LANES],
        _ => {}
    }
    let active = match random.below(2) {
        0 => u8::MAX,
        _ => random.bits() as u8,
    };
    Group {
        cylinders,
        rays,
        active,
    }
}

#[test]
fn lanes_answer_as_the_scalar_solver_does() {
    for family in Family::ALL {
        for inputs in Inputs::ALL {
            let hits: u64 = (0..GROUPS)
                .into_par_iter()
                .map(|index| {
                    let group = group(family, inputs, index);
                    let caps = |lane| {
                        let [at_p0, at_p1] = [1, 2].map(|bit| (index + lane as u64) & bit != 0);
                        Caps::at(at_p0, at_p1)
                    };
                    let mixed = group.with_caps(caps);
                    let mixed_caps = MixedCaps(from_fn(caps));
                    mixed.verify(mixed_caps, family, index)
                        + group
                            .with_caps(|_| Caps::None)
                            .verify(AllOpen, family, index)
                        + group
                            .with_caps(|_| Caps::Both)
                            .verify(AllCapped, family, index)
                })
                .sum();
            // Some families aim past the solid, none always.
            assert!(hits > GROUPS, "{} has {hits} hits", family.name());
        }
    }
}

/// What became of the lanes of a family.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    open: u64,
    met: u64,
    missed: u64,
}

/// Rays, and where their origins are on the whole rays.
type Shifted = [(Ray, f64); LANES];

/// Eight rays at one solid: those of the solid's own case and of seven others of the family,
/// moved so that they are as far from it.
fn drawn_rays(cases: &[Case; LANES]) -> Shifted {
    cases.map(|Case { solid: own, ray }| {
        let origin = ray.origin - own.anchor();
        (Ray { origin, ..ray }, 0.0)
    })
}

/// The same with what is hard for solvers: origins on the surface, ranges that begin and end
/// there, numbers that are none.
fn hard_rays(solid: &impl ConvexSolid, drawn: &Shifted, random: &mut Random) -> Shifted {
    let mut rays = drawn.map(|(mut ray, _)| {
        let from_anchor = ray.origin;
        let shift = match random.below(3) {
            0 => random.uniform(-4.0, 4.0),
            _ => 0.0,
        };
        if let Some(chord) = solid.chord(from_anchor, ray.direction) {
            let end = [chord.enter.t, chord.leave.t][random.below(2) as usize];
            // Where rays start that leave a surface: there, or just behind.
            match random.below(4) {
                0 => ray.origin += ray.direction * end,
                1 => ray.origin += ray.direction * (end + 1e-14),
                _ => {}
            }
        }
        // The ends of the ray as it starts now, about which its range begins and ends.
        if let Some(chord) = solid.chord(ray.origin, ray.direction) {
            let size = solid.size() / ray.direction.length();
            let mut limit = || {
                let end = [chord.enter.t, chord.leave.t][random.below(2) as usize] + shift;
                let off = (random.below(33) as f64 - 16.0) * 1e-16 * size;
                [end, end.next_up(), end.next_down(), end + off][random.below(4) as usize]
            };
            let (one, other) = (limit(), limit());
            match random.below(6) {
                0 => ray.t_min = one,
                1 => ray.t_max = one,
                2 => (ray.t_min, ray.t_max) = (one, other),
                3 => (ray.t_min, ray.t_max) = (0.0, f64::INFINITY),
                4 => (ray.t_min, ray.t_max) = (-0.0, f64::NAN),
                _ => {}
            }
        }
        (ray, shift)
    });
    match random.below(16) {
        0 => rays[0].0.direction.x = f64::NAN,
        1 => rays[0].0.origin.y = f64::INFINITY,
        2 => rays[0].0.direction.z = f64::NEG_INFINITY,
        3 => rays[0].0.direction = DVec3::ZERO,
        4 => rays[0].0.origin = DVec3::NEG_X * 0.0,
        _ => {}
    }
    rays
}

fn in_lanes(rays: &Shifted) -> RayLanes {
    RayLanes {
        from_p0: LaneVectors::of(&rays.map(|(ray, _)| ray.origin)),
        direction: LaneVectors::of(&rays.map(|(ray, _)| ray.direction)),
        shift: Lanes(rays.map(|(_, shift)| shift)),
        t_min: Lanes(rays.map(|(ray, _)| ray.t_min)),
        t_max: Lanes(rays.map(|(ray, _)| ray.t_max)),
    }
}

/// Fails where a lane that is not open has another answer than the scalar solver, and, of a
/// kind that says so, another than the solver with exact decisions.
fn verify_quick<S: ConvexSolid>(solid: &S, rays: &RayLanes, active: u8, name: &str) -> Count {
    let lanes = LaneMask::from_bits(active);
    let answer = solid.first_in_lanes(rays, &lanes);
    let count = verify_lanes(solid, (rays, answer), active, name, |lane| {
        let (x, d, shift, [t_min, t_max]) = lane_of(rays, lane);
        solid.first(x, d, shift, t_min, t_max)
    });
    if S::QUICK_IS_EXACT {
        // Rays whose origins are points in f64, and what is seen of them from the anchor.
        let anchor = LaneVectors::splat(solid.anchor());
        let mut origins = rays.from_p0;
        for lane in 0..LANES {
            origins.set(lane, solid.anchor() + rays.from_p0.lane(lane));
        }
        let seen = RayLanes {
            from_p0: origins - anchor,
            ..*rays
        };
        let answer = solid.exact_first_in_lanes(&seen, &lanes);
        verify_lanes(solid, (&seen, answer), active, name, |lane| {
            let (_, d, shift, range) = lane_of(rays, lane);
            solid.exact_first(&RayOrigin::at(origins.lane(lane)), d, shift, range)
        });
    }
    count
}

/// The way to the origin, the direction, the shift and the range of a ray.
fn lane_of(rays: &RayLanes, lane: usize) -> (DVec3, DVec3, f64, [f64; 2]) {
    let (x, d) = (rays.from_p0.lane(lane), rays.direction.lane(lane));
    let range = [rays.t_min, rays.t_max].map(|lanes| lanes.0[lane]);
    (x, d, rays.shift.0[lane], range)
}

fn verify_lanes(
    solid: &impl ConvexSolid,
    (rays, answer): (&RayLanes, QuickLanes),
    active: u8,
    name: &str,
    first: impl Fn(usize) -> Option<Intersection>,
) -> Count {
    let mut count = Count::default();
    for lane in 0..LANES {
        let is_active = active >> lane & 1 == 1;
        let expected = first(lane).filter(|_| is_active);
        let is_met = answer.hit.0[lane];
        if answer.open.0[lane] {
            assert!(is_active && !is_met, "{name}: lane {lane}");
            count.open += 1;
            continue;
        }
        let found = is_met.then(|| answer.t.0[lane].to_bits());
        assert_eq!(
            found,
            expected.map(|intersection| intersection.t.to_bits()),
            "seed {SEED}, {name}, lane {lane}: {solid:?} {:?}",
            lane_of(rays, lane),
        );
        count.met += u64::from(is_met);
        count.missed += u64::from(!is_met);
    }
    count
}

#[test]
fn quick_solvers_answer_as_the_scalar_solvers_do_or_not_at_all() {
    for family in AnyFamily::all() {
        let name = family.name();
        for inputs in Inputs::ALL {
            let count = |index: u64| {
                let mut random = Random::new(SEED, index);
                let cases: [Case; LANES] =
                    from_fn(|lane| family.case(SEED, index * LANES as u64 + lane as u64, inputs));
                let active = match random.below(2) {
                    0 => u8::MAX,
                    _ => random.bits() as u8,
                };
                macro_rules! verify {
                    ($solid:expr) => {{
                        let drawn = drawn_rays(&cases);
                        let hard = hard_rays($solid, &drawn, &mut random);
                        verify_quick($solid, &in_lanes(&hard), active, &name);
                        verify_quick($solid, &in_lanes(&drawn), active, &name)
                    }};
                }
                with_solid!(&cases[0].solid, solid => verify!(solid))
            };
            let sum = |one: Count, other: Count| Count {
                open: one.open + other.open,
                met: one.met + other.met,
                missed: one.missed + other.missed,
            };
            let total = (0..GROUPS)
                .into_par_iter()
                .map(count)
                .reduce(Count::default, sum);
            let is_quick = ["sphere-", "disk-", "cuboid-", "cone-", "rounded-cone-"]
                .iter()
                .any(|kind| name.starts_with(kind));
            if is_quick && name.ends_with("uniform") {
                let Count { open, met, .. } = total;
                // The quick solvers are of use where few rays as drawn stay open.
                assert!(met > GROUPS && 10 * open < met, "{name}: {total:?}");
            }
        }
    }
}
