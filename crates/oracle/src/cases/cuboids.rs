//! Cuboids and rays that are hard for them.
//!
//! Half of the cuboids lie along the coordinate axes, a quarter are turned by
//! quarter turns and a quarter by anything. Those along axes stand half of the time
//! on whole numbers, and so do their rays: then an edge or a corner is met to the
//! last bit, which aiming with rounded numbers never does.

use glam::DVec3;

use super::Inputs;
use super::aiming::{Aim, sign, whole};
use super::any::HardCases;
use super::shapes::scale_and_speed;
use cyltrace::math::{Orientation, Random, Ray};
use cyltrace::solid::Cuboid;

/// A family of cuboids and rays that are hard in one way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CuboidFamily {
    /// Seen from 1 to 20 sizes away, through and beside it.
    Uniform,
    /// Aimed at a point of a face.
    Face,
    /// Aimed at a point of an edge, or of its continuation.
    Edge,
    /// Aimed at a corner.
    Corner,
    /// Aimed from corner to corner.
    Diagonal,
    /// Along an own axis.
    Parallel,
    /// Across one own axis, in or next to the plane of a face of it.
    WithinFace,
    /// Seen from 1e2 to 1e7 sizes away.
    Far,
    /// From a point within.
    Inside,
    /// From a point of a face.
    Surface,
    /// Plates and needles: half widths 1e-6 to 1 of each other.
    Thin,
    /// All lengths times 1e-20 to 1e20, directions times 1e-10 to 1e10.
    Scale,
}

impl CuboidFamily {
    /// All families.
    pub const ALL: [Self; 12] = [
        Self::Uniform,
        Self::Face,
        Self::Edge,
        Self::Corner,
        Self::Diagonal,
        Self::Parallel,
        Self::WithinFace,
        Self::Far,
        Self::Inside,
        Self::Surface,
        Self::Thin,
        Self::Scale,
    ];

    /// Case `index`, unless its rounded numbers are no cuboid and ray.
    #[must_use]
    pub fn case(self, seed: u64, index: u64, inputs: Inputs) -> Option<(Cuboid, Ray)> {
        let mut random = Random::new(seed, (0x0C0B << 48) | ((self as u64) << 40) | index);
        let orientation = orientation(&mut random);
        if orientation.is_axis_aligned() && random.below(2) == 0 {
            self.whole_case(&mut random, orientation)
        } else {
            self.rounded_case(&mut random, orientation, inputs)
        }
    }

    fn rounded_case(
        self,
        random: &mut Random,
        orientation: Orientation,
        inputs: Inputs,
    ) -> Option<(Cuboid, Ray)> {
        let (scale, speed) = scale_and_speed(random, self == Self::Scale);
        let least = if self == Self::Thin { 1e-6 } else { 0.1 };
        let half_widths = DVec3::from_array([(); 3].map(|()| random.log_uniform(least, 1.0)));
        let half_widths = inputs.vector(half_widths * scale);
        let size = half_widths.length();
        let center = inputs.vector(random.direction() * (size * random.log_uniform(0.1, 10.0)));
        let cuboid = Cuboid::new(center, half_widths, orientation).ok()?;
        let to_world = |own: DVec3| center + orientation.to_world(own * half_widths);
        let axis = random.below(3) as usize;
        let own = self.target(random, axis);
        let target = to_world(own);
        let heading = match self {
            Self::Diagonal => {
                let other = to_world(other_corner(random, own, axis));
                (other - target).try_normalize()?
            }
            Self::Parallel => orientation.to_world(DVec3::AXES[axis]) * sign(random),
            Self::WithinFace => {
                let mut own = random.direction();
                own[axis] = 0.0;
                orientation.to_world(own.try_normalize()?)
            }
            _ => random.direction(),
        };
        let distance = match self {
            Self::Inside | Self::Surface => 0.0,
            Self::Far => size * random.log_uniform(1e2, 1e7),
            _ => size * random.uniform(1.0, 20.0),
        };
        let aim = Aim::new(target, heading);
        let ray = match self {
            // Aimed anew from its rounded origin, it would leave the plane.
            Self::Parallel | Self::WithinFace | Self::Inside | Self::Surface => {
                aim.unaimed_ray(distance, speed, inputs)
            }
            _ => aim.ray(distance, speed, inputs),
        };
        Some((cuboid, ray?))
    }

