//! Rays spawned from hits do not meet again the surface they left.
//!
//! `CYLTRACE_RAYS=1000000 cargo test --release --test tracing spawn` is the full run;
//! the default is a tenth of it.
//!
//! The judge is exact arithmetic on the spawned ray as it is, an f64 ray like
//! any other: outward, it must be outside of the solid it left and never meet
//! it; inward, its first intersection with that solid must be the far side.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use cyltrace::math::{Random, Ray};
use cyltrace::scene::{
    CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, Solids,
};
use cyltrace::solid::{Caps, Crossing, Cylinder, Part};
use cyltrace::tracer::{Hit, Options, Tracer};
use cyltrace_oracle::{ExactAffine, placed_first_hit};
use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

const SEED: u64 = 99;

fn ray_count() -> u64 {
    std::env::var("CYLTRACE_RAYS").map_or(100_000, |count| count.parse().expect("a number"))
}

/// The cylinder that was hit and how it is placed in the world.
fn hit_solid(scene: &Scene, hit: &Hit) -> (Cylinder, ExactAffine) {
    let mut prototype = &scene.prototypes[0];
    let mut world_from_object = ExactAffine::identity();
    for &index in &hit.instance {
        let placement = &prototype.placements[index as usize];
        world_from_object =
            world_from_object.after(&ExactAffine::new(&placement.parent_from_child));
        prototype = &scene.prototypes[placement.of.0 as usize];
    }
    (
        prototype
            .solids
            .cylinders
            .get(hit.primitive as usize)
            .cylinder(),
        world_from_object,
    )
}

/// A direction to the side of `normal`, often almost within the surface.
fn direction_from(random: &mut Random, normal: DVec3) -> DVec3 {
    let direction = random.direction();
    let height = match random.below(3) {
        0 => random.log_uniform(1e-17, 1.0),
        _ => random.unit(),
    };
    let flat = direction - normal * direction.dot(normal);
    (flat + normal * height) * random.log_uniform(1e-3, 1e3)
}

#[derive(Default)]
struct Tally {
    outward: AtomicU64,
    inward: AtomicU64,
}

/// Spawns a ray from a hit, to the side that the hit was seen from, and judges
/// what it meets.
fn judge_spawned(tracer: &Tracer, random: &mut Random, ray: &Ray, hit: &Hit, tally: &Tally) {
    let from_outside = ray.direction.dot(hit.normal) < 0.0;
    let side = if from_outside { 1.0 } else { -1.0 };
    let direction = direction_from(random, hit.normal * side);
    if direction.dot(hit.normal) * side <= 0.0 {
        return;
    }
    let spawned = hit.spawn(direction);
    let next = tracer.closest(&spawned);
    let again = next
        .as_ref()
        .filter(|next| (&next.instance, next.primitive) == (&hit.instance, hit.primitive));
    let case = || {
        format!(
            "seed {SEED}: {hit:?} spawned {} and met {next:?}",
            test_support::bits(&spawned)
        )
    };
    let (cylinder, world_from_object) = hit_solid(tracer.scene(), hit);
    let truth = placed_first_hit(&cylinder, &world_from_object, &spawned).hit;
    if from_outside {
        tally.outward.fetch_add(1, Ordering::Relaxed);
        assert!(
            truth.is_none(),
            "starts within or below the surface: {}",
            case()
        );
        assert!(again.is_none(), "meets the surface it left: {}", case());
    } else {
        tally.inward.fetch_add(1, Ordering::Relaxed);
        if let Some(again) = again {
            assert_eq!(
                again.crossing,
                Crossing::Leave,
                "meets where it left: {}",
                case()
            );
            let expected = truth.as_ref().map(|truth| (truth.part, truth.crossing));
            assert_eq!(expected, Some((again.part, again.crossing)), "{}", case());
        }
    }
}

fn spawn_over(name: &str, tracer: &Tracer, ray_of: impl Fn(&mut Random) -> Ray + Sync) {
    let tally = Tally::default();
    (0..ray_count()).into_par_iter().for_each(|number| {
        let mut random = Random::new(SEED, 1000 + number);
        let ray = ray_of(&mut random);
        if let Some(hit) = tracer.closest(&ray) {
            for _ in 0..3 {
                judge_spawned(tracer, &mut random, &ray, &hit, &tally);
            }
        }
    });
    let (outward, inward) = (tally.outward.into_inner(), tally.inward.into_inner());
    println!("{name}: {outward} outward and {inward} inward, none met where it left");
    assert!(
        outward > ray_count() / 4 && inward > ray_count() / 50,
        "the cases are lopsided"
    );
}

