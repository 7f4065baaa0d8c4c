//! Random solids of one kind in the unit cube, and a camera before it.
//!
//! A ray hits the same number of solids in all of them. A line hits a convex
//! solid with an area of `S` in one of all directions with the chance of its mean
//! shadow, `S / 4` (Cauchy), so that in a unit of its length it hits `n S / 4` of `n`
//! solids. The sizes are chosen so that this is as for [`sticks`].

use glam::DVec3;

use cyltrace::math::{Orientation, Random};
use cyltrace::scene::{
    Camera, CylinderRecord, Film, Frame, MaterialIndex, Projection, Prototype, Scene, SolidRecord,
    Solids,
};
use cyltrace::solid::{Caps, Cone, Cuboid, Cylinder, Disk, RoundedCone, SolidKind, Sphere};

/// `count` sticks with their middles uniform in the unit cube and uniform
/// directions, closed, in f32 numbers.
///
/// They are `length = 2 count^(-1/3)` long, twice the mean distance of
/// neighbours, and `radius = length / 20` thick. A line hits
/// `π/2 radius length count` sticks in a unit of its length, `0.63 / length`, and
/// the boxes of some five times as many: so a ray goes some 1.6 lengths and
/// misses a few nearby sticks before it hits one, whatever their number, and a
/// picture is full of them.
#[must_use]
pub fn sticks(count: usize, seed: u64) -> Scene {
    let length = length_of(count);
    let radius = f64::from((0.05 * length) as f32);
    let stick = |number: u32| {
        let mut random = Random::new(seed, u64::from(number));
        let [p0, p1] = random_ends(&mut random, length);
        let cylinder = Cylinder::new(p0, p1, radius, Caps::Both);
        let cylinder = cylinder.expect("a stick is longer than f32 rounds");
        CylinderRecord::new(&cylinder, number, MaterialIndex::default())
    };
    let mut sticks = Prototype {
        solids: Solids::of_cylinders((0..count as u32).map(stick)),
        ..Prototype::default()
    };
    // As a scene file's are when they are loaded.
    sticks.solids.cylinders.arrange();
    scene_of(sticks)
}

/// `count` solids of a kind, uniform in the unit cube and turned any way, in f32
/// numbers (but for the axes of cuboids, which no f32 would keep orthonormal).
/// A line hits about the same number as of [`sticks`], `0.63 / length` in a unit of its
/// length, so their mean area is `π/10 length²`:
///
/// - Cones and rounded cones are sticks that taper: either radius is uniform between
///   1/40 and 3/40 of the length, 1/20 in the mean, as that of sticks. Their ends add
///   5 % and 10 % to the area, as the disks of sticks add 5 %.
/// - Spheres have the radius `length / √40`, disks `length / √20`, for both of their
///   sides count.
/// - The half widths of cuboids are each uniform between `h/2` and `3h/2`. They are
///   independent, so the mean area is `24 h²`, and `h = length √(π/240)`.
///
/// # Panics
/// When the kind is that of cylinders or of compositions.
#[must_use]
pub fn random_scene(kind: SolidKind, count: usize, seed: u64) -> Scene {
    let length = length_of(count);
    let mut solids = Solids::default();
    for number in 0..count as u32 {
        let mut random = Random::new(seed, u64::from(number));
        match kind {
            SolidKind::Cone => {
                let ([p0, p1], [r0, r1]) = tapered_stick(&mut random, length);
                let cone = Cone::new(p0, p1, r0, r1, Caps::Both);
                solids.cones.push(record(cone, number));
            }
            SolidKind::RoundedCone => {
                let ([p0, p1], [r0, r1]) = tapered_stick(&mut random, length);
                let cone = RoundedCone::new(p0, p1, r0, r1);
                solids.rounded_cones.push(record(cone, number));
            }
            SolidKind::Sphere => {
                let radius = narrow(length / 40.0_f64.sqrt());
                let sphere = Sphere::new(random_middle(&mut random), radius);
                solids.spheres.push(record(sphere, number));
            }
            SolidKind::Cuboid => {
                let middle = random_middle(&mut random);
                let mean = length * (std::f64::consts::PI / 240.0).sqrt();
                let half_widths = DVec3::from_array(std::array::from_fn(|_| {
                    narrow(mean * random.uniform(0.5, 1.5))
                }));
                let turn = random.uniform(0.0, 360.0);
                let turned = Orientation::IDENTITY.rotated(random.direction(), turn);
                let cuboid = Cuboid::new(middle, half_widths, turned);
                solids.cuboids.push(record(cuboid, number));
            }
            SolidKind::Disk => {
                let middle = random_middle(&mut random);
                let radius = narrow(length / 20.0_f64.sqrt());
                let disk = Disk::new(middle, rounded(random.direction()), radius);
                solids.disks.push(record(disk, number));
            }
            _ => panic!("no random_scene of the kind {}", kind.name()),
        }
    }
    scene_of(Prototype {
        solids,
        ..Prototype::default()
    })
}

