//! Rays with components from the whole range of f64: the traversal finds what trying
//! every solid finds, a hit is within its range and finite, and a ray of a size that
//! is not supported is a miss.

use cyltrace::math::{DIRECTION_SIZES, GREATEST_ORIGIN, Random, Ray, RaySizeError, power_of_two};
use cyltrace::scene::{
    CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Solids,
};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace::tracer::{Options, Tracer};
use glam::{DAffine3, DVec3};

/// Rays a scene.
const RAYS: u64 = 60_000;

/// Cylinders of very different sizes around the origin, times `scale`.
fn cylinders(scale: f64) -> Prototype {
    let cylinder = |p0: DVec3, p1: DVec3, radius: f64| {
        Cylinder::new(p0 * scale, p1 * scale, radius * scale, Caps::Both).expect("in range")
    };
    let solids = [
        cylinder(-DVec3::Z, DVec3::Z, 1.0),
        cylinder(-DVec3::ONE, DVec3::new(2.0, 3.0, 0.5), 0.25),
        cylinder(DVec3::X * 4.0, DVec3::new(4.0, 0.0, 1e-3), 1e-6),
        cylinder(DVec3::Y * -3.0, DVec3::new(5.0, -3.0, 1.0), 2.0),
    ];
    let records = (0..).zip(&solids);
    Prototype {
        solids: Solids::of_cylinders(
            records.map(|(number, solid)| CylinderRecord::new(solid, number, MaterialIndex(0))),
        ),
        ..Default::default()
    }
}

/// A number of any size, zero now and then.
fn any_size(random: &mut Random) -> f64 {
    let exponent = (random.unit() * 2098.0) as i32 - 1074;
    let size = libm::ldexp(1.0 + random.unit(), exponent);
    match (random.unit() * 8.0) as u32 {
        0 => 0.0,
        1 => 5e-324,
        2..5 => -size,
        _ => size,
    }
}

/// A number between -1 and 1.
fn ordinary(random: &mut Random) -> f64 {
    random.unit() * 2.0 - 1.0
}

fn vector(mut component: impl FnMut() -> f64) -> DVec3 {
    DVec3::new(component(), component(), component())
}

/// A ray of extreme numbers: each vector ordinary, of any size as a whole, or of any
/// size in each component; one in two aimed at the solids.
fn extreme_ray(random: &mut Random, scale: f64) -> Ray {
    let extreme_vector = |random: &mut Random| match (random.unit() * 4.0) as u32 {
        0 => vector(|| any_size(random)),
        1 => any_size(random) * vector(|| ordinary(random)),
        2 => {
            let mut mixed = vector(|| ordinary(random));
            mixed[(random.unit() * 3.0) as usize] = any_size(random);
            mixed
        }
        _ => vector(|| ordinary(random)) * scale,
    };
    let mut ray = Ray::new(extreme_vector(random), extreme_vector(random));
    if random.unit() < 0.6 {
        let aim = vector(|| ordinary(random)) * scale * 2.0;
        let length = if random.unit() < 0.5 {
            1.0
        } else {
            any_size(random)
        };
        let distance = if random.unit() < 0.5 {
            3.0 * scale
        } else {
            any_size(random)
        };
        let towards = ray.direction.normalize_or(DVec3::X);
        ray.origin = aim - towards * distance;
        ray.direction = towards * length;
    }
    if random.unit() < 0.3 {
        ray.t_min = any_size(random);
    }
    if random.unit() < 0.3 {
        ray.t_max = any_size(random);
    }
    ray
}

fn scenes() -> Vec<(&'static str, f64, Tracer)> {
    let placed = |of: u32, placement: DAffine3| Prototype {
        placements: vec![Placement {
            of: PrototypeIndex(of),
            parent_from_child: placement,
        }],
        ..Default::default()
    };
    let shrunk = DAffine3::from_scale(DVec3::splat(power_of_two(-60)));
    let turned = DAffine3::from_scale_rotation_translation(
        DVec3::new(2.0, 1.0, 0.5),
        glam::DQuat::from_xyzw(0.5, 0.5, 0.5, 0.5),
        DVec3::new(0.5, 0.25, -0.125),
    );
    let scenes = [
        ("ordinary", 1.0, vec![cylinders(1.0)]),
        (
            "tiny",
            power_of_two(-100),
            vec![cylinders(power_of_two(-100))],
        ),
        (
            "huge",
            power_of_two(140),
            vec![cylinders(power_of_two(140))],
        ),
        ("placed", 1.0, vec![placed(1, turned), cylinders(1.0)]),
        (
            "shrunk and placed",
            power_of_two(-60),
            vec![placed(1, shrunk), placed(2, turned), cylinders(1.0)],
        ),
    ];
    let traced = scenes.into_iter().map(|(name, scale, prototypes)| {
        let scene = test_support::scene_of(prototypes);
        let tracer = Tracer::new(scene, &Options::default()).expect("it builds");
        (name, scale, tracer)
    });
    traced.collect()
}

