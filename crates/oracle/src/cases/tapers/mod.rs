//! Families for cones and rounded cones.
//!
//! A case is two ends, two radii and a ray, of which either solid is made: the
//! cone through two disks, or the hull of two balls. Where a ray is aimed at the
//! wall, at its rims or along it, that is the wall of the solid in question.

mod grids;
mod target;

use glam::DVec3;

use super::Inputs;
use super::aiming::{Aim, sign, valid};
use super::any::HardCases;
use cyltrace::math::{Random, Ray};
use cyltrace::solid::{Caps, Cone, RoundedCone};
use grids::{exact_rim, tangent_plane, through_apex};
use target::Target;

/// Which solid a case is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TaperSolid {
    /// [`Cone`].
    Cone,
    /// [`RoundedCone`].
    RoundedCone,
}

/// A family of cases that are hard in one way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TaperFamily {
    /// Ordinary solids seen from 1 to 20 of their sizes away.
    Uniform,
    /// Rays that pass the wall at 1e-7 to 1e-3 radii.
    Graze,
    /// Rays that pass a rim or a seam at 1e-7 to 1e-2 radii.
    Rim,
    /// Rays that pass the apex at 1e-7 to 1e-2 radii.
    Apex,
    /// Rays exactly through the apex; all numbers are multiples of a grid.
    ThroughApex,
    /// Rays at 1e-7 to 1e-1 to the axis.
    AlongAxis,
    /// Rays at 1e-7 to 1e-1 to a line of the wall.
    AlongWall,
    /// Rays exactly within planes that touch the wall or along it, on a grid.
    TangentPlane,
    /// Radii that differ by 1e-7 to 1e-3 of themselves.
    NearEqual,
    /// 1e3 to 1e6 radii long.
    TinyTaper,
    /// 1e-6 to 1e-2 radii long; of balls, one nearly contains the other.
    HugeTaper,
    /// Seen from 1e2 to 1e7 radii away.
    Far,
    /// From within the solid.
    Inside,
    /// From a point of the wall.
    FromWall,
    /// Rays at 1e-7 to 1e-2 to the plane of a disk.
    CapPlane,
    /// All lengths times 1e-20 to 1e20, directions times 1e-10 to 1e10.
    Scale,
    /// Rays exactly through a rim or a seam, in whole numbers, with `t` that no binary number is.
    ExactRim,
}

/// The numbers of a case, each a number of its [`Inputs`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaperCase {
    /// The first end.
    pub p0: DVec3,
    /// The second end.
    pub p1: DVec3,
    /// The radius at `p0`.
    pub radius0: f64,
    /// The radius at `p1`.
    pub radius1: f64,
    /// The ray.
    pub ray: Ray,
}

impl TaperCase {
    /// The cone.
    ///
    /// # Panics
    /// When the numbers are none; a case of [`TaperFamily::case`] for cones has some.
    #[must_use]
    pub fn cone(&self, caps: Caps) -> Cone {
        Cone::new(self.p0, self.p1, self.radius0, self.radius1, caps).expect("a case is a cone")
    }

    /// The rounded cone.
    ///
    /// # Panics
    /// As [`TaperCase::cone`].
    #[must_use]
    pub fn rounded_cone(&self) -> RoundedCone {
        RoundedCone::new(self.p0, self.p1, self.radius0, self.radius1)
            .expect("a case is a rounded cone")
    }
}

impl TaperFamily {
    /// All families, in the order of tables.
    pub const ALL: [Self; 17] = [
        Self::Uniform,
        Self::Graze,
        Self::Rim,
        Self::Apex,
        Self::ThroughApex,
        Self::AlongAxis,
        Self::AlongWall,
        Self::TangentPlane,
        Self::NearEqual,
        Self::TinyTaper,
        Self::HugeTaper,
        Self::Far,
        Self::Inside,
        Self::FromWall,
        Self::CapPlane,
        Self::Scale,
        Self::ExactRim,
    ];

    /// Case `index` of the family; the same for the same arguments.
    #[must_use]
    pub fn case(self, solid: TaperSolid, seed: u64, index: u64, inputs: Inputs) -> TaperCase {
        let kind = (self as u64 * 2 + inputs as u64) * 2 + solid as u64;
        let mut random = Random::new(seed, index | kind << 56);
        loop {
            let drawn = match self {
                Self::ThroughApex => through_apex(&mut random),
                Self::TangentPlane => tangent_plane(&mut random, solid),
                Self::ExactRim => exact_rim(&mut random, solid),
                _ => self.draw(&mut random, solid, inputs),
            };
            if let Some(case) = drawn {
                return case;
            }
        }
    }

    fn draw(self, random: &mut Random, solid: TaperSolid, inputs: Inputs) -> Option<TaperCase> {
        let scale = match self {
            Self::Scale => random.log_uniform(1e-20, 1e20),
            _ => 1.0,
        };
        let radius = random.log_uniform(0.05, 0.5);
        let length = radius * self.length(random, solid);
        let other = self.other_radius(random, radius, length);
        let (radius0, radius1) = if random.below(2) == 0 {
            (radius, other)
        } else {
            (other, radius)
        };
        let middle = random.direction() * ((length + radius) * random.log_uniform(0.1, 3.0));
        let half = random.direction() * (length / 2.0);
        let target = Target {
            p0: inputs.vector((middle - half) * scale),
            p1: inputs.vector((middle + half) * scale),
            radius0: inputs.number(radius0 * scale),
            radius1: inputs.number(radius1 * scale),
            solid,
        };
        let ray = self.ray(random, &target, inputs)?;
        target.case(ray)
    }

