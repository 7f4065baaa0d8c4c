//! Families for cones and rounded cones.
//!
//! A case is two ends, two radii and a ray, of which either solid is made: the
//! cone through two discs, or the hull of two balls. Where a ray is aimed at the
//! wall, at its rims or along it, that is the wall of the solid in question.

use glam::DVec3;

use super::Inputs;
use super::aiming::{Aim, sign, valid};
use crate::math::{Random, Ray};
use crate::solid::{Caps, Cone, RoundedCone};

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
    /// 1e-6 to 1e-2 radii long; of balls, one nearly holds the other.
    HugeTaper,
    /// Seen from 1e2 to 1e7 radii away.
    Far,
    /// From within the solid.
    Inside,
    /// From a point of the wall.
    FromWall,
    /// Rays at 1e-7 to 1e-2 to the plane of a disc.
    CapPlane,
    /// All lengths times 1e-20 to 1e20, directions times 1e-10 to 1e10.
    Scale,
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
    pub const ALL: [Self; 16] = [
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

/// A solid as rays are aimed at it.
struct Target {
    p0: DVec3,
    p1: DVec3,
    radius0: f64,
    radius1: f64,
    solid: TaperSolid,
}

impl Target {
    fn axis(&self) -> DVec3 {
        (self.p1 - self.p0).normalize()
    }

    fn radius(&self) -> f64 {
        self.radius0.max(self.radius1)
    }

    fn size(&self) -> f64 {
        (self.p1 - self.p0).length() + self.radius()
    }

    /// A unit vector across the axis.
    fn across(&self, random: &mut Random) -> DVec3 {
        loop {
            let across = self.axis().cross(random.direction());
            if across.length_squared() > 1e-6 {
                return across.normalize();
            }
        }
    }

    /// The point of the wall at a share of the way, and unit vectors: outward,
    /// and along the wall.
    fn wall(&self, share: f64, outward: DVec3) -> [DVec3; 3] {
        let (axis, length) = (self.axis(), (self.p1 - self.p0).length());
        let delta = self.radius1 - self.radius0;
        let (middle, radius) = (self.p0.lerp(self.p1, share), self.radius0 + delta * share);
        match self.solid {
            TaperSolid::Cone => {
                let slant = length.hypot(delta);
                let normal = (outward * length - axis * delta) / slant;
                let along = (axis * length + outward * delta) / slant;
                [middle + outward * radius, normal, along]
            }
            TaperSolid::RoundedCone => {
                let sine = (delta / length).clamp(-1.0, 1.0);
                let cosine = (1.0 - sine * sine).sqrt();
                let normal = outward * cosine - axis * sine;
                [
                    middle + normal * radius,
                    normal,
                    axis * cosine + outward * sine,
                ]
            }
        }
    }

    fn inside(&self, random: &mut Random) -> DVec3 {
        let outward = self.across(random);
        let share = random.uniform(0.02, 0.98);
        let radius = self.radius0 + (self.radius1 - self.radius0) * share;
        let off = outward * (0.95 * radius * random.unit().sqrt());
        self.p0.lerp(self.p1, share) + off
    }

    fn case(&self, ray: Ray) -> Option<TaperCase> {
        let Self {
            p0,
            p1,
            radius0,
            radius1,
            solid,
        } = *self;
        match solid {
            TaperSolid::Cone => drop(Cone::new(p0, p1, radius0, radius1, Caps::Both).ok()?),
            TaperSolid::RoundedCone => drop(RoundedCone::new(p0, p1, radius0, radius1).ok()?),
        }
        Some(TaperCase {
            p0,
            p1,
            radius0,
            radius1,
            ray,
        })
    }
}

/// A small whole number, of either sign.
fn whole(random: &mut Random, greatest: u64) -> f64 {
    random.below(2 * greatest + 1) as f64 - greatest as f64
}

fn whole_vector(random: &mut Random, greatest: u64) -> DVec3 {
    DVec3::new(
        whole(random, greatest),
        whole(random, greatest),
        whole(random, greatest),
    )
}

/// The case, or that with its ends exchanged.
fn either_way(random: &mut Random, case: TaperCase) -> TaperCase {
    if random.below(2) == 0 {
        return case;
    }
    TaperCase {
        p0: case.p1,
        p1: case.p0,
        radius0: case.radius1,
        radius1: case.radius0,
        ray: case.ray,
    }
}

/// A ray exactly through the apex: it starts a whole number of directions before.
fn through_apex(random: &mut Random) -> Option<TaperCase> {
    let [apex, a, d] = std::array::from_fn(|_| whole_vector(random, 200));
    let radius = random.below(300) as f64 + 1.0;
    let ray = valid(apex - d * (random.below(50) as f64 + 1.0), d)?;
    let case = TaperCase {
        p0: apex,
        p1: apex + a,
        radius0: 0.0,
        radius1: radius,
        ray,
    };
    (a != DVec3::ZERO).then(|| either_way(random, case))
}

/// A ray in a plane that touches the wall along a line; half of them along that
/// line itself, one in sixteen of these an ulp beside it.
///
/// The axis is along z, and the half-plane of the line is turned by the angle of a
/// Pythagorean triple, so that all its points are whole. For balls the half-angle
/// of the cone is one of a triple as well.
fn tangent_plane(random: &mut Random, solid: TaperSolid) -> Option<TaperCase> {
    const TRIPLES: [[f64; 3]; 4] = [
        [3.0, 4.0, 5.0],
        [4.0, 3.0, 5.0],
        [5.0, 12.0, 13.0],
        [8.0, 15.0, 17.0],
    ];
    let [u, v, unit] = TRIPLES[random.below(4) as usize];
    let (outward, flat) = (DVec3::new(u, v, 0.0), DVec3::new(-v, u, 0.0));
    let (few, steps) = (random.below(20) as f64, random.below(20) as f64 + 1.0);
    let (length, radius0, radius1, start, way) = match solid {
        TaperSolid::Cone => {
            let other = random.below(20) as f64;
            let way = outward * (other - few) + DVec3::Z * steps;
            (steps, few * unit, other * unit, outward * few, way)
        }
        TaperSolid::RoundedCone => {
            let [sine, cosine, whole] = TRIPLES[random.below(4) as usize];
            let (normal, part) = (
                outward * cosine - DVec3::Z * (sine * unit),
                whole * whole * unit,
            );
            let way = normal * sine + DVec3::Z * part;
            let (radius0, radius1) = (few * unit * whole, (few + steps * sine) * unit * whole);
            (steps * part, radius0, radius1, normal * few, way)
        }
    };
    if radius0 == radius1 {
        return None;
    }
    let aside = if random.below(2) == 0 {
        0.0
    } else {
        whole(random, 9)
    };
    let d = (way * (random.below(5) as f64) + flat * aside) * sign(random);
    let through = start + way * whole(random, 30);
    let beside = if random.below(16) == 0 {
        DVec3::X * f64::from(f32::EPSILON)
    } else {
        DVec3::ZERO
    };
    let ray = valid(through - d * (random.below(9) as f64) + beside, d)?;
    let case = TaperCase {
        p0: DVec3::ZERO,
        p1: DVec3::Z * length,
        radius0,
        radius1,
        ray,
    };
    Some(either_way(random, case))
}
