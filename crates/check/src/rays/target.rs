//! A placed solid as a target of rays.
//!
//! Every solid has an outline about an axis: between a bottom and a top, at each height,
//! the wall has a distance from the axis and a normal in every direction.
//! So rays are aimed at walls, rims and axes in the same way for all kinds.

use glam::DVec3;

use crate::bounding_meshes::window::PlacedSolid;
use crate::solids::outline::Outline;
use crate::solids::{Shape, shape};
use cyltrace::math::Random;
use cyltrace::solid::AnySolid;

/// A solid in the world, as rays are aimed at it.
pub(super) struct Target<'a> {
    placed: &'a PlacedSolid,
    figure: Figure,
}

/// A shape with its outline.
struct Figure {
    shape: Shape,
    outline: Outline,
}

impl Figure {
    fn new(solid: &AnySolid) -> Self {
        let shape = shape(solid);
        let outline = shape.get().outline();
        Self { shape, outline }
    }

    /// The radius and the outward normal of the wall at a height, in a direction from the
    /// axis. Below the bottom and above the top they are as there.
    fn wall(&self, height: f64, outward: DVec3) -> (f64, DVec3) {
        let outline = &self.outline;
        let height = height.clamp(0.0, outline.length);
        self.shape.get().wall(outline, height, outward)
    }

    /// A unit vector across the axis.
    fn outward(&self, random: &mut Random) -> DVec3 {
        let (sin, cos) = libm::sincos(random.unit() * std::f64::consts::TAU);
        self.outline.across[0] * cos + self.outline.across[1] * sin
    }

    /// A random point of the solid.
    fn any_point(&self, random: &mut Random) -> DVec3 {
        let outward = self.outward(random);
        let radii = random.unit().sqrt();
        let height = self.outline.length * random.unit();
        self.point_within(height, outward, radii)
    }

    /// The point at a height, at `radii` times the wall's distance from the axis.
    fn point_within(&self, height: f64, outward: DVec3, radii: f64) -> DVec3 {
        let (radius, _) = self.wall(height, outward);
        self.outline.point(height, outward * (radius * radii))
    }

    /// A vector that is tangential to the wall at a height: around, and some `up`.
    fn tangent(&self, height: f64, outward: DVec3, around: f64, up: f64) -> DVec3 {
        let (_, normal) = self.wall(height, outward);
        let axis = self.outline.axis;
        let along = axis - normal * axis.dot(normal);
        normal.cross(axis) * around + along * up
    }
}

/// A random point of a solid, in its own space.
pub(super) fn any_point_of(solid: &AnySolid, random: &mut Random) -> DVec3 {
    Figure::new(solid).any_point(random)
}

impl<'a> Target<'a> {
    pub fn new(placed: &'a PlacedSolid) -> Self {
        Self {
            placed,
            figure: Figure::new(&placed.solid),
        }
    }

    fn world_point(&self, object: DVec3) -> DVec3 {
        self.placed.frame.world_from_object.transform_point3(object)
    }

    fn world_vector(&self, object: DVec3) -> DVec3 {
        self.placed
            .frame
            .world_from_object
            .transform_vector3(object)
    }

    /// The approximate size in the world.
    pub fn size(&self) -> f64 {
        let Outline {
            axis,
            across,
            length,
            radius,
            ..
        } = &self.figure.outline;
        self.world_vector(*axis * *length).length()
            + self.world_vector(across[0] * *radius).length()
    }

    /// A random point of the solid, in the world.
    pub fn any_point(&self, random: &mut Random) -> DVec3 {
        self.world_point(self.figure.any_point(random))
    }

    /// A random point of a solid a quarter thicker and longer, in the world.
    /// Rays to points of the solid itself hardly ever pass just
    /// beside it, so silhouettes would get too few of them.
    pub fn point_around(&self, random: &mut Random) -> DVec3 {
        let outward = self.figure.outward(random);
        let radii = 1.25 * random.unit().sqrt();
        let height = self.figure.outline.length * random.uniform(-0.125, 1.125);
        self.world_point(self.figure.point_within(height, outward, radii))
    }

    /// From a point inside, a third of the time from next to the wall or an
    /// end, in any direction, along the wall now and then.
    pub fn inside_ray(&self, random: &mut Random) -> (DVec3, DVec3) {
        let Outline { length, radius, .. } = self.figure.outline;
        let outward = self.figure.outward(random);
        let mut radii = random.unit().sqrt();
        let mut height = length * random.unit();
        if random.below(3) == 0 {
            // From deep within the chord error of any prism to about that of 8 sides.
            let gap = sign(random) * random.log_uniform(1e-6, 0.1);
            if random.below(2) == 0 {
                radii = 1.0 - gap;
            } else {
                height = gap * radius.min(length);
                if random.below(2) == 0 {
                    height = length - height;
                }
            }
        }
        let origin = self.figure.point_within(height, outward, radii);
        let heading = if random.below(4) == 0 {
            let around = sign(random);
            let up = random.uniform(-2.0, 2.0);
            self.figure.tangent(height, outward, around, up)
        } else {
            random.direction()
        };
        (self.world_point(origin), self.world_vector(heading))
    }

    /// A point beside the wall, and a heading that is tangential there.
    pub fn at_silhouette(&self, random: &mut Random) -> (DVec3, DVec3) {
        let outward = self.figure.outward(random);
        let radii = 1.0 + sign(random) * random.log_uniform(1e-6, 0.1);
        let around = sign(random);
        let up = random.uniform(-2.0, 2.0);
        let height = self.figure.outline.length * random.uniform(-0.02, 1.02);
        let point = self.figure.point_within(height, outward, radii);
        let heading = self.figure.tangent(height, outward, around, up);
        (self.world_point(point), self.world_vector(heading))
    }

    /// A point next to a rim, and any heading.
    pub fn at_rim(&self, random: &mut Random) -> (DVec3, DVec3) {
        let Outline { length, radius, .. } = self.figure.outline;
        let end = if random.below(2) == 0 { 0.0 } else { length };
        let outward = self.figure.outward(random);
        let rim = self.figure.point_within(end, outward, 1.0);
        let near = random.direction() * (radius * random.log_uniform(1e-6, 0.1));
        (
            self.world_point(rim + near),
            self.world_vector(random.direction()),
        )
    }

    /// Parallel to the axis, or nearly, through or past the ends.
    pub fn along_axis(&self, random: &mut Random) -> (DVec3, DVec3) {
        let Outline {
            axis,
            length,
            radius,
            ..
        } = self.figure.outline;
        let off = self.figure.outward(random) * (1.2 * radius * random.unit().sqrt());
        let direction = axis * sign(random);
        let away = (length + radius) * random.uniform(0.6, 2.0);
        let middle = self.figure.outline.point(0.5 * length, off);
        let tilt = if random.below(2) == 0 {
            DVec3::ZERO
        } else {
            self.figure.outward(random) * random.log_uniform(1e-9, 1e-2)
        };
        (
            self.world_point(middle - direction * away),
            self.world_vector(direction + tilt),
        )
    }
}

/// 1 or -1.
fn sign(random: &mut Random) -> f64 {
    if random.below(2) == 0 { 1.0 } else { -1.0 }
}
