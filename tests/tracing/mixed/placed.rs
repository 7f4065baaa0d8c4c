//! Through placements: as the placed solid itself, and as the exhaustive search.

use cyltrace::math::{Orientation, Random};
use cyltrace::solid::{AnySolid, Caps, Cone, Cuboid, Cylinder, Disk, RoundedCone, Sphere};
use cyltrace::tracer::Hit;
use cyltrace_oracle::hits_of_any;
use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

use super::{SEED, all_hits, tracer_of};
use test_support::solids::{KINDS, any_solid, crowd, prototype_of, ray_through};
use test_support::{self, bits, nested_placements, placed, placing};

/// The axes changed round, a power of two and a translation on the grid: what it
/// makes of a solid on the grid is one, without a rounding.
fn exact_placement(random: &mut Random, round: u64) -> DAffine3 {
    let permuted = match round % 3 {
        0 => DMat3::IDENTITY,
        1 => DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X),
        _ => DMat3::from_cols(DVec3::Z, DVec3::X, DVec3::Y),
    };
    let scale = [0.5, 1.0, 2.0][random.below(3) as usize];
    let mut step = || random.below(9) as f64 / 4.0 - 1.0;
    let translation = DVec3::new(step(), step(), step());
    DAffine3::from_mat3_translation(permuted * scale, translation)
}

/// A solid, not turned, where an exact placement puts it.
fn moved(solid: &AnySolid, image: &DAffine3) -> AnySolid {
    let point = |point| image.transform_point3(point);
    let scale = image.matrix3.x_axis.length();
    match solid {
        AnySolid::Cylinder(one) => {
            let (p0, p1) = (point(one.p0()), point(one.p1()));
            Cylinder::new(p0, p1, one.radius() * scale, one.caps())
                .unwrap()
                .into()
        }
        AnySolid::Cone(one) => {
            let (p0, p1) = (point(one.p0()), point(one.p1()));
            let (r0, r1) = (one.radius0() * scale, one.radius1() * scale);
            Cone::new(p0, p1, r0, r1, one.caps()).unwrap().into()
        }
        AnySolid::RoundedCone(one) => {
            let (p0, p1) = (point(one.p0()), point(one.p1()));
            let (r0, r1) = (one.radius0() * scale, one.radius1() * scale);
            RoundedCone::new(p0, p1, r0, r1).unwrap().into()
        }
        AnySolid::Sphere(one) => {
            let center = point(one.center());
            Sphere::new(center, one.radius() * scale).unwrap().into()
        }
        AnySolid::Cuboid(one) => {
            let half_widths = image.transform_vector3(one.half_widths()).abs();
            Cuboid::new(point(one.center()), half_widths, Orientation::IDENTITY)
                .unwrap()
                .into()
        }
        AnySolid::Disk(one) => {
            let normal = image.transform_vector3(one.normal());
            Disk::new(point(one.center()), normal, one.radius() * scale)
                .unwrap()
                .into()
        }
    }
}

#[test]
fn placed_three_deep_a_solid_is_hit_where_its_image_is() {
    let mut random = Random::new(SEED, 3);
    let solids: Vec<AnySolid> = (0..48)
        .map(|number| any_solid(&mut random, number % KINDS, Caps::Both, false))
        .collect();
    let mut places = |of: u32| -> Vec<DAffine3> {
        let count = u64::from(of);
        (0..count)
            .map(|round| exact_placement(&mut random, round + count))
            .collect()
    };
    let levels = [places(1), places(2), places(3)];
    let mut prototypes: Vec<_> = (1..)
        .zip(&levels)
        .map(|(of, images)| placing(images.iter().map(|image| placed(of, *image)).collect()))
        .collect();
    prototypes.push(prototype_of(&solids));
    let tracer = tracer_of(prototypes);

    let hits: usize = (0..test_support::ray_count() / 100)
        .into_par_iter()
        .map(|number| {
            let mut random = Random::new(SEED, 300_000 + number);
            let images = levels.each_ref().map(|images| {
                let any = random.below(images.len() as u64) as usize;
                images[any]
            });
            let image = images[0] * images[1] * images[2];
            let ray = test_support::aim::carried(&image, &ray_through(&mut random));
            let found = all_hits(&tracer, &ray);
            let mut expected = 0;
            for (i, outer) in levels[0].iter().enumerate() {
                for (j, middle) in levels[1].iter().enumerate() {
                    for (k, inner) in levels[2].iter().enumerate() {
                        let path = [i, j, k].map(|place| place as u32);
                        let image = *outer * *middle * *inner;
                        for (primitive, solid) in (0..).zip(&solids) {
                            let truth = hits_of_any(&moved(solid, &image), &ray);
                            let is_same =
                                |hit: &&Hit| hit.primitive == primitive && hit.instance == path;
                            let of_solid: Vec<_> = found.iter().filter(is_same).collect();
                            let case =
                                || format!("seed {SEED}, {solid:?}, {path:?}, {}", bits(&ray));
                            assert_eq!(of_solid.len(), truth.len(), "{}", case());
                            for (hit, truth) in of_solid.iter().zip(&truth) {
                                assert_eq!(hit.crossing, truth.crossing, "{}", case());
                                let t = truth.t_f64();
                                assert!((hit.t - t).abs() <= 1e-9 * t.abs(), "{}", case());
                                let on_ray = ray.origin + ray.direction * t;
                                let along = 1e-9 * (ray.direction * t).length();
                                assert!(hit.point.distance(on_ray) <= along, "{}", case());
                            }
                            expected += truth.len();
                        }
                    }
                }
            }
            assert_eq!(found.len(), expected, "seed {SEED}, {}", bits(&ray));
            expected
        })
        .sum();
    assert!(hits > 500, "{hits}");
}

#[test]
fn nested_placements_lose_nothing_of_any_kind() {
    for nested in nested_placements(SEED) {
        let mut prototypes = nested.scene.prototypes.clone();
        prototypes[3] = prototype_of(&crowd(SEED + 3, 60));
        let tracer = tracer_of(prototypes);
        let hits: usize = (0..test_support::ray_count() / 100)
            .into_par_iter()
            .map(|number| {
                let mut random = Random::new(SEED, 400_000 + number);
                let image = nested.any_image(&mut random);
                let ray = test_support::aim::carried(&image, &ray_through(&mut random));
                let expected = tracer.closest_exhaustive(&ray);
                assert_eq!(tracer.closest(&ray), expected, "{}", bits(&ray));
                assert_eq!(all_hits(&tracer, &ray).first(), expected.as_ref());
                usize::from(expected.is_some())
            })
            .sum();
        assert!(hits > 300, "{hits} at {}", nested.translation);
    }
}
