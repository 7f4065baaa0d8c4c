//! The rays of the families: where they start and what they are aimed at.
//!
//! A ray is drawn for a cylinder whose numbers are final. It is aimed in f64,
//! then its origin is rounded, the direction taken from the rounded origin to
//! the target, and rounded too.

use glam::DVec3;

use cyltrace::math::{Random, Ray};
use cyltrace::solid::Cylinder;

use super::Inputs;

/// A cylinder as rays are aimed at it: `axis` is a unit vector.
pub(super) struct Target {
    p0: DVec3,
    along: DVec3,
    axis: DVec3,
    radius: f64,
    length: f64,
}

/// A point and the line through it on which a ray is to lie.
pub(super) struct Aim {
    /// A point of the line, at or near the surface.
    point: DVec3,
    /// Unit vector of the line, in the direction of flight.
    heading: DVec3,
}

impl Target {
    pub fn new(cylinder: &Cylinder) -> Self {
        let along = cylinder.p1() - cylinder.p0();
        let length = along.length();
        Self {
            p0: cylinder.p0(),
            along,
            axis: along / length,
            radius: cylinder.radius(),
            length,
        }
    }

    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Length and radius together.
    pub fn size(&self) -> f64 {
        self.length + self.radius
    }

    /// The angle of the diagonal to the axis, for a long cylinder.
    pub fn slope(&self) -> f64 {
        self.radius / self.length
    }

    /// A unit vector across the axis.
    fn across(&self, random: &mut Random) -> DVec3 {
        loop {
            let across = self.axis.cross(random.direction());
            if across.length_squared() > 1e-6 {
                return across.normalize();
            }
        }
    }

    /// The point at a share of the way from `p0` to `p1`, off the axis.
    fn point(&self, share: f64, off: DVec3) -> DVec3 {
        self.p0 + self.along * share + off
    }

    /// A line in any direction through a point in or around the solid.
    pub fn anywhere(&self, random: &mut Random) -> Aim {
        let off = self.across(random) * (self.radius * random.uniform(0.0, 1.3));
        let point = self.point(random.uniform(-0.05, 1.05), off);
        Aim {
            point,
            heading: random.direction(),
        }
    }

    /// A line that passes the axis at `1 ∓ gap` radii.
    pub fn grazing(&self, random: &mut Random, gap: [f64; 2]) -> Aim {
        let outward = self.across(random);
        let off = 1.0 + sign(random) * random.log_uniform(gap[0], gap[1]);
        let flat = outward.cross(self.axis) * sign(random);
        Aim {
            point: self.point(random.uniform(0.05, 0.95), outward * (self.radius * off)),
            heading: (flat + self.axis * random.uniform(-2.0, 2.0)).normalize(),
        }
    }

    /// A line at `angle` to the axis through a point in the solid.
    pub fn along_axis(&self, random: &mut Random, angle: f64) -> Aim {
        let off = self.across(random) * (self.radius * random.unit().sqrt());
        let point = self.point(random.unit(), off);
        let heading = self.axis * sign(random) + self.across(random) * angle;
        Aim {
            point,
            heading: heading.normalize(),
        }
    }

    /// A line in any direction that passes the edge of a disk at `gap` radii.
    pub fn rim(&self, random: &mut Random, gap: [f64; 2]) -> Aim {
        let outward = self.across(random);
        let share = if random.below(2) == 0 { 0.0 } else { 1.0 };
        let rim = self.point(share, outward * self.radius);
        Aim {
            point: rim + random.direction() * (self.radius * random.log_uniform(gap[0], gap[1])),
            heading: random.direction(),
        }
    }

    /// A line at `angle` to the plane of a disk, through or beside the disk.
    pub fn cap_plane(&self, random: &mut Random, angle: f64) -> Aim {
        let share = if random.below(2) == 0 { 0.0 } else { 1.0 };
        let off = self.across(random) * (self.radius * 1.3 * random.unit().sqrt());
        let heading = self.across(random) + self.axis * (angle * sign(random));
        Aim {
            point: self.point(share, off),
            heading: heading.normalize(),
        }
    }

