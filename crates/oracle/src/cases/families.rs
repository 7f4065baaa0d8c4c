//! The families: which cylinders, and which rays at them.
//!
//! Distances are those from a ray's origin to the point it is aimed at.
//! `docs/accuracy.md` lists the families.

use std::str::FromStr;

use super::Inputs;
use super::Problem;
use super::aiming::{Aim, Target, sign, whole, whole_frame, whole_ray_through};
use super::any::HardCases;
use super::shapes::{Offset, Shape};
use super::unknown_family::{UnknownFamily, family_named};
use cyltrace::math::{Random, Ray, power_of_two};
use cyltrace::solid::{Caps, Cylinder};
use glam::DVec3;

/// A family of cases that are hard in one way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Family {
    /// Ordinary cylinders seen from 1 to 20 of their sizes away.
    Nominal,
    /// The same without disks.
    Open,
    /// Seen from 1e2 to 1e7 radii away.
    Far,
    /// 1e3 to 1e6 radii long, seen from up to their length away.
    Thin,
    /// As long, seen from 1 to 10 lengths away.
    ThinFar,
    /// Rays that pass the axis at `1 ∓ 1e-7..1e-3` radii.
    Graze,
    /// Rays at 1e-7 to 1e-1 to the axis.
    NearParallel,
    /// Rays exactly parallel to the axis; one in sixteen along the wall.
    Parallel,
    /// Rays from a point of the wall into the solid.
    SurfaceIn,
    /// Rays from within the solid.
    Inside,
    /// Cylinders 1e4 to 1e7 radii from the scene's origin.
    Offset,
    /// All lengths times 1e-20 to 1e20.
    Scale,
    /// Directions of length 1e-10 to 1e10.
    DirectionScale,
    /// Rays that pass the edge of a disk at 1e-7 to 1e-2 radii.
    Rim,
    /// Rays at 1e-7 to 1e-2 to the plane of a disk, through or beside the disk.
    CapGraze,
    /// Cylinders 1e-6 to 1e-3 radii long.
    Coin,
    /// Radius 2e-5 to 2e-4, 50 to 500 radii long, seen from 0.3 to 3 away.
    Hair,
    /// Rays at up to twice the diagonal's angle to the axis of cylinders of
    /// 1e2 to 1e5 radii.
    Fibre,
    /// The radius is the number nearest to the distance of ray and axis, up
    /// to the rounding of computing that distance in f64; with f64 inputs one
    /// in eight is an exact tangent.
    Tangent,
    /// 1e4 to 1e8 radii long through the scene's origin, seen from 1e2 to 1e3
    /// radii away: an ulp of an end may be more than the radius.
    Cross,
    /// Rays exactly through the edge of a disk, in whole numbers, with `t` that no binary
    /// number is. With f64 inputs all lengths are times a number of 28 bits.
    ExactRim,
}

impl FromStr for Family {
    type Err = UnknownFamily;

    fn from_str(name: &str) -> Result<Self, UnknownFamily> {
        family_named(name, Self::ALL, |family| family.name().to_owned())
    }
}

impl Family {
    /// All families, in the order of tables.
    pub const ALL: [Self; 21] = [
        Self::Nominal,
        Self::Open,
        Self::Far,
        Self::Thin,
        Self::ThinFar,
        Self::Graze,
        Self::NearParallel,
        Self::Parallel,
        Self::SurfaceIn,
        Self::Inside,
        Self::Offset,
        Self::Scale,
        Self::DirectionScale,
        Self::Rim,
        Self::CapGraze,
        Self::Coin,
        Self::Hair,
        Self::Fibre,
        Self::Tangent,
        Self::Cross,
        Self::ExactRim,
    ];