    /// The point aimed at, in own coordinates of which the faces are at ±1.
    fn target(self, random: &mut Random, axis: usize) -> DVec3 {
        let mut any =
            |reach: f64| DVec3::from_array([(); 3].map(|()| random.uniform(-reach, reach)));
        let (within, around) = (any(1.0), any(1.5));
        let mut target = corner(random);
        match self {
            Self::Face | Self::Surface => with_axis(within, axis, target[axis]),
            Self::WithinFace => with_axis(around, axis, target[axis]),
            Self::Edge => {
                target[axis] = around[axis];
                target
            }
            Self::Corner | Self::Diagonal => target,
            Self::Inside => within,
            _ => around,
        }
    }

    /// A case in whole numbers small enough for every sum and product to be one.
    fn whole_case(self, random: &mut Random, orientation: Orientation) -> Option<(Cuboid, Ray)> {
        let half_widths = DVec3::from_array([(); 3].map(|()| 1.0 + random.below(6) as f64));
        let center = whole(random, 20);
        let cuboid = Cuboid::new(center, half_widths, orientation).ok()?;
        let axis = random.below(3) as usize;
        let mut own = corner(random) * half_widths;
        let mut heading = whole(random, 4);
        let any = whole(random, 8);
        match self {
            Self::Edge => own[axis] = any[axis],
            Self::Corner => {}
            Self::Diagonal => {
                let other = other_corner(random, own, axis);
                heading = (other * half_widths - own) / 2.0;
            }
            Self::Inside => own = any.clamp(-half_widths, half_widths),
            Self::Parallel => {
                own = any;
                heading = DVec3::AXES[axis] * sign(random);
            }
            Self::WithinFace => {
                own = with_axis(any, axis, own[axis]);
                heading[axis] = 0.0;
            }
            Self::Face | Self::Surface => own = with_axis(any, axis, own[axis]),
            _ => own = any,
        }
        let steps = match self {
            Self::Inside | Self::Surface => 0.0,
            Self::Far => 1024.0 * (1.0 + random.below(1024) as f64),
            _ => random.below(8) as f64,
        };
        let ray = Ray::new(
            center + orientation.to_world(own - heading * steps),
            orientation.to_world(heading),
        );
        ray.is_valid().then_some((cuboid, ray))
    }
}

fn orientation(random: &mut Random) -> Orientation {
    let any = Orientation::IDENTITY;
    match random.below(4) {
        0 => any.rotated(random.direction(), random.uniform(-180.0, 180.0)),
        1 => {
            let mut quarters = || 90.0 * random.below(4) as f64;
            any.rotated_x(quarters())
                .rotated_y(quarters())
                .rotated_z(quarters())
        }
        _ => any,
    }
}

fn corner(random: &mut Random) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| sign(random)))
}

/// A corner that is on the other side of an axis than a point.
fn other_corner(random: &mut Random, own: DVec3, axis: usize) -> DVec3 {
    with_axis(corner(random), axis, -own[axis].signum())
}

fn with_axis(mut vector: DVec3, axis: usize, value: f64) -> DVec3 {
    vector[axis] = value;
    vector
}

impl HardCases for Cuboid {
    type Family = CuboidFamily;

    const FAMILIES: &'static [CuboidFamily] = &CuboidFamily::ALL;

    fn draw(family: CuboidFamily, seed: u64, index: u64, inputs: Inputs) -> Option<(Self, Ray)> {
        family.case(seed, index, inputs)
    }
}
