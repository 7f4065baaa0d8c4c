//! Rays and scenes at the ends of the number line: the right answer or a miss,
//! and nothing that makes Embree abort.

use cyltrace::math::Ray;
use cyltrace::scene::{
    CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Solids,
};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace::tracer::{Options, Tracer, TracerError};
use glam::{DAffine3, DVec3};

fn tracer_of(cylinders: &[Cylinder]) -> Tracer {
    let records = cylinders
        .iter()
        .enumerate()
        .map(|(i, cylinder)| CylinderRecord::new(cylinder, i as u32, MaterialIndex(0)));
    let root = Prototype {
        solids: Solids::of_cylinders(records),
        ..Default::default()
    };
    Tracer::new(test_support::scene_of(vec![root]), &Options::default()).unwrap()
}

/// The unit cylinder around the z axis, times `scale`.
fn unit_cylinder(scale: f64) -> Cylinder {
    Cylinder::new(DVec3::Z * -scale, DVec3::Z * scale, scale, Caps::Both).unwrap()
}

#[test]
fn rays_that_are_not_rays_miss() {
    let tracer = tracer_of(&[unit_cylinder(1.0)]);
    let good = Ray::new(DVec3::X * -3.0, DVec3::X);
    assert!(tracer.closest(&good).is_some());
    let bad_numbers = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let mut bad = vec![
        Ray {
            direction: DVec3::ZERO,
            ..good
        },
        Ray {
            t_min: 1.0,
            t_max: 0.0,
            ..good
        },
    ];
    for number in bad_numbers {
        for axis in 0..3 {
            let with = |mut vector: DVec3| {
                vector[axis] = number;
                vector
            };
            bad.push(Ray {
                origin: with(good.origin),
                ..good
            });
            bad.push(Ray {
                direction: with(good.direction),
                ..good
            });
        }
    }
    bad.push(Ray {
        t_min: f64::NAN,
        ..good
    });
    bad.push(Ray {
        t_max: f64::NAN,
        ..good
    });
    bad.push(Ray {
        t_min: f64::INFINITY,
        ..good
    });
    bad.push(Ray {
        t_max: f64::NEG_INFINITY,
        ..good
    });
    for ray in bad {
        assert_eq!(tracer.closest(&ray), None, "{ray:?}");
        assert!(!tracer.occluded(&ray), "{ray:?}");
    }
}

#[test]
fn infinite_ranges_are_ranges() {
    let tracer = tracer_of(&[unit_cylinder(1.0)]);
    let ray = Ray {
        t_min: f64::NEG_INFINITY,
        ..Ray::new(DVec3::X * 3.0, DVec3::X)
    };
    assert_eq!(tracer.closest(&ray).map(|hit| hit.t), Some(-4.0));
    let ray = Ray { t_max: -3.0, ..ray };
    assert_eq!(tracer.closest(&ray).map(|hit| hit.t), Some(-4.0));
    let ray = Ray {
        t_min: -3.5,
        t_max: -2.0,
        ..ray
    };
    assert_eq!(
        tracer.closest(&ray).map(|hit| hit.t),
        Some(-2.0),
        "a range is closed"
    );
}

#[test]
fn directions_of_every_supported_size_give_the_same_point() {
    let tracer = tracer_of(&[unit_cylinder(1.0)]);
    let supported = (-500..=500).step_by(20).chain([-33, -32, 31, 32, 33]);
    for exponent in supported {
        let size = libm::ldexp(1.0, exponent);
        let ray = Ray::new(DVec3::new(-3.0, 0.25, 0.5), DVec3::X * size);
        let hit = tracer
            .closest(&ray)
            .unwrap_or_else(|| panic!("2^{exponent} is missed"));
        let expected = tracer
            .closest(&Ray {
                direction: DVec3::X,
                ..ray
            })
            .unwrap();
        assert_eq!(hit.point, expected.point, "2^{exponent}");
        assert_eq!(hit.t, expected.t / size, "2^{exponent}");
        assert!(tracer.occluded(&ray), "2^{exponent}");
    }
    for exponent in [-1074, -1023, -501, 501, 1023] {
        let direction = DVec3::X * libm::ldexp(1.0, exponent);
        let ray = Ray::new(DVec3::new(-3.0, 0.25, 0.5), direction);
        assert_eq!(tracer.closest(&ray), None, "2^{exponent}");
        assert!(!tracer.occluded(&ray), "2^{exponent}");
    }
}

#[test]
fn origins_of_every_distance_hit_or_miss() {
    let tracer = tracer_of(&[unit_cylinder(1.0)]);
    for exponent in (0..=300).step_by(3) {
        let distance = libm::ldexp(1.0, exponent);
        // Straight at the wall: right at any distance that f64 can advance.
        let ray = Ray::new(DVec3::new(-distance, 0.5, 0.0), DVec3::X);
        let hit = tracer.closest(&ray);
        if exponent <= 100 {
            let hit = hit.unwrap_or_else(|| panic!("missed from 2^{exponent}"));
            assert_eq!(
                hit.t,
                cyltrace_oracle::first_hit(&unit_cylinder(1.0), &ray)
                    .hit
                    .unwrap()
                    .t_f64()
            );
        }
        // Past it.
        let ray = Ray::new(DVec3::new(-distance, 1.001, 0.0), DVec3::X);
        assert_eq!(tracer.closest(&ray), None, "2^{exponent}");
    }
    let beyond = Ray::new(DVec3::splat(f64::MAX), DVec3::splat(-f64::MAX));
    assert!(tracer.closest(&beyond).is_none_or(|hit| hit.t.is_finite()));
}