/// The length of sticks.
fn length_of(count: usize) -> f64 {
    2.0 / libm::cbrt(count as f64)
}

fn narrow(number: f64) -> f64 {
    f64::from(number as f32)
}

fn rounded(point: DVec3) -> DVec3 {
    point.as_vec3().as_dvec3()
}

fn random_place(random: &mut Random) -> DVec3 {
    DVec3::new(random.unit(), random.unit(), random.unit())
}

fn random_middle(random: &mut Random) -> DVec3 {
    rounded(random_place(random))
}

fn random_ends(random: &mut Random, length: f64) -> [DVec3; 2] {
    let middle = random_place(random);
    let half = random.direction() * (0.5 * length);
    [rounded(middle - half), rounded(middle + half)]
}

/// The ends and their radii.
fn tapered_stick(random: &mut Random, length: f64) -> ([DVec3; 2], [f64; 2]) {
    let ends = random_ends(random, length);
    let radii = std::array::from_fn(|_| narrow(length * random.uniform(0.025, 0.075)));
    (ends, radii)
}

fn record<S, E: std::fmt::Debug>(solid: Result<S, E>, number: u32) -> SolidRecord<S> {
    let solid = solid.expect("its sizes are far above what f32 rounds");
    SolidRecord::new(solid, number, MaterialIndex::default())
}

/// The scene of a prototype in the unit cube.
fn scene_of(prototype: Prototype) -> Scene {
    Scene {
        camera: CAMERA,
        film: FILM,
        ..Scene::new(vec![prototype])
    }
}

/// Before the cube, which fills the picture: rays that miss everything say nothing
/// of solids.
const CAMERA: Camera = Camera {
    projection: Projection::Perspective { fov_degrees: 36.0 },
    frame: Frame::LookAt {
        position: DVec3::new(0.5, -1.2, 0.5),
        look_at: DVec3::new(0.5, 0.5, 0.5),
        up: DVec3::Z,
    },
    lens: None,
};

/// As many pixels as usual pictures have, and square as the cube is.
const FILM: Film = Film {
    width: 1024,
    height: 1024,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::traversal::random_rays;
    use cyltrace::math::{Bounds, Ray};
    use cyltrace::solid::AnySolid;

    #[test]
    fn sticks_are_in_f32_numbers_and_of_their_length() {
        let scene = sticks(1000, 3);
        let cylinders = &scene.prototypes[0].solids.cylinders;
        assert_eq!(cylinders.len(), 1000);
        for record in cylinders {
            let cylinder = record.cylinder();
            for point in [cylinder.p0(), cylinder.p1()] {
                assert_eq!(point, point.as_vec3().as_dvec3());
            }
            let length = (cylinder.p1() - cylinder.p0()).length();
            assert!((length - 0.2).abs() < 1e-6, "{length}");
            assert!((cylinder.radius() - 0.01).abs() < 1e-9);
        }
    }

    /// How many solids a ray enters in a unit of its length.
    fn met(scene: &Scene, seed: u64) -> f64 {
        const LENGTH: f64 = 0.2;
        // So far within the cube that rays stay there.
        let within = Bounds {
            lower: DVec3::splat(0.3),
            upper: DVec3::splat(0.7),
        };
        let rays = random_rays(&within, 1000, seed);
        let solids: Vec<AnySolid> = scene.prototypes[0].singles().map(|(_, one)| one).collect();
        let enters = |ray: &Ray| {
            let chords = solids
                .iter()
                .filter_map(|solid| solid.chord(ray.origin - solid.anchor(), ray.direction));
            chords
                .filter(|chord| (0.0..LENGTH).contains(&chord.enter.t))
                .count()
        };
        rays.iter().map(enters).sum::<usize>() as f64 / (LENGTH * rays.len() as f64)
    }

    #[test]
    fn thickets_are_met_as_often_as_sticks() {
        const SEED: u64 = 12;
        // This many that their density is even within a few per cent.
        const COUNT: usize = 20_000;
        let expected = 0.1 * std::f64::consts::PI / 4.0 * 8.0 / length_of(COUNT);
        let of_sticks = met(&sticks(COUNT, SEED), SEED);
        for kind in [
            SolidKind::Cone,
            SolidKind::RoundedCone,
            SolidKind::Sphere,
            SolidKind::Cuboid,
            SolidKind::Disk,
        ] {
            let scene = random_scene(kind, COUNT, SEED);
            assert_eq!(scene.prototypes[0].solids.len(), COUNT);
            let found = met(&scene, SEED);
            for other in [expected, of_sticks] {
                let ratio = found / other;
                assert!((0.9..1.2).contains(&ratio), "{}: {ratio}", kind.name());
            }
        }
    }
}
