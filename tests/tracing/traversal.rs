//! Traversal loses nothing: through Embree, every ray gets the hit that trying
//! every placement and every cylinder gets, bit for bit.
//!
//! `CYLTRACE_RAYS=1000000 cargo test --release --test tracing traversal` is the full
//! run; the default is a tenth of it.

use std::sync::Arc;

use cyltrace::embree::MaxIsa;
use cyltrace::math::{Random, Ray};
use cyltrace::scene::{
    CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, Solids,
};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace::tracer::{Options, Tracer};
use glam::{DAffine3, DQuat, DVec3};
use rayon::prelude::*;
use test_support::aim::{self, farthest_point, ray_at};
use test_support::ray_count;

const SEED: u64 = 20_261_122;

/// Compares both kinds of query with the exhaustive one.
fn assert_nothing_lost(
    name: &str,
    tracer: &Tracer,
    rays: u64,
    ray_of: impl Fn(&mut Random) -> Ray + Sync,
) {
    let hits: u64 = (0..rays)
        .into_par_iter()
        .map(|number| {
            let ray = ray_of(&mut Random::new(SEED, 1000 + number));
            let found = tracer.closest(&ray);
            let truth = tracer.closest_exhaustive(&ray);
            let replay = || {
                format!(
                    "{name}, seed {SEED}, ray {number}: {}",
                    test_support::bits(&ray)
                )
            };
            assert_eq!(found, truth, "{}", replay());
            assert_eq!(tracer.occluded(&ray), truth.is_some(), "{}", replay());
            u64::from(truth.is_some())
        })
        .sum();
    let share = hits as f64 / rays as f64;
    println!("{name}: {rays} rays, {hits} hits, none lost");
    assert!(
        share > 0.3,
        "{name}: only {hits} hits, the test sees nothing"
    );
}

/// The scene built for every instruction set of this machine, and how many rays
/// it gets: all for the best, a fifth for the others.
fn tracers(scene: &Arc<Scene>) -> Vec<(String, u64, Tracer)> {
    let build = |max_isa: Option<MaxIsa>| {
        let options = Options {
            max_isa,
            ..Default::default()
        };
        let tracer = Tracer::new(Arc::clone(scene), &options).unwrap();
        let isa = tracer.statistics().isa.clone();
        let rays = ray_count() / if max_isa == MaxIsa::best() { 1 } else { 5 };
        (isa, rays, tracer)
    };
    test_support::instruction_sets()
        .into_iter()
        .map(build)
        .collect()
}

#[test]
fn box_of_cylinders_loses_no_hit() {
    let cylinders = test_support::cylinders_in_a_box(SEED, 1000);
    let root = Prototype {
        solids: Solids::of_cylinders(cylinders.clone()),
        ..Default::default()
    };
    for (isa, rays, tracer) in tracers(&test_support::scene_of(vec![root])) {
        for (name, reach) in [("near", 1e2), ("far", 1e8)] {
            assert_nothing_lost(&format!("{isa}, {name}"), &tracer, rays, |random| {
                ray_at(random, &cylinders, reach)
            });
        }
    }
}

/// Three levels of placements with translations up to 1e7 extents and scales
/// from 1e-4 to 1e4, some of them different for each axis.
#[test]
fn nested_placements_lose_no_hit() {
    for nested in test_support::nested_placements(SEED) {
        let cylinders = nested.cylinders();
        for (isa, rays, tracer) in tracers(&nested.scene) {
            let translation = nested.translation;
            let name = format!("{isa}, nested, translated by {translation:e}");
            assert_nothing_lost(&name, &tracer, rays, |random| {
                let image = nested.any_image(random);
                aim::carried(&image, &ray_at(random, &cylinders, 1e6))
            });
        }
    }
}

