//! What is known to be wrong with Embree's own straight curves, counted against
//! the oracle: why cylinders are user geometry here, and why `check` has no witness that is
//! made of such curves.
//!
//! The tests say what the versions in [`SEEN_IN`] do. When one fails, upstream
//! has changed: it is good news, to be written down here and in
//! `docs/accuracy.md`.
//!
//! From Embree's sources (`coneline_intersector.h`, `roundline_intersector.h`):
//! the cone's quadratic has `A = |a|⁴ - (a·d)²|a|²` where `|a|⁴|d|²` would be
//! right; with it, a direction that is not of unit length, hence every ray in an
//! instance that scales, meets another shape. Its terms are of the eighth degree
//! in lengths, and cancel in f32. The `u` of a second hit is chosen by what the
//! first one was. A ray whose discriminant rounds to a negative number is a miss
//! before the disks are looked at, as rays along the axis may be. A round curve
//! takes a ray along its axis for a miss of the cone and forgets about the spheres.

use std::sync::Arc;

use cyltrace::embree::{Device, DeviceOptions, NativeHit, Ray32, Scene, SceneBuilder, Version};
use cyltrace::math::{Random, Ray};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace_oracle::first_hit;
use glam::{DVec3, Vec3};

/// Versions whose defects these are.
const SEEN_IN: [(u32, u32); 2] = [(3, 13), (4, 4)];

const SEED: u64 = 404;

/// Holds a defect to be there still.
fn assert_still(defect: bool, device: &Device, what: &str) {
    let Version { major, minor, .. } = device.version();
    let seen = SEEN_IN.contains(&(major, minor));
    assert!(
        defect,
        "Embree {} ({} before): {what}. Fixed upstream? Update this test and docs/accuracy.md",
        device.version(),
        if seen { "seen wrong" } else { "not tried" },
    );
}

fn device() -> Device {
    Device::new(&DeviceOptions::default()).unwrap()
}

/// A cylinder of numbers that f32 holds, about the origin.
fn cylinder(random: &mut Random, radius: f32, length: f64) -> Cylinder {
    let half = (random.direction() * (length / 2.0)).as_vec3().as_dvec3();
    Cylinder::new(-half, half, f64::from(radius), Caps::Both).unwrap()
}

fn vertices(cylinder: &Cylinder) -> [[f32; 4]; 2] {
    [cylinder.p0(), cylinder.p1()].map(|end| {
        let [x, y, z] = end.as_vec3().to_array();
        [x, y, z, cylinder.radius() as f32]
    })
}

fn cone(device: &Device, cylinder: &Cylinder) -> Scene<()> {
    let mut builder = SceneBuilder::new(device).unwrap();
    builder
        .attach_cone_curves(&vertices(cylinder), &[0], None)
        .unwrap();
    builder.commit().unwrap()
}

/// A ray of f32 numbers from `distance` to a point within 1.2 radii of the axis.
fn ray_at(random: &mut Random, cylinder: &Cylinder, distance: f64, speed: f64) -> Ray32 {
    let axis = cylinder.p1() - cylinder.p0();
    let across = axis.cross(random.direction()).normalize();
    let off = across * (cylinder.radius() * random.uniform(0.0, 1.2));
    let target = cylinder.p0() + axis * random.uniform(0.0, 1.0) + off;
    let heading = random.direction();
    let origin = target - heading * distance;
    ray(origin.as_vec3(), (heading * speed).as_vec3())
}

fn ray(origin: Vec3, direction: Vec3) -> Ray32 {
    Ray32 {
        origin: origin.to_array(),
        direction: direction.to_array(),
        t_near: 0.0,
        t_far: f32::INFINITY,
    }
}

/// The very same ray in f64.
fn widened(ray: &Ray32) -> Ray {
    let wide = |vector: [f32; 3]| DVec3::from_array(vector.map(f64::from));
    Ray::new(wide(ray.origin), wide(ray.direction))
}

/// Answers of Embree's against true ones.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    rays: u32,
    /// Rays that truly hit.
    hits: u32,
    /// True hits that Embree misses.
    lost: u32,
    /// True misses that Embree hits.
    invented: u32,
    /// Hits more than a hundredth of the radius before or behind the true one.
    displaced: u32,
    /// The greatest such distance, in radii.
    worst: f64,
}

impl Count {
    fn wrong(&self) -> u32 {
        self.lost + self.invented + self.displaced
    }