/// A ray from around or within the unit cube to a point in it.
fn ray_in_the_cube(random: &mut Random) -> Ray {
    let mut inside = || DVec3::new(random.unit(), random.unit(), random.unit());
    let (from, to) = (inside(), inside());
    let out = if random.below(2) == 0 {
        0.0
    } else {
        random.log_uniform(1.0, 100.0)
    };
    Ray::new(from + random.direction() * out, to - from).retarget(to)
}

/// Aims a ray at a point.
trait Retarget {
    fn retarget(self, to: DVec3) -> Self;
}

impl Retarget for Ray {
    fn retarget(self, to: DVec3) -> Self {
        Ray {
            direction: to - self.origin,
            ..self
        }
    }
}

#[test]
fn box_of_cylinders_has_no_self_hit() {
    let cylinders = test_support::cylinders_in_a_box(SEED, 1000);
    let root = Prototype {
        solids: Solids::of_cylinders(cylinders),
        ..Default::default()
    };
    let tracer = Tracer::new(test_support::scene_of(vec![root]), &Options::default()).unwrap();
    spawn_over("box", &tracer, ray_in_the_cube);
}

#[test]
fn offset_box_has_no_self_hit() {
    let offset = DVec3::new(1e6, -3e5, 2e6);
    let moved = test_support::cylinders_in_a_box(SEED, 1000)
        .into_iter()
        .map(|record| {
            let one = record.cylinder();
            // Thinner ones would be thinner than the rounding of their ends.
            let radius = one.radius().max(1e-4);
            let cylinder = Cylinder::new(one.p0() + offset, one.p1() + offset, radius, one.caps());
            CylinderRecord::new(&cylinder.unwrap(), record.primitive(), MaterialIndex(0))
        });
    let root = Prototype {
        solids: Solids::of_cylinders(moved),
        ..Default::default()
    };
    let tracer = Tracer::new(test_support::scene_of(vec![root]), &Options::default()).unwrap();
    spawn_over("offset box", &tracer, |random| {
        let ray = ray_in_the_cube(random);
        Ray {
            origin: ray.origin + offset,
            ..ray
        }
    });
}

/// Directions almost within the wall *and* almost along the axis, which random
/// ones never are: there the roundings of `a × d` weigh most.
#[test]
fn long_cylinder_has_no_self_hit_along_its_axis() {
    let spawned: u64 = (0..ray_count() / 100)
        .into_par_iter()
        .map(|number| {
            let mut random = Random::new(SEED, 2_000_000 + number);
            let p0 = random.direction() * 100.0;
            let p1 = p0 + random.direction() * random.log_uniform(1.0, 1e4);
            let cylinder = Cylinder::new(p0, p1, 1.0, Caps::Both).unwrap();
            let root = Prototype {
                solids: Solids::of_cylinders(vec![CylinderRecord::new(
                    &cylinder,
                    0,
                    MaterialIndex(0),
                )]),
                ..Default::default()
            };
            let tracer =
                Tracer::new(test_support::scene_of(vec![root]), &Options::default()).unwrap();
            let axis = (p1 - p0).normalize();
            for _ in 0..30 {
                let outward = axis.cross(random.direction()).normalize();
                let target = p0 + (p1 - p0) * random.uniform(0.1, 0.9) + outward;
                let from = target + outward * 5.0 + axis * 3.0;
                let seen = Ray::new(from, DVec3::ZERO).retarget(target);
                let hit = tracer.closest(&seen).expect("aimed at the wall");
                let heading = axis * if random.below(2) == 0 { 1.0 } else { -1.0 };
                let direction = heading
                    + hit.normal.cross(heading) * random.log_uniform(1e-8, 1.0)
                    + hit.normal * random.log_uniform(1e-15, 1e-3);
                let next = tracer.closest(&hit.spawn(direction));
                assert!(
                    next.is_none(),
                    "seed {SEED}, cylinder {number}: {hit:?} spawned {} and met {next:?}",
                    test_support::bits(&hit.spawn(direction))
                );
            }
            30
        })
        .sum();
    println!("along long cylinders: {spawned} rays, none met where it left");
}

