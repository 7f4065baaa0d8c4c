//! What exact arithmetic says of a drawn scene.
//!
//! The hits of each placed solid are compared with the oracle's. Where all numbers are
//! whole and nothing is placed, they have to be the same. Elsewhere the tracer answers
//! for a ray that is displaced by its roundings, by at most Δ: per placement
//! `u (1 + 11 κ)` of the way to it (κ the condition of its matrix) and in the solid's own
//! space 32 u of all lengths that the solver sees (`docs/derivations.md`, sections 5 and
//! 6). Hits that are missing, or others, are accepted only if displacing the ray by up to
//! 4 Δ changes the truth as well: by two dozen displacements around it, one of them
//! within 15 degrees of any direction across the ray. Hits beside the true ones are if the
//! ray is within 4 Δ of the surface there.

use cyltrace::math::{Orientation, Ray, UNIT_ROUNDOFF, frobenius_norm, power_of_two};
use cyltrace::solid::{AnySolid, Caps, Crossing, Cylinder, Part};
use cyltrace::tracer::{Containing, Hit};
use cyltrace_oracle::{ExactAffine, TrueHit, placed_hits_of_any, truth};
use glam::{DAffine3, DVec3};

use super::drawn_scene::{DrawnScene, PlacedSolid};

/// The error of a parameter beside that of the ray, as a share of it (`docs/derivations.md`,
/// section 8, point 4).
const PARAMETER_ERROR: f64 = power_of_two(-34);

type Keys = Vec<(Part, Crossing)>;

/// The placed solids of a scene, to be compared with.
pub struct Truth<'a> {
    placed: &'a [PlacedSolid],
}

impl<'a> Truth<'a> {
    /// Of these solids.
    pub fn new(placed: &'a [PlacedSolid]) -> Self {
        Self { placed }
    }

    /// Compares the hits of a whole line.
    ///
    /// # Panics
    /// When a solid is hit where it is not, or not hit where it is.
    pub fn judge(&self, ray: &Ray, hits: &[Hit], drawn: &DrawnScene) {
        for placed in self.placed {
            let found: Vec<&Hit> = (hits.iter())
                .filter(|hit| hit.primitive == placed.primitive && hit.instance == placed.path)
                .collect();
            let truth = placed_hits_of_any(&placed.solid, &placed.world_from_object, ray);
            let keys = found.iter().map(|hit| (hit.part, hit.crossing));
            let keys = comparable(keys, &placed.solid);
            let case = || format!("{found:#?}, truly {truth:?}: {ray:?} {placed:?} {drawn:#?}");
            if keys != placed.keys_of(&truth) {
                let is_exact = placed.is_whole() && are_whole(&[ray.origin, ray.direction]);
                assert!(!is_exact, "wrong hits: {}", case());
                let is_more = found.len() > truth.len() && placed.are_near(ray, &found);
                let is_unsure = is_more || placed.is_unsure(ray, &truth);
                assert!(is_unsure, "wrong hits: {}", case());
                continue;
            }
            for (hit, truth) in found.iter().zip(&truth) {
                placed.judge_hit(ray, hit, truth, &case);
            }
        }
    }

    /// Compares which solids of the root contain a point.
    ///
    /// # Panics
    /// When exact arithmetic disagrees.
    pub fn judge_point(&self, point: DVec3, found: &[Containing], drawn: &DrawnScene) {
        for placed in self.placed.iter().filter(|placed| placed.path.is_empty()) {
            let is_found = (found.iter())
                .any(|one| one.instance.is_empty() && one.primitive == placed.primitive);
            let is_true = truth(&placed.solid).truly_contains(point);
            assert_eq!(
                is_found, is_true,
                "contains {point:?} {placed:?} {drawn:#?}"
            );
        }
    }
}

/// Whether a solid is of whole numbers in the sense of [`are_whole`], and not turned.
pub fn is_whole(solid: &AnySolid) -> bool {
    let numbers = match solid {
        AnySolid::Cylinder(one) => [one.p0(), one.p1(), DVec3::splat(one.radius())],
        AnySolid::Cone(one) => {
            let radii = DVec3::new(one.radius0(), one.radius1(), 0.0);
            [one.p0(), one.p1(), radii]
        }
        AnySolid::RoundedCone(one) => {
            let radii = DVec3::new(one.radius0(), one.radius1(), 0.0);
            [one.p0(), one.p1(), radii]
        }
        AnySolid::Sphere(one) => [one.center(), DVec3::splat(one.radius()), DVec3::ZERO],
        AnySolid::Cuboid(one) if one.orientation() == Orientation::IDENTITY => {
            [one.center(), one.half_widths(), DVec3::ZERO]
        }
        AnySolid::Cuboid(_) => return false,
        AnySolid::Disk(one) => [one.center(), one.normal(), DVec3::splat(one.radius())],
    };
    are_whole(&numbers)
}

/// Whether all numbers are multiples of 1/64 up to 4096, so that the products of
/// differences are exact.
pub fn are_whole(points: &[DVec3]) -> bool {
    let mut numbers = points.iter().flat_map(|point| point.to_array());
    numbers.all(|number| (number * 64.0).fract() == 0.0 && number.abs() <= 4096.0)
}

/// Parts and crossings, as far as roundings leave them. No displacement of a ray makes it
/// go through the apex of a cone, a disk of radius zero. Wall and balls of a rounded cone
/// have the same tangent planes where they meet, and which is which there, also for a ball
/// that touches the other from within, is decided by the last bit of its numbers.
fn comparable(keys: impl Iterator<Item = (Part, Crossing)>, solid: &AnySolid) -> Keys {
    let is_kept = |part| match solid {
        AnySolid::Cone(one) if part == Part::Cap0 => one.radius0() > 0.0,
        AnySolid::Cone(one) if part == Part::Cap1 => one.radius1() > 0.0,
        AnySolid::RoundedCone(_) => is_whole(solid),
        _ => true,
    };
    keys.map(|(part, crossing)| (if is_kept(part) { part } else { Part::Side }, crossing))
        .collect()
}