    fn add(&mut self, cylinder: &Cylinder, ray: &Ray32, found: Option<NativeHit>) {
        let ray = widened(ray);
        let truth = first_hit(cylinder, &ray).hit;
        self.rays += 1;
        self.hits += u32::from(truth.is_some());
        match (truth, found) {
            (Some(truth), Some(found)) => {
                let off = (f64::from(found.t) - truth.t_f64()).abs();
                let off = off * ray.direction.length() / cylinder.radius();
                self.displaced += u32::from(off > 0.01);
                self.worst = self.worst.max(off);
            }
            (Some(_), None) => self.lost += 1,
            (None, Some(_)) => self.invented += 1,
            (None, None) => {}
        }
    }
}

/// Rays with directions of length `speed` at cylinders of radius 0.5 and length
/// 1, placed by a native instance that scales by the power of two `scale`.
fn count_scaled(device: &Device, rays: u64, speed: f64, scale: f32) -> Count {
    let mut count = Count::default();
    for index in 0..rays / 50 {
        let mut random = Random::new(SEED, index);
        let child_cylinder = cylinder(&mut random, 0.5, 1.0);
        let mut scene = cone(device, &child_cylinder);
        let mut placed = child_cylinder;
        if scale != 1.0 {
            let map = std::array::from_fn(|row| {
                std::array::from_fn(|column| if row == column { scale } else { 0.0 })
            });
            let mut parent = SceneBuilder::new(device).unwrap();
            parent.attach_instance(&Arc::new(scene), &map).unwrap();
            scene = parent.commit().unwrap();
            // Exact, since the scale is a power of two.
            let by = f64::from(scale);
            placed = Cylinder::new(
                child_cylinder.p0() * by,
                child_cylinder.p1() * by,
                child_cylinder.radius() * by,
                Caps::Both,
            )
            .unwrap();
        }
        for _ in 0..50 {
            let ray = ray_at(&mut random, &placed, 3.0 * f64::from(scale), speed);
            count.add(&placed, &ray, scene.closest_native(&ray, &mut ()));
        }
    }
    count
}

const RAYS: u64 = 20_000;

#[test]
fn cone_curve_unit_directions_are_right_near_by() {
    let device = device();
    let count = count_scaled(&device, RAYS, 1.0, 1.0);
    println!("|d| = 1: {count:?}");
    // A few rays graze within what f32 resolves.
    assert!(count.hits > 10_000 && count.wrong() <= 20, "{count:?}");
}

#[test]
fn cone_curve_directions_of_other_lengths_meet_another_shape() {
    let device = device();
    for speed in [0.5, 2.0, 10.0] {
        let count = count_scaled(&device, RAYS, speed, 1.0);
        println!("|d| = {speed}: {count:?}");
        assert_still(
            count.wrong() > count.hits / 5,
            &device,
            &format!("|d| = {speed} is wrong for {count:?}"),
        );
    }
}

#[test]
fn cone_curve_in_scaling_instance_meets_another_shape() {
    let device = device();
    let unscaled = count_scaled(&device, RAYS, 1.0, 1.0);
    assert!(unscaled.wrong() <= 20, "{unscaled:?}");
    for scale in [0.125, 8.0] {
        let count = count_scaled(&device, RAYS, 1.0, scale);
        println!("instance scaled by {scale}, |d| = 1: {count:?}");
        assert_still(
            count.wrong() > count.hits / 5,
            &device,
            &format!("an instance scaled by {scale} is wrong for {count:?}"),
        );
    }
}

#[test]
fn cone_curve_rays_along_its_axis_miss_the_cap() {
    let device = device();
    // Lengths in radii; the least share lost.
    for (length, least_lost) in [(4.0, 0.02), (20.0, 0.02)] {
        let mut count = Count::default();
        for index in 0..4_000 {
            let mut random = Random::new(SEED, index);
            let line = cylinder(&mut random, 0.5, 0.5 * length);
            let axis = line.p1() - line.p0();
            let across = axis.cross(random.direction()).normalize();
            let origin = line.p0() - axis + across * random.uniform(0.0, 0.4);
            let ray = ray(origin.as_vec3(), axis.normalize().as_vec3());
            let found = cone(&device, &line).closest_native(&ray, &mut ());
            count.add(&line, &ray, found);
        }
        println!("along the axis of {length} r: {count:?}");
        assert!(count.hits > 3_900, "{count:?}");
        assert_still(
            f64::from(count.lost) > least_lost * f64::from(count.hits),
            &device,
            &format!("rays along the axis of {length} r are wrong for {count:?}"),
        );
    }
}