/// A ray that passes just inside what touches a face, or is farthest towards an
/// edge or a corner, of the box around all cylinders, and along that face or
/// across the edge or corner. It meets nothing of the box but its outermost
/// layer, so that a box or a sphere that is too small loses it.
fn ray_along_the_box(random: &mut Random, cylinders: &[Cylinder]) -> Ray {
    let outward = loop {
        let sides: [f64; 3] = std::array::from_fn(|_| random.below(3) as f64 - 1.0);
        if sides != [0.0; 3] {
            break DVec3::from_array(sides).normalize();
        }
    };
    let farthest = cylinders
        .iter()
        .map(|one| (farthest_point(one, outward), one))
        .max_by(|(one, _), (other, _)| one.dot(outward).total_cmp(&other.dot(outward)));
    let (point, cylinder) = farthest.expect("there are cylinders");
    let middle = (cylinder.p0() + cylinder.p1()) / 2.0;
    let target = point.lerp(middle, random.log_uniform(1e-12, 1e-3));
    let level = random.direction();
    let heading = (level - outward * level.dot(outward)).normalize();
    let origin = target - heading * random.log_uniform(1e-3, 1e2);
    let scale = random.log_uniform(1e-30, 1e30);
    let t_min = [0.0, f64::NEG_INFINITY][random.below(2) as usize];
    Ray {
        t_min,
        ..Ray::new(origin, heading * scale)
    }
}

#[test]
fn box_of_cylinders_loses_no_hit_in_its_outermost_layer() {
    let records = test_support::cylinders_in_a_box(SEED, 1000);
    let cylinders: Vec<Cylinder> = records.iter().map(CylinderRecord::cylinder).collect();
    let root = Prototype {
        solids: Solids::of_cylinders(records),
        ..Default::default()
    };
    for (isa, rays, tracer) in tracers(&test_support::scene_of(vec![root])) {
        let name = format!("{isa}, along the box");
        assert_nothing_lost(&name, &tracer, rays / 5, |random| {
            ray_along_the_box(random, &cylinders)
        });
    }
}

/// A box with a small cylinder in each corner, and a box with such a box in
/// each corner: so their bounding spheres have something at their surface too.
#[test]
fn boxes_in_corners_of_boxes_lose_no_hit_in_their_outermost_layer() {
    const SIDE: f64 = 4.0;
    const SCALE: f64 = 0.25;
    let corners = (0..8).map(|corner| {
        let at = |bit: u32| f64::from(corner >> bit & 1);
        DVec3::new(at(0), at(1), at(2))
    });
    let (radius, length) = (1e-3, 4e-3);
    let in_corner = |corner: DVec3| {
        let inward = DVec3::ONE - corner * 2.0;
        let p0 = corner + inward * DVec3::new(0.0, radius, radius);
        Cylinder::new(p0, p0 + inward * DVec3::X * length, radius, Caps::Both).unwrap()
    };
    let small: Vec<Cylinder> = corners.clone().map(in_corner).collect();
    let record = |(i, one)| CylinderRecord::new(one, i, MaterialIndex(0));
    let leaf = Prototype {
        solids: Solids::of_cylinders((0..).zip(&small).map(record)),
        ..Default::default()
    };
    let offsets: Vec<DVec3> = corners.map(|corner| corner * (SIDE - SCALE)).collect();
    let place = |offset: &DVec3| Placement {
        of: PrototypeIndex(1),
        parent_from_child: DAffine3::from_scale_rotation_translation(
            DVec3::splat(SCALE),
            DQuat::IDENTITY,
            *offset,
        ),
    };
    let root = Prototype {
        placements: offsets.iter().map(place).collect(),
        ..Default::default()
    };
    let placed = |offset: DVec3, one: &Cylinder| {
        let [p0, p1] = [one.p0(), one.p1()].map(|end| end * SCALE + offset);
        Cylinder::new(p0, p1, one.radius() * SCALE, one.caps()).unwrap()
    };
    let all: Vec<Cylinder> = offsets
        .iter()
        .flat_map(|&offset| small.iter().map(move |one| placed(offset, one)))
        .collect();
    let scenes = [
        ("a box", vec![leaf.clone()], small),
        ("placed", vec![root, leaf], all),
    ];
    for (kind, prototypes, cylinders) in scenes {
        for (isa, rays, tracer) in tracers(&test_support::scene_of(prototypes)) {
            let name = format!("{isa}, {kind}, along the box");
            assert_nothing_lost(&name, &tracer, rays / 5, |random| {
                ray_along_the_box(random, &cylinders)
            });
        }
    }
}