    /// In radii.
    fn length(self, random: &mut Random, solid: TaperSolid) -> f64 {
        match (self, solid) {
            (Self::TinyTaper, _) => random.log_uniform(1e3, 1e6),
            (Self::HugeTaper, TaperSolid::Cone) => random.log_uniform(1e-6, 1e-2),
            (Self::HugeTaper, TaperSolid::RoundedCone) => random.log_uniform(1e-2, 1.0),
            _ => random.log_uniform(1.0, 50.0),
        }
    }

    /// The lesser radius.
    fn other_radius(self, random: &mut Random, radius: f64, length: f64) -> f64 {
        match self {
            Self::Apex => 0.0,
            Self::NearEqual => radius * (1.0 - random.log_uniform(1e-7, 1e-3)),
            Self::HugeTaper if length < radius => {
                radius - length * (1.0 - random.log_uniform(1e-7, 1.0))
            }
            _ if random.below(8) == 0 => 0.0,
            _ => radius * random.unit(),
        }
    }

    fn ray(self, random: &mut Random, target: &Target, inputs: Inputs) -> Option<Ray> {
        let (radius, size) = (target.radius(), target.size());
        let distance = match self {
            Self::Far => radius * random.log_uniform(1e2, 1e7),
            Self::AlongAxis | Self::AlongWall | Self::TinyTaper => {
                size * random.log_uniform(1.0, 3.0)
            }
            _ => size * random.log_uniform(1.0, 20.0),
        };
        let speed = match self {
            Self::Scale => random.log_uniform(1e-10, 1e10),
            _ => 1.0,
        };
        let near = |random: &mut Random, point: DVec3, least: f64| {
            point + random.direction() * (radius * random.log_uniform(least, 1e-2))
        };
        let outward = target.across(random);
        let (point, heading) = match self {
            Self::Graze => {
                let share = random.uniform(0.02, 0.98);
                let [on_wall, normal, along] = target.wall(share, outward);
                let off = sign(random) * radius * random.log_uniform(1e-7, 1e-3);
                let heading =
                    normal.cross(along) * sign(random) + along * random.uniform(-2.0, 2.0);
                (on_wall + normal * off, heading)
            }
            Self::Rim => {
                let end = if random.below(2) == 0 { 0.0 } else { 1.0 };
                let [rim, _, _] = target.wall(end, outward);
                (near(random, rim, 1e-7), random.direction())
            }
            Self::Apex => {
                let apex = if target.radius0 == 0.0 {
                    target.p0
                } else {
                    target.p1
                };
                (near(random, apex, 1e-7), random.direction())
            }
            Self::AlongAxis => {
                let off = target.across(random) * random.log_uniform(1e-7, 1e-1);
                (target.inside(random), target.axis() * sign(random) + off)
            }
            Self::AlongWall => {
                let share = random.uniform(0.02, 0.98);
                let [on_wall, _, along] = target.wall(share, outward);
                let off = random.direction() * random.log_uniform(1e-7, 1e-1);
                (near(random, on_wall, 1e-6), along * sign(random) + off)
            }
            Self::CapPlane => {
                let end = if random.below(2) == 0 {
                    target.p0
                } else {
                    target.p1
                };
                let off = target.across(random) * (radius * 1.3 * random.unit().sqrt());
                let angle = sign(random) * random.log_uniform(1e-7, 1e-2);
                (end + off, target.across(random) + target.axis() * angle)
            }
            Self::Inside | Self::FromWall => {
                let origin = if self == Self::Inside {
                    target.inside(random)
                } else {
                    target.wall(random.uniform(0.02, 0.98), outward)[0]
                };
                return valid(inputs.vector(origin), inputs.vector(random.direction()));
            }
            _ => {
                let off = outward * (radius * random.uniform(0.0, 1.3));
                let share = random.uniform(-0.05, 1.05);
                (target.p0.lerp(target.p1, share) + off, random.direction())
            }
        };
        Aim::new(point, heading.normalize()).ray(distance, speed, inputs)
    }
}

/// With all combinations of caps in turn.
impl HardCases for Cone {
    type Family = TaperFamily;

    const FAMILIES: &'static [TaperFamily] = &TaperFamily::ALL;

    fn draw(family: TaperFamily, seed: u64, index: u64, inputs: Inputs) -> Option<(Self, Ray)> {
        let case = family.case(TaperSolid::Cone, seed, index, inputs);
        let caps = [Caps::Both, Caps::None, Caps::P0, Caps::P1][(index % 4) as usize];
        Some((case.cone(caps), case.ray))
    }
}

impl HardCases for RoundedCone {
    type Family = TaperFamily;

    const FAMILIES: &'static [TaperFamily] = &TaperFamily::ALL;

    fn draw(family: TaperFamily, seed: u64, index: u64, inputs: Inputs) -> Option<(Self, Ray)> {
        let case = family.case(TaperSolid::RoundedCone, seed, index, inputs);
        Some((case.rounded_cone(), case.ray))
    }
}
