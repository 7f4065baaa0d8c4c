//! The first hit of a solid of any kind, its normal and its gap.
//!
//! Each kind implements [`TrueSolid`] in its own file.

use glam::DVec3;

use super::affine::ExactAffine;
use super::cylinder::TrueHit;
use super::number::{ExactVector, exact};
use super::ray::ExactRay;
use cyltrace::math::{Ray, power_of_two};
use cyltrace::solid::AnySolid;
use cyltrace::with_solid;

/// A kind of solid whose truth is known.
pub trait TrueSolid {
    /// All points in the ray's range in which it meets the surface, in order: an entry
    /// and an exit at most, and a tangent is both. Of a disk they are at the same
    /// parameter, unless the ray runs within its plane.
    fn hits(&self, ray: &ExactRay) -> Vec<TrueHit>;

    /// The first of them.
    ///
    /// # Panics
    /// When the ray is not valid ([`Ray::is_valid`]).
    fn first_hit(&self, ray: &Ray) -> Option<TrueHit> {
        self.hits(&ExactRay::new(ray)).into_iter().next()
    }

    /// The least change, the same relative change for every number of the case, after which
    /// the first hit may be another. Events that are out of the ray's range count too, so that
    /// it is a lower bound.
    ///
    /// # Panics
    /// When the ray is not valid.
    fn gap(&self, ray: &Ray) -> f64;

    /// The unit vector out of the solid at a hit of `ray`; `None` at an apex without a
    /// disk. That of a disk is the one it is stated with.
    ///
    /// A hit's `t` is rounded, far beyond f64: what is nearer to the apex than 2^-500 of the
    /// way there is at it.
    fn outward_normal(&self, ray: &Ray, hit: &TrueHit) -> Option<DVec3>;

    /// Whether the closed solid contains a point.
    ///
    /// # Panics
    /// When the point is not finite.
    fn truly_contains(&self, point: DVec3) -> bool;
}

/// The truth about a solid of any kind.
#[must_use]
pub fn truth(solid: &AnySolid) -> &dyn TrueSolid {
    with_solid!(solid, solid => solid)
}

/// As [`TrueSolid::first_hit`].
///
/// # Panics
/// When the ray is not valid.
#[must_use]
pub fn first_hit_of_any(solid: &AnySolid, ray: &Ray) -> Option<TrueHit> {
    truth(solid).first_hit(ray)
}

/// As [`TrueSolid::hits`].
///
/// # Panics
/// When the ray is not valid.
#[must_use]
pub fn hits_of_any(solid: &AnySolid, ray: &Ray) -> Vec<TrueHit> {
    truth(solid).hits(&ExactRay::new(ray))
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
    truth(solid).hits(&ExactRay::through(world_from_object, ray))
}

/// As [`TrueSolid::gap`].
///
/// # Panics
/// When the ray is not valid.
#[must_use]
pub fn gap_of_any(solid: &AnySolid, ray: &Ray) -> f64 {
    truth(solid).gap(ray)
}

/// As [`TrueSolid::outward_normal`].
#[must_use]
pub fn outward_normal_of_any(solid: &AnySolid, ray: &Ray, hit: &TrueHit) -> Option<DVec3> {
    truth(solid).outward_normal(ray, hit)
}

/// The way from a point to a hit.
pub(super) fn from_point(point: DVec3, ray: &Ray, hit: &TrueHit) -> ExactVector {
    let x = &ExactVector::new(ray.origin) - &ExactVector::new(point);
    &x + &ExactVector::new(ray.direction).times(&hit.t)
}

/// Whether a hit is at an end whose radius is zero.
pub(super) fn is_at_apex(ends: [DVec3; 2], radii: [f64; 2], ray: &Ray, hit: &TrueHit) -> bool {
    ends.into_iter().zip(radii).any(|(point, radius)| {
        let off = from_point(point, ray, hit);
        let way = ExactVector::new(ray.direction).times(&hit.t);
        let near = exact(power_of_two(-500));
        radius == 0.0 && off.dot(&off) <= way.dot(&way) * &near * &near
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::math::Orientation;
    use cyltrace::solid::{Caps, Cone, Cuboid, Disk, Part, RoundedCone, Sphere};

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
