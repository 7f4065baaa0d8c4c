//! The first hit of a solid of whichever kind, its normal and its gap.
//!
//! The normal of a wall is the gradient of the polynomial that is zero there
//! (`taper.rs`), of a sphere the way from its center, of a face or a disk that of its
//! plane.

use glam::DVec3;

use super::affine::ExactAffine;
use super::cone::cylinder_hits;
use super::cylinder::{TrueHit, first_hit};
use super::normal::{outward_normal, unit};
use super::number::{ExactVector, exact};
use super::ray::ExactRay;
use super::taper::{Taper, numbers_of};
use super::{
    cone_gap, cone_hits, cuboid_chord, cuboid_gap, disk_chord, disk_gap, gap, rounded_cone_gap,
    rounded_cone_hits, sphere_chord, sphere_gap,
};
use cyltrace::math::{Ray, power_of_two};
use cyltrace::solid::{AnySolid, Part};

/// The first point of the surface in the ray's range.
///
/// # Panics
/// When the ray is not valid ([`Ray::is_valid`]).
#[must_use]
pub fn first_hit_of_any(solid: &AnySolid, ray: &Ray) -> Option<TrueHit> {
    match solid {
        AnySolid::Cylinder(cylinder) => first_hit(cylinder, ray).hit,
        _ => hits_of_any(solid, ray).into_iter().next(),
    }
}

/// All points in the ray's range in which it meets the surface, in order: an entry
/// and an exit at most, and a tangent is both. Of a disk they are at the same
/// parameter, unless the ray runs within its plane.
///
/// # Panics
/// When the ray is not valid.
#[must_use]
pub fn hits_of_any(solid: &AnySolid, ray: &Ray) -> Vec<TrueHit> {
    hits(solid, &ExactRay::new(ray))
}

/// The same of a solid that is placed in the ray's space, with the ray's parameters.
///
/// # Panics
/// When the ray is not valid, or the placement's matrix is singular.
#[must_use]
pub fn placed_hits_of_any(
    solid: &AnySolid,
    world_from_object: &ExactAffine,
    ray: &Ray,
) -> Vec<TrueHit> {
    hits(solid, &ExactRay::through(world_from_object, ray))
}

fn hits(solid: &AnySolid, ray: &ExactRay) -> Vec<TrueHit> {
    let chord = match solid {
        AnySolid::Cylinder(cylinder) => return cylinder_hits(cylinder, ray),
        AnySolid::Cone(cone) => return cone_hits(cone, ray),
        AnySolid::RoundedCone(cone) => return rounded_cone_hits(cone, ray),
        AnySolid::Sphere(sphere) => sphere_chord(sphere, ray),
        AnySolid::Cuboid(cuboid) => cuboid_chord(cuboid, ray),
        AnySolid::Disk(disk) => disk_chord(disk, ray),
    };
    chord.map_or(Vec::new(), |chord| chord.hits(ray))
}

/// The least relative change of the numbers after which the first hit may be another.
///
/// # Panics
/// When the ray is not valid.
#[must_use]
pub fn gap_of_any(solid: &AnySolid, ray: &Ray) -> f64 {
    match solid {
        AnySolid::Cylinder(cylinder) => gap(cylinder, ray, first_hit(cylinder, ray).hit.as_ref()),
        AnySolid::Cone(cone) => cone_gap(cone, ray),
        AnySolid::RoundedCone(cone) => rounded_cone_gap(cone, ray),
        AnySolid::Sphere(sphere) => sphere_gap(sphere, ray),
        AnySolid::Cuboid(cuboid) => cuboid_gap(cuboid, ray),
        AnySolid::Disk(disk) => disk_gap(disk, ray),
    }
}