    /// The name on the command line and in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nominal => "nominal",
            Self::Open => "open",
            Self::Far => "far",
            Self::Thin => "thin",
            Self::ThinFar => "thinfar",
            Self::Graze => "graze",
            Self::NearParallel => "nearpar",
            Self::Parallel => "parallel",
            Self::SurfaceIn => "surf_in",
            Self::Inside => "inside",
            Self::Offset => "offset",
            Self::Scale => "scale",
            Self::DirectionScale => "dirscale",
            Self::Rim => "rim",
            Self::CapGraze => "capgraze",
            Self::Coin => "coin",
            Self::Hair => "hair",
            Self::Fibre => "fibre",
            Self::Tangent => "tangent",
            Self::Cross => "cross",
            Self::ExactRim => "exactrim",
        }
    }

    /// Case `index` of the family; the same for the same arguments.
    #[must_use]
    pub fn case(self, seed: u64, index: u64, inputs: Inputs) -> Problem {
        // Families and kinds of inputs are streams far apart: an index stays
        // below 2^56.
        let stream = index | (self as u64 * 2 + inputs as u64) << 56;
        let mut random = Random::new(seed, stream);
        loop {
            let drawn = match self {
                Self::Parallel => parallel(&mut random, inputs),
                Self::Tangent => tangent(&mut random, inputs),
                Self::ExactRim => exact_rim(&mut random, inputs),
                _ => self.draw(&mut random, inputs),
            };
            if let Some(problem) = drawn {
                return problem;
            }
        }
    }

    /// A case, unless its rounded numbers are no cylinder and ray.
    fn draw(self, random: &mut Random, inputs: Inputs) -> Option<Problem> {
        let scale = match self {
            Self::Scale => random.log_uniform(1e-20, 1e20),
            _ => 1.0,
        };
        let cylinder = self.shape().draw(random, inputs, scale)?;
        let target = Target::new(&cylinder);
        let ray = match self {
            Self::SurfaceIn => target.ray_from_wall(random, inputs)?,
            Self::Inside => target.ray_from_inside(random, inputs)?,
            _ => {
                let aim = self.aim(random, &target);
                let distance = self.distance(random, &target);
                let speed = match self {
                    Self::DirectionScale => random.log_uniform(1e-10, 1e10),
                    _ => 1.0,
                };
                aim.ray(distance, speed, inputs)?
            }
        };
        Some(Problem { cylinder, ray })
    }

    fn shape(self) -> Shape {
        match self {
            Self::Open => Shape {
                caps: Caps::None,
                ..Shape::ORDINARY
            },
            Self::Thin | Self::ThinFar => Shape {
                radius: [1e-5, 1e-3],
                offset: Offset::Sizes([0.1, 1.0]),
                ..Shape::long([1e3, 1e6])
            },
            Self::Offset => Shape {
                offset: Offset::Radii([1e4, 1e7]),
                ..Shape::ORDINARY
            },
            Self::Coin => Shape::long([1e-6, 1e-3]),
            Self::Hair => Shape {
                radius: [2e-5, 2e-4],
                offset: Offset::Sizes([0.1, 10.0]),
                ..Shape::long([50.0, 500.0])
            },
            Self::Fibre => Shape {
                radius: [1e-3, 1e-1],
                ..Shape::long([1e2, 1e5])
            },
            Self::Cross => Shape {
                offset: Offset::Along,
                ..Shape::long([1e4, 1e8])
            },
            _ => Shape::ORDINARY,
        }
    }

    fn aim(self, random: &mut Random, target: &Target) -> Aim {
        match self {
            Self::Graze => target.grazing(random, [1e-7, 1e-3]),
            Self::NearParallel => {
                let angle = random.log_uniform(1e-7, 1e-1);
                target.along_axis(random, angle)
            }
            Self::Rim => target.rim(random, [1e-7, 1e-2]),
            Self::CapGraze => {
                let angle = random.log_uniform(1e-7, 1e-2);
                target.cap_plane(random, angle)
            }
            Self::Fibre => {
                let angle = target.slope() * random.uniform(0.0, 2.0);
                target.along_axis(random, angle)
            }
            Self::Cross => target.nearest_to_zero(random),
            _ => target.anywhere(random),
        }
    }

    /// From a ray's origin to the point that it is aimed at.
    fn distance(self, random: &mut Random, target: &Target) -> f64 {
        match self {
            Self::Far => target.radius() * random.log_uniform(1e2, 1e7),
            Self::Thin => target.size() * random.log_uniform(0.1, 1.0),
            Self::ThinFar => target.size() * random.log_uniform(1.0, 10.0),
            Self::Graze => target.radius() * random.log_uniform(2.0, 20.0),
            Self::Hair => random.uniform(0.3, 3.0),
            Self::CapGraze | Self::Offset => target.radius() * random.log_uniform(2.0, 50.0),
            Self::NearParallel | Self::Fibre => target.size() * random.log_uniform(1.0, 3.0),
            Self::Cross => target.radius() * random.log_uniform(1e2, 1e3),
            _ => target.size() * random.log_uniform(1.0, 20.0),
        }
    }
}

