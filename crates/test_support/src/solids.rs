//! Solids of all kinds, mixed, and their truth.

use cyltrace::math::{Orientation, Random, Ray};
use cyltrace::scene::{MaterialIndex, Prototype, SolidRecord};
use cyltrace::solid::{
    AnySolid, Caps, Cone, Cuboid, Cylinder, Disk, RoundedCone, SolidKind, Sphere,
};
use glam::DVec3;

/// How many kinds there are.
pub const KINDS: u64 = 6;

/// A solid of the kind of this number in the unit cube, with all numbers on a grid
/// of 2^-20; a cuboid is turned if `is_turned`.
pub fn any_solid(random: &mut Random, kind: u64, caps: Caps, is_turned: bool) -> AnySolid {
    let on_grid = |x: f64| (x * 1_048_576.0).round() / 1_048_576.0;
    let mut size = || on_grid(random.log_uniform(1e-3, 0.15));
    let (radius, other, third) = (size(), size(), size());
    let mut point = || DVec3::new(random.unit(), random.unit(), random.unit()).map(on_grid);
    let (p0, mut p1, normal) = (point(), point(), point() - 0.5);
    if random.below(3) == 0 {
        p1 = p0 + DVec3::AXES[random.below(3) as usize] * on_grid(random.uniform(0.01, 0.5));
    }
    let turned = || Orientation::IDENTITY.rotated(normal, 77.0 * p1.x);
    let orientation = if is_turned {
        turned()
    } else {
        Orientation::IDENTITY
    };
    match kind {
        0 => Cylinder::new(p0, p1, radius, caps).unwrap().into(),
        1 => Cone::new(p0, p1, radius, other, caps).unwrap().into(),
        2 => RoundedCone::new(p0, p1, radius, other).unwrap().into(),
        3 => Sphere::new(p0, radius).unwrap().into(),
        4 => {
            let half_widths = DVec3::new(radius, other, third);
            Cuboid::new(p0, half_widths, orientation).unwrap().into()
        }
        _ => Disk::new(p0, normal, radius).unwrap().into(),
    }
}

/// Solids in their order, as a prototype lists them; their numbers count from 0.
pub fn prototype_of(solids: &[AnySolid]) -> Prototype {
    let mut prototype = Prototype::default();
    for (number, solid) in (0..).zip(solids) {
        let record = SolidRecord::new(*solid, number, MaterialIndex(0));
        prototype.solids.push(record).expect("f64 keeps it");
    }
    prototype
}

/// Solids of all kinds in turn in the unit cube.
pub fn crowd(seed: u64, count: u64) -> Vec<AnySolid> {
    let mut random = Random::new(seed, 71);
    (0..count)
        .map(|number| {
            let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
            any_solid(&mut random, number % KINDS, caps, true)
        })
        .collect()
}

/// A ray through the unit cube, from outside of it.
pub fn ray_through(random: &mut Random) -> Ray {
    let mut inside = || DVec3::new(random.unit(), random.unit(), random.unit());
    let (from, to) = (inside(), inside());
    let back = random.log_uniform(4.0, 100.0);
    let direction = (to - from) * random.log_uniform(1e-3, 1e3);
    Ray::new(from - (to - from).normalize() * back, direction)
}

/// A ray from up to 100 away that passes a solid's center by up to half its size.
pub fn ray_near(random: &mut Random, solid: &AnySolid) -> Ray {
    let heading = random.direction();
    let aside = random.direction() * (0.5 * solid.size() * random.unit());
    let back = heading * random.log_uniform(4.0, 100.0);
    let direction = heading * random.log_uniform(1e-3, 1e3);
    Ray::new(solid.center() + aside - back, direction)
}

/// The kinds by number.
pub const KIND_NAMES: [SolidKind; KINDS as usize] = [
    SolidKind::Cylinder,
    SolidKind::Cone,
    SolidKind::RoundedCone,
    SolidKind::Sphere,
    SolidKind::Cuboid,
    SolidKind::Disk,
];

/// `max n·x` over the closed solid.
pub fn support(solid: &AnySolid, normal: DVec3) -> f64 {
    let disk = |center: DVec3, axis: DVec3, radius: f64| {
        center.dot(normal) + radius * axis.cross(normal).length() / axis.length()
    };
    let ball = |center: DVec3, radius: f64| center.dot(normal) + radius;
    match solid {
        AnySolid::Cylinder(c) => {
            let axis = c.p1() - c.p0();
            disk(c.p0(), axis, c.radius()).max(disk(c.p1(), axis, c.radius()))
        }
        AnySolid::Cone(c) => {
            let axis = c.p1() - c.p0();
            disk(c.p0(), axis, c.radius0()).max(disk(c.p1(), axis, c.radius1()))
        }
        AnySolid::RoundedCone(c) => ball(c.p0(), c.radius0()).max(ball(c.p1(), c.radius1())),
        AnySolid::Sphere(s) => ball(s.center(), s.radius()),
        AnySolid::Disk(d) => disk(d.center(), d.normal(), d.radius()),
        AnySolid::Cuboid(c) => {
            let own = c.orientation().to_object(normal).abs();
            c.center().dot(normal) + own.dot(c.half_widths())
        }
    }
}

/// A solid of whichever kind about the origin, whose sizes may be far apart.
pub fn random_solid(random: &mut Random) -> AnySolid {
    let p0 = DVec3::ZERO;
    let p1 = random.direction() * random.log_uniform(1e-3, 1e3);
    let r0 = random.log_uniform(1e-3, 1e3);
    let r1 = match random.below(4) {
        0 => 0.0,
        1 => r0 * (1.0 + 1e-12 * random.uniform(-1.0, 1.0)),
        // Beside the border of one ball holding the other.
        2 => (r0 - p1.length() * (1.0 - random.log_uniform(1e-17, 1e-1))).abs(),
        _ => random.log_uniform(1e-3, 1e3),
    };
    let (r0, r1) = if random.below(2) == 0 {
        (r0, r1)
    } else {
        (r1, r0)
    };
    match random.below(8) {
        0 => Cylinder::new(p0, p1, r0.max(r1), Caps::Both)
            .unwrap()
            .into(),
        1 => Sphere::new(p0, r0.max(r1)).unwrap().into(),
        2 => Disk::new(p0, p1, r0.max(r1)).unwrap().into(),
        3 => {
            let turned =
                Orientation::IDENTITY.rotated(random.direction(), random.uniform(0.0, 99.0));
            Cuboid::new(p0, p1.abs() + r0.max(r1), turned)
                .unwrap()
                .into()
        }
        4 | 5 => Cone::new(p0, p1, r0, r1, Caps::Both).unwrap().into(),
        _ => RoundedCone::new(p0, p1, r0, r1).unwrap().into(),
    }
}
