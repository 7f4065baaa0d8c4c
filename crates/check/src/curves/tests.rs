//! Cone curves against the oracle, and the solids that have none.

use glam::DAffine3;

use super::*;
use cyltrace::embree::DeviceOptions;
use cyltrace::math::{Random, Ray};
use cyltrace_oracle::{ExactAffine, placed_first_hit};

const SEED: u64 = 92;

fn segment_of(cylinder: &Cylinder, map: &DAffine3) -> Option<Segment> {
    Segment::new(cylinder, &map.matrix3, map.transform_point3(cylinder.p0()))
}

fn random_cylinder(random: &mut Random, longest: f64) -> Cylinder {
    let middle = random.direction() * random.uniform(0.0, 1.0);
    let half = random.direction() * random.log_uniform(0.05, longest / 2.0);
    let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
    let radius = random.log_uniform(0.02, 0.2);
    Cylinder::new(middle - half, middle + half, radius, caps).unwrap()
}

/// A rotation, a mirror or not, and a uniform scale; then a shift.
fn similarity(random: &mut Random) -> DAffine3 {
    let axis = random.direction();
    let aside = axis.cross(random.direction()).normalize();
    let turn = DMat3::from_cols(axis, aside, axis.cross(aside));
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    DAffine3 {
        matrix3: turn * (sign * random.uniform(0.5, 1.5)),
        translation: random.direction() * 0.5,
    }
}

/// The first hit of the placed solids, by the oracle.
fn truth(solids: &[Cylinder], maps: &[ExactAffine], ray: &Ray) -> Option<CurveHit> {
    let hits = solids
        .iter()
        .zip(maps)
        .zip(0..)
        .filter_map(|((solid, map), number)| {
            let hit = placed_first_hit(solid, map, ray).hit?;
            Some(CurveHit {
                t: hit.t_f64(),
                solid: Some(number),
            })
        });
    hits.min_by(|one, other| one.t.total_cmp(&other.t))
}

fn ray(random: &mut Random) -> (Ray32, Ray) {
    let origin = (random.direction() * 3.0).as_vec3();
    let target = (random.direction() * random.uniform(0.0, 1.0)).as_vec3();
    let direction = (target - origin) * random.log_uniform(0.1, 10.0) as f32;
    let ray32 = Ray32 {
        origin: origin.to_array(),
        direction: direction.to_array(),
        t_near: 0.0,
        t_far: f32::INFINITY,
    };
    (ray32, Ray::new(origin.as_dvec3(), direction.as_dvec3()))
}

#[test]
fn segment_takes_circular_images_only() {
    for case in 0..500 {
        let mut random = Random::new(SEED, case);
        let cylinder = random_cylinder(&mut random, 2.0);
        let similar = similarity(&mut random);
        let segment = segment_of(&cylinder, &similar).unwrap();
        let [p0, p1] = segment.ends.map(point);
        let ratio = f64::from(segment.radius) / (p1 - p0).length();
        let axis = cylinder.p1() - cylinder.p0();
        let expected = cylinder.radius() / axis.length();
        assert!((ratio / expected - 1.0).abs() < 1e-4, "case {case}");

        let axis = axis.normalize();
        let outer = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
        let after = |first: DMat3| DAffine3 {
            matrix3: similar.matrix3 * first,
            ..similar
        };
        // Along the axis it stays a cylinder of the same radius.
        let stretched = segment_of(&cylinder, &after(DMat3::IDENTITY + outer)).unwrap();
        let change = f64::from(stretched.radius) / f64::from(segment.radius);
        assert!((change - 1.0).abs() < 1e-6, "case {case}: {change}");
        let aside = axis.any_orthonormal_vector();
        let across = DMat3::from_cols(aside * aside.x, aside * aside.y, aside * aside.z);
        let shear = DMat3::from_cols(aside * axis.x, aside * axis.y, aside * axis.z);
        for small in [across * 1e-6, shear * 1e-6] {
            let map = after(DMat3::IDENTITY + small);
            assert_eq!(segment_of(&cylinder, &map), None, "case {case}");
        }
    }
}

/// Solids of all caps, seen with true answers and with wrong ones.
#[test]
fn true_answers_agree_and_wrong_ones_are_suspects() {
    const SCENES: u64 = 40;
    const RAYS: u64 = 100;
    let device = Device::new(&DeviceOptions::default()).unwrap();
    let (mut hits, mut suspects, mut missed) = (0, 0, 0);
    for scene in 0..SCENES {
        let mut random = Random::new(SEED, 1_000 + scene);
        let solids: Vec<Cylinder> = (0..20).map(|_| random_cylinder(&mut random, 2.0)).collect();
        let maps: Vec<DAffine3> = (0..20).map(|_| similarity(&mut random)).collect();
        let exact: Vec<ExactAffine> = maps.iter().map(ExactAffine::new).collect();
        let segments: Vec<Option<Segment>> = solids
            .iter()
            .zip(&maps)
            .map(|(solid, map)| segment_of(solid, map))
            .collect();
        let curves = ConeCurves::new(&device, &segments).unwrap();
        assert_eq!(curves.witnessed_solids(), 20);
        for _ in 0..RAYS {
            let (ray32, ray) = ray(&mut random);
            let told = truth(&solids, &exact, &ray);
            suspects += u64::from(curves.compare(&ray32, told) != Verdict::Agrees);
            let Some(told) = told else { continue };
            hits += 1;
            let behind = CurveHit {
                t: told.t + 0.01 / ray.direction.length(),
                ..told
            };
            missed += u64::from(curves.compare(&ray32, Some(behind)) == Verdict::Agrees);
        }
    }
    assert!(
        hits > 2_000 && suspects <= SCENES * RAYS / 500,
        "{suspects}"
    );
    assert!(missed <= hits / 50, "{missed}");
}

#[test]
fn solid_without_curve_is_not_witnessed() {
    let device = Device::new(&DeviceOptions::default()).unwrap();
    let map = DAffine3::IDENTITY;
    let curved = Cylinder::new(DVec3::ZERO, DVec3::Z, 0.5, Caps::Both).unwrap();
    let curves = ConeCurves::new(&device, &[None, segment_of(&curved, &map)]).unwrap();
    let ray = Ray32 {
        origin: [-3.0, 0.0, 0.5],
        direction: [0.5, 0.0, 0.0],
        t_near: 0.0,
        t_far: f32::INFINITY,
    };
    let told = |t, solid| Some(CurveHit { t, solid });
    assert_eq!(curves.compare(&ray, told(5.0, Some(1))), Verdict::Agrees);
    assert_eq!(curves.compare(&ray, told(5.0, None)), Verdict::Agrees);
    assert_eq!(
        curves.compare(&ray, told(4.0, Some(0))),
        Verdict::Unwitnessed
    );
    assert_eq!(curves.compare(&ray, told(4.0, None)), Verdict::Unwitnessed);
    assert_eq!(curves.compare(&ray, told(4.0, Some(1))), Verdict::Suspect);
    assert_eq!(curves.compare(&ray, told(6.0, None)), Verdict::Suspect);
    assert_eq!(curves.compare(&ray, None), Verdict::Suspect);
}