/// A ray along the axis, exactly: ends and origin are whole multiples of a
/// grid, and the direction is the axis times a short number, so that nothing
/// rounds. One in sixteen lies within the wall, which is then parallel to an
/// axis of coordinates; with f32 inputs its radius has ten bits, few enough
/// for the squares of f64.
fn parallel(random: &mut Random, inputs: Inputs) -> Option<Problem> {
    // Coordinates below 8: 16 bits for f32, 44 bits for f64.
    let grid = match inputs {
        Inputs::F32 => power_of_two(-12),
        Inputs::F64 => power_of_two(-40),
    };
    let on_grid = |x: f64| (x / grid).round() * grid;
    let point = |random: &mut Random| {
        DVec3::from_array(std::array::from_fn(|_| on_grid(random.uniform(-8.0, 8.0))))
    };
    let on_wall = random.below(16) == 0;
    let (p0, p1) = (point(random), point(random));
    let p1 = if on_wall { p0.with_z(p1.z) } else { p1 };
    let along = p1 - p0;
    let radius = if on_wall {
        let step = match inputs {
            Inputs::F32 => power_of_two(-8),
            Inputs::F64 => grid,
        };
        (random.uniform(0.01, 4.0) / step).ceil() * step
    } else {
        inputs.number(random.log_uniform(0.05, 4.0))
    };
    let cylinder = Cylinder::new(p0, p1, radius, Caps::Both).ok()?;

    let direction = along
        * (sign(random)
            * (1 + random.below(63)) as f64
            * power_of_two(random.below(16) as i32 - 8));
    let before = -direction.normalize() * random.uniform(0.0, 20.0);
    let origin = if on_wall {
        let off = if random.below(2) == 0 {
            DVec3::X
        } else {
            DVec3::Y
        };
        p0 + off * (sign(random) * radius) + DVec3::Z * on_grid(before.z)
    } else {
        let across = along.cross(random.direction()).normalize();
        inputs.vector(p0 + across * (radius * random.uniform(0.0, 1.2)) + before)
    };
    let ray = Ray::new(origin, direction);
    ray.is_valid().then_some(Problem { cylinder, ray })
}

/// A ray next to a tangent of its cylinder.
fn tangent(random: &mut Random, inputs: Inputs) -> Option<Problem> {
    if inputs == Inputs::F64 && random.below(8) == 0 {
        return exact_tangent(random);
    }
    let cylinder = Shape::ORDINARY.draw(random, inputs, 1.0)?;
    let target = Target::new(&cylinder);
    let distance = target.radius() * random.log_uniform(2.0, 20.0);
    let ray = target
        .grazing(random, [1e-7, 1e-3])
        .ray(distance, 1.0, inputs)?;

    // The distance of the two lines is |x·n| / |n|.
    let n = (cylinder.p1() - cylinder.p0()).cross(ray.direction);
    let apart = ((ray.origin - cylinder.p0()).dot(n) / n.length()).abs();
    let cylinder = Cylinder::new(
        cylinder.p0(),
        cylinder.p1(),
        inputs.number(apart),
        Caps::Both,
    )
    .ok()?;
    Some(Problem { cylinder, ray })
}

/// A ray that touches the wall exactly, with numbers of full length: all but
/// the length of the cylinder happens in a plane of coordinates.
fn exact_tangent(random: &mut Random) -> Option<Problem> {
    let length = random.uniform(0.5, 5.0);
    let radius = random.log_uniform(0.05, 0.5);
    let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z * length, radius, Caps::Both).ok()?;
    let heading = DVec3::new(random.uniform(0.2, 1.0), 0.0, random.uniform(-0.5, 0.5));
    let at = DVec3::new(
        0.0,
        radius * sign(random),
        length * random.uniform(0.1, 0.9),
    );
    let origin = (at - heading * random.uniform(1.0, 10.0)).with_y(at.y);
    Some(Problem {
        cylinder,
        ray: Ray::new(origin, heading),
    })
}

/// A ray exactly through a point of an edge, by the triple 3, 4, 5.
fn exact_rim(random: &mut Random, inputs: Inputs) -> Option<Problem> {
    let [x, y, z] = whole_frame(random);
    let times = 1.0 + random.below(3) as f64;
    let p0 = whole(random, 20);
    let axis = z * (1.0 + random.below(12) as f64);
    let off = (x * (3.0 * sign(random)) + y * (4.0 * sign(random))) * times;
    let end = p0 + axis * random.below(2) as f64;
    let ray = whole_ray_through(random, end + off)?;
    if ray.direction.cross(axis) == DVec3::ZERO {
        // Within the wall: `Parallel` has such rays.
        return None;
    }
    let caps = Caps::at(random.below(4) > 0, random.below(4) > 0);
    let scale = match inputs {
        Inputs::F32 => 1.0,
        Inputs::F64 => 1.0 + (2 * random.below(1 << 26) + 1) as f64 * power_of_two(-27),
    };
    let radius = x.length() * 5.0 * times;
    Some(Problem {
        cylinder: Cylinder::new(p0 * scale, (p0 + axis) * scale, radius * scale, caps).ok()?,
        ray: Ray::new(ray.origin * scale, ray.direction * scale),
    })
}

impl HardCases for Cylinder {
    type Family = Family;

    const FAMILIES: &'static [Family] = &Family::ALL;

    /// Those of cylinders have names without the kind.
    fn family_name(family: Family) -> String {
        family.name().to_owned()
    }

    fn draw(family: Family, seed: u64, index: u64, inputs: Inputs) -> Option<(Self, Ray)> {
        let Problem { cylinder, ray } = family.case(seed, index, inputs);
        Some((cylinder, ray))
    }
}