#[test]
fn nested_placements_have_no_self_hit() {
    let mut random = Random::new(SEED, 3);
    let mut place = |of: u32, offset: f64| {
        let scale = random.log_uniform(1e-3, 1e3);
        let stretch = DVec3::new(1.0, random.uniform(0.2, 1.0), random.uniform(1.0, 5.0));
        let matrix = test_support::random_rotation(&mut random)
            * DMat3::from_diagonal(stretch * scale)
            * test_support::random_rotation(&mut random);
        let translation = random.direction() * (scale * offset);
        Placement {
            of: PrototypeIndex(of),
            parent_from_child: DAffine3::from_mat3_translation(matrix, translation),
        }
    };
    let cylinders = test_support::cylinders_in_a_box(SEED, 1000);
    let inner = Prototype {
        placements: vec![place(2, 10.0)],
        ..Default::default()
    };
    let root = Prototype {
        placements: vec![place(1, 1e3)],
        ..Default::default()
    };
    let leaf = Prototype {
        solids: Solids::of_cylinders(cylinders),
        ..Default::default()
    };
    let world_from_leaf =
        root.placements[0].parent_from_child * inner.placements[0].parent_from_child;
    let scene = test_support::scene_of(vec![root, inner, leaf]);
    let tracer = Tracer::new(scene, &Options::default()).unwrap();
    spawn_over("nested", &tracer, |random| {
        let ray = ray_in_the_cube(random);
        Ray {
            origin: world_from_leaf.transform_point3(ray.origin),
            direction: world_from_leaf.transform_vector3(ray.direction),
            ..ray
        }
    });
}

/// A cylinder and capped ones that touch it: along a line of its wall, at its
/// end, and around a shared end point. A ray that leaves its surface towards a
/// neighbour meets the neighbour, however near the contact it starts.
#[test]
fn spawned_rays_do_not_pass_through_touching_neighbours() {
    let radius = 0.25;
    let capped = |p0, p1, r| Cylinder::new(p0, p1, r, Caps::Both).unwrap();
    let neighbours = [
        capped(DVec3::X * 0.75, DVec3::new(0.75, 0.0, 4.0), 0.5),
        capped(DVec3::Z * 4.0, DVec3::Z * 5.0, radius),
        capped(DVec3::Z * 4.0, DVec3::new(0.0, -3.0, 4.5), 0.3),
    ];
    let first = capped(DVec3::ZERO, DVec3::Z * 4.0, radius);
    let turns = (0..4).map(|turn| {
        let mut random = Random::new(SEED, 50 + turn);
        (
            test_support::random_rotation(&mut random),
            random.direction() * 10.0_f64.powi(turn as i32),
        )
    });
    for (number, (rotation, offset)) in turns.enumerate() {
        let records = std::iter::once(&first)
            .chain(&neighbours)
            .enumerate()
            .map(|(i, one)| {
                let moved = |p: DVec3| rotation * p + offset;
                // Moved ends are rounded: the contact is then a gap or an overlap
                // of a few ulps, as in any scene from a file.
                let cylinder =
                    Cylinder::new(moved(one.p0()), moved(one.p1()), one.radius(), one.caps());
                CylinderRecord::new(&cylinder.unwrap(), i as u32, MaterialIndex(0))
            });
        let root = Prototype {
            solids: Solids::of_cylinders(records),
            ..Default::default()
        };
        let scene: Arc<Scene> = test_support::scene_of(vec![root.clone()]);
        let tracer = Tracer::new(scene, &Options::default()).unwrap();
        let alone = Prototype {
            solids: Solids::of_cylinders(vec![root.solids.cylinders.get(0)]),
            ..Default::default()
        };
        let alone = Tracer::new(test_support::scene_of(vec![alone]), &Options::default()).unwrap();
        let met: u64 = (0..ray_count() / 4)
            .into_par_iter()
            .map(|case| {
                let mut random = Random::new(SEED, (number as u64 + 1) << 32 | case);
                let near = |random: &mut Random| random.log_uniform(1e-17, 0.1);
                // A point of the first cylinder next to one of the contacts,
                // and a point well inside the neighbour.
                let (part, at, into) = match random.below(2) {
                    0 => {
                        let (sin, cos) = libm::sincos(near(&mut random));
                        let height = random.uniform(0.1, 3.9);
                        let at = DVec3::new(radius * cos, radius * sin, height);
                        (Part::Side, at, DVec3::new(0.75, 0.0, height))
                    }
                    _ => {
                        let at = DVec3::new(0.1, 0.05, 4.0);
                        (Part::Cap1, at, at + DVec3::new(0.0, 0.0, 0.5))
                    }
                };
                let normal = if part == Part::Side {
                    at.with_z(0.0) / radius
                } else {
                    DVec3::Z
                };
                let from = rotation * (at + normal) + offset;
                let towards = Ray::new(from, DVec3::ZERO).retarget(rotation * at + offset);
                let hit = alone
                    .closest(&towards)
                    .expect("the first cylinder alone is hit");
                assert_eq!(hit.part, part);
                let spawned = hit.spawn(rotation * into + offset - hit.point);
                let next = tracer.closest(&spawned);
                let primitive = next.as_ref().map(|next| next.primitive);
                assert!(
                    primitive.is_some_and(|primitive| primitive != 0),
                    "seed {SEED}, turn {number}: {} met {next:?}",
                    test_support::bits(&spawned)
                );
                1
            })
            .sum();
        println!("turn {number}: {met} rays met the neighbour they were sent to");
    }
}