impl PlacedSolid {
    /// Whether nothing is rounded for a ray of whole numbers.
    fn is_whole(&self) -> bool {
        self.path.is_empty() && is_whole(&self.solid)
    }

    fn keys_of(&self, hits: &[TrueHit]) -> Keys {
        let keys = hits.iter().map(|hit| (hit.part, hit.crossing));
        comparable(keys, &self.solid)
    }

    /// Δ for a ray up to the parameter `t`.
    fn displacement(&self, ray: &Ray, t: f64) -> f64 {
        let (mut origin, mut direction) = (ray.origin, ray.direction);
        let (mut sum, mut stretch) = (0.0, 1.0);
        for level in &self.levels {
            let inverse = level.matrix3.inverse();
            let norm = frobenius_norm(&level.matrix3);
            let condition = norm * frobenius_norm(&inverse);
            let way = (origin - level.translation).length() + t.abs() * direction.length();
            sum += stretch * UNIT_ROUNDOFF * (1.0 + 11.0 * condition) * way;
            stretch *= norm;
            origin = inverse * (origin - level.translation);
            direction = inverse * direction;
        }
        let way = origin.length() + t.abs() * direction.length();
        let sizes = self.solid.anchor().length() + self.solid.size();
        sum + stretch * 32.0 * UNIT_ROUNDOFF * (way + sizes)
    }

    fn size_in_world(&self) -> f64 {
        frobenius_norm(&self.world_from_object.rounded().matrix3) * self.solid.size()
    }

    /// The parameter at which a ray is nearest to the solid's center, about.
    fn nearest_parameter(&self, ray: &Ray) -> f64 {
        let map = self.world_from_object.rounded();
        let way = map.transform_point3(self.solid.center()) - ray.origin;
        (way.length() + self.size_in_world()) / ray.direction.length()
    }

    /// Whether a ray within 4 Δ has other hits than the ray.
    fn is_unsure(&self, ray: &Ray, truth: &[TrueHit]) -> bool {
        let displacement = 4.0 * self.displacement(ray, self.nearest_parameter(ray));
        if self.size_in_world() < displacement || self.is_along_disk(ray, displacement) {
            return true;
        }
        let keys = self.keys_of(truth);
        let along = ray.direction.normalize();
        let [x, y] = {
            let x = along.any_orthonormal_vector();
            [x, along.cross(x)]
        };
        let turns = (0..12).map(|step| cyltrace::math::sin_cos_degrees(30.0 * f64::from(step)));
        let aside = turns.map(|(sin, cos)| x * cos + y * sin);
        let both_ways = aside.chain([along, -along]);
        let mut displaced = both_ways.flat_map(|way| [way, way * 0.25]);
        displaced.any(|way| {
            let moved = DAffine3::from_translation(way * displacement);
            let moved = ExactAffine::new(&moved).after(&self.world_from_object);
            self.keys_of(&placed_hits_of_any(&self.solid, &moved, ray)) != keys
        })
    }

    /// Whether the ray is within 4 Δ of the surface at all hits: what is hit beside the
    /// truth, a corner or an apex maybe, is hit by another ray within Δ.
    fn are_near(&self, ray: &Ray, found: &[&Hit]) -> bool {
        let map = self.world_from_object.rounded();
        let object_from_world = map.inverse();
        let inverse = frobenius_norm(&object_from_world.matrix3);
        found.iter().all(|hit| {
            let point = object_from_world.transform_point3(ray.at(hit.t));
            let surface = self
                .solid
                .surface_point(hit.part, point - self.solid.anchor());
            let displacement = 4.0 * self.displacement(ray, hit.t);
            surface.point.distance(point) <= inverse * displacement
        })
    }

    /// Whether the ray meets a disk's plane at no angle to speak of: displacing the ray
    /// takes it out of the plane, and never into it.
    fn is_along_disk(&self, ray: &Ray, displacement: f64) -> bool {
        let AnySolid::Disk(disk) = &self.solid else {
            return false;
        };
        let matrix = self.world_from_object.rounded().matrix3;
        let inverse = matrix.inverse();
        let way = displacement * frobenius_norm(&inverse);
        let up = disk.normal().normalize_or_zero() * way;
        let (center, radius) = (disk.center(), disk.radius() + way);
        let thick = Cylinder::new(center - up, center + up, radius, Caps::Both);
        thick.is_ok_and(|thick| {
            let thick = AnySolid::from(thick);
            let hits = placed_hits_of_any(&thick, &self.world_from_object, ray);
            // Through both faces it goes at an angle.
            hits.iter().any(|hit| hit.part == Part::Side)
        })
    }

    /// Compares where a hit is: its parameter with the true one, or with those of rays
    /// within 4 Δ where the ray grazes.
    fn judge_hit(&self, ray: &Ray, hit: &Hit, truth: &TrueHit, case: &impl Fn() -> String) {
        let t = truth.t_f64();
        let length = ray.direction.length();
        let displacement = self.displacement(ray, t);
        let off = (hit.t - t).abs() * length;
        let own = t.abs() * length * PARAMETER_ERROR;
        if off <= 4.0 * displacement + own {
            return;
        }
        let slope = ray.direction.dot(hit.normal).abs() / length;
        assert!(
            off * slope <= 4.0 * displacement + own,
            "{off:e} along the ray at a slope of {slope:e}, Δ {displacement:e}: {}",
            case()
        );
    }
}
