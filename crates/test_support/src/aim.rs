//! Rays that are aimed at cylinders, where it is hard to hit them.

use cyltrace::math::{Random, Ray};
use cyltrace::scene::CylinderRecord;
use cyltrace::solid::Cylinder;
use glam::{DAffine3, DVec3};

/// A ray at a cylinder of the unit cube from up to `reach` away, with any
/// length of direction and any kind of range.
///
/// Half of the rays graze: they pass just inside the wall where it comes
/// nearest to a face of its box, which is where a box that is too small, or a
/// rounding against it, loses them first.
pub fn ray_at(random: &mut Random, cylinders: &[CylinderRecord], reach: f64) -> Ray {
    let cylinder = cylinders[random.below(cylinders.len() as u64) as usize].cylinder();
    let along = cylinder.p1() - cylinder.p0();
    let axis = along.normalize();
    let middle = cylinder.p0() + along * random.unit();
    let coordinate = DVec3::AXES[random.below(3) as usize];
    let towards_face = coordinate - axis * coordinate.dot(axis);
    let grazes = random.below(2) == 0 && towards_face.length() > 1e-3;
    let (target, heading) = if grazes {
        let outward = towards_face.normalize();
        let depth = 1.0 - random.log_uniform(1e-15, 1e-3);
        let tangent = outward.cross(axis) + axis * random.uniform(-1.0, 1.0);
        (middle + outward * (cylinder.radius() * depth), tangent)
    } else {
        (
            middle + random.direction() * (cylinder.radius() * random.uniform(0.0, 1.2)),
            random.direction(),
        )
    };
    let heading = match random.below(8) {
        0 => DVec3::AXES[random.below(3) as usize],
        _ => heading.normalize(),
    };
    let distance = match random.below(4) {
        0 => random.log_uniform(1e-3, 1.0),
        1 => random.log_uniform(1.0, 10.0),
        _ => random.log_uniform(1.0, reach),
    };
    let origin = target - heading * distance;
    let scale = random.log_uniform(1e-30, 1e30);
    let (t_min, t_max) = range(random, distance / scale);
    Ray {
        origin,
        direction: heading * scale,
        t_min,
        t_max,
    }
}

/// Any kind of range for a ray whose target is at `t`.
pub fn range(random: &mut Random, t: f64) -> (f64, f64) {
    match random.below(4) {
        0 => (0.0, f64::INFINITY),
        1 => (-2.0 * t, f64::INFINITY),
        2 => (0.0, t * random.uniform(0.5, 1.5)),
        _ => (t * random.uniform(-1.5, 1.0), t * random.uniform(1.0, 2.0)),
    }
}

/// The point of a cylinder that is farthest in a direction, one of them where
/// there are many.
pub fn farthest_point(cylinder: &Cylinder, outward: DVec3) -> DVec3 {
    let along = cylinder.p1() - cylinder.p0();
    let end = if along.dot(outward) > 0.0 {
        cylinder.p1()
    } else {
        cylinder.p0()
    };
    let across = outward - along * (outward.dot(along) / along.length_squared());
    end + across.normalize_or_zero() * cylinder.radius()
}

/// The ray carried along by a placement.
pub fn carried(image: &DAffine3, ray: &Ray) -> Ray {
    Ray {
        origin: image.transform_point3(ray.origin),
        direction: image.transform_vector3(ray.direction),
        ..*ray
    }
}