#[test]
fn extreme_rays_hit_what_trying_every_solid_hits() {
    for (name, scale, tracer) in scenes() {
        let (mut hits, mut unsupported) = (0, 0);
        for number in 0..RAYS {
            let ray = extreme_ray(&mut Random::new(12, number), scale);
            let truth = tracer.closest_exhaustive(&ray);
            let context = format!("{name}, ray {number}: {ray:?}");
            assert_eq!(tracer.closest(&ray), truth, "{context}");
            assert_eq!(tracer.occluded(&ray), truth.is_some(), "{context}");
            let mut packet = Vec::new();
            tracer.closest_batch(&[ray; 16], &mut packet);
            assert!(packet.iter().all(|hit| *hit == truth), "{context}");
            let all: Vec<_> = tracer.all_hits(&ray, 8).collect();
            assert_eq!(all.first(), truth.as_ref(), "{context}");
            for hit in &all {
                let in_range = ray.t_min <= hit.t && hit.t <= ray.t_max;
                assert!(in_range && hit.t.is_finite(), "{context}: {hit:?}");
            }
            if !ray.has_supported_sizes() {
                assert!(all.is_empty(), "{context}");
                unsupported += 1;
            }
            hits += usize::from(truth.is_some());
        }
        assert!(hits > 5000 && unsupported > 5000, "{name}: {hits} hits");
    }
}

#[test]
fn a_line_almost_in_the_plane_of_a_disk_ends_at_the_wall() {
    // The ray meets the disk's plane 1e-123 behind the origin or before it, far outside of the
    // wall; the wall is left behind the origin. By hand: no point of the cylinder has
    // an x below 4 - 1e-6, and the ray only goes to negative x.
    let scale = power_of_two(140);
    let axis = DVec3::X * 4.0 * scale;
    let solid = Cylinder::new(
        axis,
        axis + DVec3::Z * 1e-3 * scale,
        1e-6 * scale,
        Caps::Both,
    );
    let record = CylinderRecord::new(&solid.expect("in range"), 0, MaterialIndex(0));
    let root = Prototype {
        solids: Solids::of_cylinders(vec![record]),
        ..Default::default()
    };
    let tracer = Tracer::new(test_support::scene_of(vec![root]), &Options::default());
    let tracer = tracer.expect("it builds");
    let ray = Ray::new(
        DVec3::new(-0.07, -0.9, 9e-124),
        DVec3::new(-3e26, 0.15, -0.94),
    );
    assert_eq!(tracer.closest_exhaustive(&ray), None);
    assert_eq!(tracer.closest(&ray), None);
}

#[test]
fn the_limits_of_sizes_are_where_they_are_stated() {
    let ray = Ray::new(DVec3::X, DVec3::Y);
    let with = |origin: f64, direction: f64| Ray {
        origin: DVec3::new(0.0, origin, 5e-324),
        direction: DVec3::new(direction, 5e-324, 0.0),
        ..ray
    };
    let (least, greatest) = (*DIRECTION_SIZES.start(), *DIRECTION_SIZES.end());
    for origin in [GREATEST_ORIGIN, -GREATEST_ORIGIN, 0.0] {
        for direction in [least, greatest, -least, -greatest] {
            assert_eq!(with(origin, direction).check_sizes(), Ok(()));
            assert!(with(origin, direction).is_valid());
        }
    }
    for component in [GREATEST_ORIGIN.next_up(), f64::INFINITY, f64::MIN] {
        let error = with(component, 1.0).check_sizes();
        assert_eq!(error, Err(RaySizeError::Origin { component }));
    }
    for component in [least.next_down(), greatest.next_up(), f64::NEG_INFINITY] {
        let error = with(1.0, component).check_sizes();
        assert_eq!(error, Err(RaySizeError::Direction { component }));
    }
    assert!(with(f64::NAN, 1.0).check_sizes().is_err());
    assert!(with(1.0, f64::NAN).check_sizes().is_err());
    assert!(!with(f64::NAN, 1.0).is_valid() && !with(1.0, f64::NAN).is_valid());
}
