//! Whether a ray may meet a solid, in f64 and without Embree.
//!
//! A solid is in the ball about the middle of its box, and a line that hits one with
//! an axis passes that within its greatest radius. All lengths are lengthened by
//! [`SLACK`] of the numbers they are computed from: the roundings of a ray on its way
//! into a prototype and of the tests are some dozens of 2^-53, times the condition of
//! the placement, which is below 2^10 in scenes that f32 rivals can trace.

use glam::DVec3;

use cyltrace::math::power_of_two;
use cyltrace::solid::AnySolid;

/// By how much tests are made generous.
pub const SLACK: f64 = power_of_two(-30);

/// A ball around a solid or a prototype.
#[derive(Clone, Copy)]
pub struct Ball {
    center: DVec3,
    radius: f64,
}

impl Ball {
    /// Around a solid.
    pub fn of(solid: &AnySolid) -> Self {
        let bounds = solid.bounds();
        Self {
            center: 0.5 * bounds.lower + 0.5 * bounds.upper,
            radius: 0.5 * bounds.extent().length() * (1.0 + SLACK),
        }
    }

    /// The ball about the middle of the centers that contains them all.
    pub fn around(balls: impl Iterator<Item = Self> + Clone) -> Self {
        let (lower, upper) = balls.clone().fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(lower, upper), ball| (lower.min(ball.center), upper.max(ball.center)),
        );
        let center = 0.5 * lower + 0.5 * upper;
        let reach = |ball: Self| (ball.center - center).length() + ball.radius;
        Self {
            center,
            radius: balls.map(reach).fold(0.0, f64::max) * (1.0 + SLACK),
        }
    }
}

/// A ray in one space, with what the tests of it need.
pub struct Sight {
    origin: DVec3,
    /// Of unit length.
    heading: DVec3,
    /// What one unit of length is in `t`.
    rate: f64,
    t_min: f64,
}

impl Sight {
    /// Of a ray with a direction of any length.
    pub fn new(origin: DVec3, direction: DVec3, t_min: f64) -> Self {
        let length = direction.length();
        Self {
            origin,
            heading: direction / length,
            rate: 1.0 / length,
            t_min,
        }
    }

    /// A `t` that is not behind the entry into the ball; `None` if the ray
    /// misses it.
    pub fn enters(&self, ball: &Ball) -> Option<f64> {
        let way = ball.center - self.origin;
        let radius = ball.radius + SLACK * (way.abs().max_element() + ball.radius);
        let along = way.dot(self.heading);
        let aside = (way - self.heading * along).length_squared();
        let is_ahead = (along + radius) * self.rate >= self.t_min;
        (aside <= radius * radius && is_ahead).then_some((along - radius) * self.rate)
    }

    /// Whether the line may pass the axis within the radius; of a solid without an
    /// axis it is not known.
    pub fn nears_axis(&self, solid: &AnySolid) -> bool {
        let (p0, p1) = match solid {
            AnySolid::Cylinder(one) => (one.p0(), one.p1()),
            AnySolid::Cone(one) => (one.p0(), one.p1()),
            AnySolid::RoundedCone(one) => (one.p0(), one.p1()),
            _ => return true,
        };
        let axis = (p1 - p0).normalize();
        let x = self.origin - p0;
        let across = axis.cross(self.heading);
        let radius = solid.radius();
        let reach = radius + SLACK * (x.length() + radius);
        // The sine's own rounding is below the slack as well. A rounded cone whose
        // centers are one point has no axis, but NaN here.
        let is_beside = x.dot(across).abs() > reach * across.length() + SLACK * x.length();
        !is_beside
    }
}

#[cfg(test)]
mod tests {
    use super::super::random_scene::{random_scene, sticks};
    use super::super::rays::random_rays;
    use super::*;
    use cyltrace::math::Bounds;
    use cyltrace::solid::{RoundedCone, SolidKind};
    use cyltrace_oracle::first_hit_of_any;

    #[test]
    fn rays_that_hit_enter_the_ball_and_near_the_axis() {
        const SEED: u64 = 19;
        let kinds = [
            SolidKind::Cone,
            SolidKind::RoundedCone,
            SolidKind::Sphere,
            SolidKind::Cuboid,
            SolidKind::Disk,
        ];
        let others = kinds.map(|kind| random_scene(kind, 30, SEED));
        let cube = Bounds {
            lower: DVec3::ZERO,
            upper: DVec3::ONE,
        };
        let rays = random_rays(&cube, 200, SEED);
        for scene in others.into_iter().chain([sticks(30, SEED)]) {
            let (mut hits, mut left) = (0, 0);
            for (_, solid) in scene.prototypes[0].singles() {
                for ray in &rays {
                    let sight = Sight::new(ray.origin, ray.direction, ray.t_min);
                    let entered = sight.enters(&Ball::of(&solid));
                    let is_left = entered.is_some() && sight.nears_axis(&solid);
                    left += usize::from(is_left);
                    if let Some(hit) = first_hit_of_any(&solid, ray) {
                        hits += 1;
                        assert!(
                            is_left && entered <= Some(hit.t_f64()),
                            "seed {SEED}, {solid:?}, {ray:?}"
                        );
                    }
                }
            }
            // Of 6000 pairs; a candidate is a hit more often than every fifth time.
            assert!(hits > 50 && left < 5 * hits, "{hits} hits of {left} left");
        }
    }

    #[test]
    fn a_rounded_cone_without_an_axis_is_near() {
        let ball = RoundedCone::new(DVec3::ONE, DVec3::ONE, 0.5, 0.25).unwrap();
        let sight = Sight::new(DVec3::ZERO, DVec3::ONE, 0.0);
        assert!(sight.nears_axis(&ball.into()));
    }
}