    /// A line in any direction past the point of the axis that is nearest to
    /// the scene's origin, at up to 1.3 radii.
    pub fn nearest_to_zero(&self, random: &mut Random) -> Aim {
        let heading = random.direction();
        let share = -self.p0.dot(self.axis) / self.length;
        let off = heading.cross(self.axis) * (1.3 * self.radius * random.unit());
        Aim {
            point: self.point(share, off),
            heading,
        }
    }

    /// A ray from a point of the wall into the solid.
    pub fn ray_from_wall(&self, random: &mut Random, inputs: Inputs) -> Option<Ray> {
        let outward = self.across(random);
        let origin = self.point(random.uniform(0.02, 0.98), outward * self.radius);
        let heading = random.direction();
        let inward = if heading.dot(outward) > 0.0 {
            -heading
        } else {
            heading
        };
        valid(inputs.vector(origin), inputs.vector(inward))
    }

    /// A ray in any direction from a point within the solid.
    pub fn ray_from_inside(&self, random: &mut Random, inputs: Inputs) -> Option<Ray> {
        let off = self.across(random) * (self.radius * 0.98 * random.unit().sqrt());
        let origin = self.point(random.uniform(0.02, 0.98), off);
        valid(inputs.vector(origin), inputs.vector(random.direction()))
    }
}

impl Aim {
    /// A line through a point along a unit vector.
    pub fn new(point: DVec3, heading: DVec3) -> Self {
        Self { point, heading }
    }

    /// The ray on the line that starts `distance` before the point, with a
    /// direction of length about `speed`.
    pub fn ray(&self, distance: f64, speed: f64, inputs: Inputs) -> Option<Ray> {
        let origin = inputs.vector(self.point - self.heading * distance);
        let direction = (self.point - origin).normalize() * speed;
        valid(origin, inputs.vector(direction))
    }

    /// The ray that starts there in the line's direction, not aimed anew from its
    /// rounded origin.
    pub fn unaimed_ray(&self, distance: f64, speed: f64, inputs: Inputs) -> Option<Ray> {
        let origin = inputs.vector(self.point - self.heading * distance);
        valid(origin, inputs.vector(self.heading * speed))
    }
}

pub(super) fn valid(origin: DVec3, direction: DVec3) -> Option<Ray> {
    let ray = Ray::new(origin, direction);
    ray.is_valid().then_some(ray)
}

/// 1 or -1.
pub(super) fn sign(random: &mut Random) -> f64 {
    if random.below(2) == 0 { 1.0 } else { -1.0 }
}

/// A whole number up to `greatest` in size.
pub(super) fn whole_number(random: &mut Random, greatest: u64) -> f64 {
    random.below(2 * greatest + 1) as f64 - greatest as f64
}

/// A vector of whole numbers up to `greatest` in size.
pub(super) fn whole(random: &mut Random, greatest: u64) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| whole_number(random, greatest)))
}

/// Three vectors of one whole length at right angles, whole, in any of four tilts.
pub(super) fn whole_frame(random: &mut Random) -> [DVec3; 3] {
    const FRAMES: [[[f64; 3]; 3]; 4] = [
        [[2.0, 2.0, 1.0], [1.0, -2.0, 2.0], [2.0, -1.0, -2.0]],
        [[6.0, 3.0, 2.0], [2.0, -6.0, 3.0], [3.0, -2.0, -6.0]],
        [[4.0, 8.0, 1.0], [4.0, -1.0, -8.0], [-7.0, 4.0, -4.0]],
        [[0.0, 5.0, 0.0], [4.0, 0.0, 3.0], [3.0, 0.0, -4.0]],
    ];
    FRAMES[random.below(4) as usize].map(DVec3::from_array)
}

/// A ray in a direction of whole numbers through a point of whole numbers, at a parameter that
/// mostly is no binary fraction. It is in front of the origin, at it or behind.
pub(super) fn whole_ray_through(random: &mut Random, point: DVec3) -> Option<Ray> {
    const SPEEDS: [f64; 5] = [1.0, 3.0, 5.0, 6.25, 7.0];
    let heading = whole(random, 6);
    let before = random.below(32) as f64 - 4.0;
    let speed = SPEEDS[random.below(5) as usize];
    valid(point - heading * before, heading * speed)
}