/// The unit vector out of the solid at a hit of `ray`; `None` at an apex without a
/// disk. That of a disk is the one it is stated with.
///
/// A hit's `t` is rounded, far beyond f64: what is nearer to the apex than 2^-500 of the
/// way there is at it.
#[must_use]
pub fn outward_normal_of_any(solid: &AnySolid, ray: &Ray, hit: &TrueHit) -> Option<DVec3> {
    let from = |point: DVec3| {
        let x = &ExactVector::new(ray.origin) - &ExactVector::new(point);
        &x + &ExactVector::new(ray.direction).times(&hit.t)
    };
    let is_at_apex = |points: [DVec3; 2], radii: [f64; 2]| {
        points.into_iter().zip(radii).any(|(point, radius)| {
            let (off, way) = (from(point), ExactVector::new(ray.direction).times(&hit.t));
            let near = exact(power_of_two(-500));
            radius == 0.0 && off.dot(&off) <= way.dot(&way) * &near * &near
        })
    };
    let outward = match solid {
        AnySolid::Cylinder(cylinder) => return Some(outward_normal(cylinder, ray, hit)),
        AnySolid::Cone(cone) => {
            let ends = [cone.p0(), cone.p1()];
            let radii = [cone.radius0(), cone.radius1()];
            let taper = Taper::new(&numbers_of(ends, radii, &ExactRay::new(ray)), false);
            match hit.part {
                Part::Side if is_at_apex(ends, radii) => return None,
                Part::Cap0 => taper.a.times(&exact(-1.0)),
                Part::Cap1 => taper.a,
                _ => taper.gradient(&from(cone.p0())),
            }
        }
        AnySolid::RoundedCone(cone) => {
            let ends = [cone.p0(), cone.p1()];
            let radii = [cone.radius0(), cone.radius1()];
            match hit.part {
                _ if is_at_apex(ends, radii) => return None,
                Part::Cap0 => from(cone.p0()),
                Part::Cap1 => from(cone.p1()),
                _ => {
                    let numbers = numbers_of(ends, radii, &ExactRay::new(ray));
                    Taper::new(&numbers, true).gradient(&from(cone.p0()))
                }
            }
        }
        AnySolid::Sphere(sphere) => from(sphere.center()),
        AnySolid::Cuboid(cuboid) => {
            let axes = cuboid.orientation().world_from_object();
            let (axis, side) = match hit.part {
                Part::XMin => (0, -1.0),
                Part::XMax => (0, 1.0),
                Part::YMin => (1, -1.0),
                Part::YMax => (1, 1.0),
                Part::ZMin => (2, -1.0),
                _ => (2, 1.0),
            };
            ExactVector::new(axes.col(axis) * side)
        }
        AnySolid::Disk(disk) => ExactVector::new(disk.normal()),
    };
    unit(&outward)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::math::Orientation;
    use cyltrace::solid::{Caps, Cone, Cuboid, Disk, RoundedCone, Sphere};

    #[test]
    fn first_hits_of_known_solids_have_their_known_normals() {
        let cone = Cone::new(DVec3::ZERO, DVec3::Z * 4.0, 3.0, 0.0, Caps::Both).unwrap();
        let round = RoundedCone::new(DVec3::ZERO, DVec3::Z * 5.0, 4.0, 1.0).unwrap();
        let sphere = Sphere::new(DVec3::ZERO, 5.0).unwrap();
        let cuboid = Cuboid::new(DVec3::ZERO, DVec3::ONE, Orientation::IDENTITY).unwrap();
        let disk = Disk::new(DVec3::ZERO, DVec3::new(3.0, 0.0, 4.0), 5.0).unwrap();
        let cases: [(AnySolid, DVec3, DVec3, f64, Part, DVec3); 8] = [
            // The walls of the cone and of the rounded one have the normals
            // (4, 3) / 5 and (4, 3) / 5.
            (
                cone.into(),
                DVec3::new(9.0, 0.0, 2.0),
                DVec3::NEG_X,
                7.5,
                Part::Side,
                DVec3::new(0.8, 0.0, 0.6),
            ),
            (
                cone.into(),
                DVec3::new(1.0, 0.0, -2.0),
                DVec3::Z,
                2.0,
                Part::Cap0,
                DVec3::NEG_Z,
            ),
            (
                round.into(),
                DVec3::new(9.2, 0.0, 2.4),
                DVec3::NEG_X,
                6.0,
                Part::Cap0,
                DVec3::new(0.8, 0.0, 0.6),
            ),
            (
                round.into(),
                DVec3::new(7.0, 0.0, 4.0),
                DVec3::NEG_X,
                5.0,
                Part::Side,
                DVec3::new(0.8, 0.0, 0.6),
            ),
            (
                round.into(),
                DVec3::Z * 9.0,
                DVec3::NEG_Z,
                3.0,
                Part::Cap1,
                DVec3::Z,
            ),
            (
                sphere.into(),
                DVec3::new(-9.0, 3.0, 0.0),
                DVec3::X,
                5.0,
                Part::Side,
                DVec3::new(-0.8, 0.6, 0.0),
            ),
            (
                cuboid.into(),
                DVec3::new(0.5, 9.0, 0.0),
                DVec3::NEG_Y,
                8.0,
                Part::YMax,
                DVec3::Y,
            ),
            (
                disk.into(),
                DVec3::Z * 3.0,
                DVec3::NEG_Z,
                3.0,
                Part::Side,
                DVec3::new(0.6, 0.0, 0.8),
            ),
        ];
        for (solid, origin, direction, t, part, normal) in cases {
            let ray = Ray::new(origin, direction);
            let hit = first_hit_of_any(&solid, &ray).expect("a hit");
            let found = outward_normal_of_any(&solid, &ray, &hit).expect("a normal");
            assert_eq!(hit.part, part, "{solid:?} {ray:?}");
            assert!((hit.t_f64() - t).abs() < 1e-14, "{hit:?}");
            assert!((found - normal).length() < 3e-15, "{found} for {normal}");
            assert!(gap_of_any(&solid, &ray) >= 0.0);
        }
    }

    /// Through the apex at `t = 26/3` and `t = 0`.
    #[test]
    fn apices_have_no_normal() {
        let round = RoundedCone::new(DVec3::ZERO, DVec3::Z * 975.0, 0.0, 780.0).unwrap();
        let cone = Cone::new(DVec3::ZERO, DVec3::Z * 975.0, 0.0, 780.0, Caps::None).unwrap();
        let direction = DVec3::new(180.0, 432.0, 351.0);
        for solid in [AnySolid::from(round), cone.into()] {
            for origin in [DVec3::new(-1560.0, -3744.0, -3042.0), DVec3::ZERO] {
                let ray = Ray::new(origin, direction);
                let hit = first_hit_of_any(&solid, &ray).expect("a hit");
                assert_eq!(outward_normal_of_any(&solid, &ray, &hit), None, "{ray:?}");
            }
        }
    }
}