#[test]
fn scenes_of_every_size_give_scaled_answers() {
    let unit = tracer_of(&[unit_cylinder(1.0)]);
    let ray = Ray::new(DVec3::new(-3.0, 0.3, 0.1), DVec3::new(1.0, 0.05, 0.2));
    let expected = unit.closest(&ray).unwrap();
    for exponent in [-149, -100, -63, -30, 30, 63, 100, 149] {
        let scale = libm::ldexp(1.0, exponent);
        let tracer = tracer_of(&[unit_cylinder(scale)]);
        let hit = tracer.closest(&Ray {
            origin: ray.origin * scale,
            ..ray
        });
        let hit = hit.unwrap_or_else(|| panic!("missed at 2^{exponent}"));
        assert_eq!(hit.t, expected.t * scale, "2^{exponent}");
        assert_eq!(hit.point, expected.point * scale, "2^{exponent}");
        assert_eq!(hit.error, expected.error * scale, "2^{exponent}");
    }
    for scale in [1e19, 1e-19] {
        let cylinder = unit_cylinder(scale);
        let tracer = tracer_of(&[cylinder]);
        let ray = Ray {
            origin: ray.origin * scale,
            ..ray
        };
        let truth = cyltrace_oracle::first_hit(&cylinder, &ray).hit.unwrap();
        let hit = tracer.closest(&ray).unwrap();
        assert_eq!(hit.part, truth.part);
        assert!((hit.t / truth.t_f64() - 1.0).abs() < 1e-15, "{scale:e}");
    }
}

#[test]
fn very_different_sizes_live_in_one_scene() {
    let small = Cylinder::new(DVec3::ZERO, DVec3::Z * 1e-6, 1e-9, Caps::Both).unwrap();
    let large = Cylinder::new(DVec3::X * 1e6, DVec3::X * 3e6, 1e5, Caps::Both).unwrap();
    let tracer = tracer_of(&[small, large]);
    let at_small = Ray::new(DVec3::new(-1.0, 0.0, 5e-7), DVec3::X);
    let hit = tracer.closest(&at_small).unwrap();
    assert_eq!((hit.primitive, hit.t), (0, 1.0 - 1e-9));
    let past_small = Ray::new(DVec3::new(-1.0, 1.1e-9, 5e-7), DVec3::X);
    assert_eq!(tracer.closest(&past_small).unwrap().primitive, 1);
}

#[test]
fn empty_scene_misses() {
    let tracer = tracer_of(&[]);
    let ray = Ray::new(DVec3::ZERO, DVec3::X);
    assert_eq!(tracer.closest(&ray), None);
    assert!(!tracer.occluded(&ray));
    assert!(tracer.bounds().is_empty());
}

#[test]
fn placements_that_flatten_or_pile_up_scales_are_refused() {
    let leaf = Prototype {
        solids: Solids::of_cylinders(vec![CylinderRecord::new(
            &unit_cylinder(1.0),
            0,
            MaterialIndex(0),
        )]),
        ..Default::default()
    };
    let placed = |of: u32, scale: DVec3| Prototype {
        name: format!("level {of}"),
        placements: vec![Placement {
            of: PrototypeIndex(of),
            parent_from_child: DAffine3::from_scale(scale),
        }],
        ..Default::default()
    };
    let build = |prototypes| Tracer::new(test_support::scene_of(prototypes), &Options::default());
    let flat = build(vec![placed(1, DVec3::new(1.0, 1.0, 1e-12)), leaf.clone()]);
    assert!(matches!(flat, Err(TracerError::Condition { .. })));
    let thrice = (1..=3)
        .map(|of| placed(of, DVec3::splat(1e-9)))
        .chain([leaf.clone()]);
    assert!(matches!(
        build(thrice.collect()),
        Err(TracerError::Stretch { .. })
    ));
    let deep = (1..=65)
        .map(|of| placed(of, DVec3::ONE))
        .chain([leaf.clone()]);
    assert!(matches!(
        build(deep.collect()),
        Err(TracerError::Depth { depth: 65 })
    ));
}

#[test]
fn deepest_nesting_is_traced() {
    let leaf = Prototype {
        solids: Solids::of_cylinders(vec![CylinderRecord::new(
            &unit_cylinder(1.0),
            0,
            MaterialIndex(0),
        )]),
        ..Default::default()
    };
    let levels = (1..=64).map(|of| Prototype {
        placements: vec![Placement {
            of: PrototypeIndex(of),
            parent_from_child: DAffine3::from_translation(DVec3::X),
        }],
        ..Default::default()
    });
    let scene = test_support::scene_of(levels.chain([leaf]).collect());
    let tracer = Tracer::new(scene, &Options::default()).unwrap();
    let hit = tracer.closest(&Ray::new(DVec3::ZERO, DVec3::X)).unwrap();
    assert_eq!((hit.t, hit.instance), (63.0, vec![0; 64]));
}