#[test]
fn cone_curve_far_cap_tells_the_u_of_the_near_one() {
    let device = device();
    let line = Cylinder::new(-DVec3::Z, DVec3::Z, 0.5, Caps::Both).unwrap();
    let mut builder = SceneBuilder::<Vec<NativeHit>>::new(&device).unwrap();
    builder
        .attach_collecting_cone_curves(&vertices(&line), &[0], None)
        .unwrap();
    let scene = builder.commit().unwrap();
    let (mut hits, mut through, mut wrong) = (vec![], 0, 0);
    for index in 0..2_000 {
        let mut random = Random::new(SEED, index);
        let from = if index % 2 == 0 { -3.0 } else { 3.0 };
        let mut off = || random.uniform(-0.3, 0.3);
        let (near, far) = (
            DVec3::new(off(), off(), from),
            DVec3::new(off(), off(), -from),
        );
        let ray = ray(near.as_vec3(), (far - near).normalize().as_vec3());
        scene.every_hit(&ray, &mut hits);
        let [enter, leave] = hits[..] else { continue };
        through += 1;
        // From end to end: u is 0 at the first end and 1 at the second.
        let near_u = if from < 0.0 { 0.0 } else { 1.0 };
        assert_eq!(enter.u, near_u, "ray {index}");
        wrong += u32::from(leave.u != 1.0 - near_u);
    }
    println!("through both caps: {through}, far u wrong: {wrong}");
    assert!(through > 1_900, "{through}");
    assert_still(
        wrong == through,
        &device,
        &format!("the far cap's u is wrong for {wrong} of {through} rays"),
    );
}

#[test]
fn cone_curve_long_thin_cylinders_are_lost() {
    let device = device();
    // Of radius 1, by length and distance; the least share lost.
    for (length, distance, least_lost) in [(3e4, 1e4, 0.5), (1e3, 1e3, 0.0)] {
        let mut count = Count::default();
        for index in 0..200 {
            let mut random = Random::new(SEED, index);
            let long = cylinder(&mut random, 1.0, length);
            let scene = cone(&device, &long);
            for _ in 0..20 {
                let ray = ray_at(&mut random, &long, distance, 1.0);
                count.add(&long, &ray, scene.closest_native(&ray, &mut ()));
            }
        }
        println!("length {length:e} r from {distance:e} r: {count:?}");
        assert_still(
            f64::from(count.lost) >= least_lost * f64::from(count.hits) && count.wrong() > 0,
            &device,
            &format!("length {length:e} r from {distance:e} r is wrong for {count:?}"),
        );
    }
}

#[test]
fn round_curve_rays_along_its_axis_are_lost() {
    let device = device();
    for (tilt, still_lost) in [(0.0, true), (1e-6, true), (1e-4, true), (1e-2, false)] {
        let (mut hits, mut lost) = (0, 0);
        for index in 0..2_000 {
            let mut random = Random::new(SEED, index);
            let line = Cylinder::new(-DVec3::Z, DVec3::Z, 0.5, Caps::Both).unwrap();
            let mut builder = SceneBuilder::<()>::new(&device).unwrap();
            builder
                .attach_round_curves(&vertices(&line), &[0], None)
                .unwrap();
            let scene = builder.commit().unwrap();
            let mut off = || random.uniform(-0.3, 0.3);
            let origin = DVec3::new(off(), off(), -3.0);
            let direction = DVec3::new(tilt, 0.0, 1.0).normalize();
            let ray = ray(origin.as_vec3(), direction.as_vec3());
            // The capsule holds the cylinder, so what meets this meets that.
            if first_hit(&line, &widened(&ray)).hit.is_some() {
                hits += 1;
                lost += u32::from(scene.closest_native(&ray, &mut ()).is_none());
            }
        }
        println!("tilted by {tilt:e}: {hits} hits, {lost} lost");
        assert!(hits > 1_900, "{hits}");
        let as_before = if still_lost { lost == hits } else { lost == 0 };
        assert_still(
            as_before,
            &device,
            &format!("a ray tilted by {tilt:e} is lost {lost} times of {hits}"),
        );
    }
}
