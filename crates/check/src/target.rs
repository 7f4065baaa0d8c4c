//! A placed solid as something to aim rays at.
//!
//! All solids are seen as round an axis: between a bottom and a top, at each height
//! there is a radius in every direction from the axis, and the wall has a normal there.
//! What is aimed at a wall, a rim or an axis is then the same for all.

use glam::DVec3;

use super::bounding_meshes::window::PlacedSolid;
use cyltrace::math::Random;
use cyltrace::solid::{AnySolid, Cuboid, RoundedCone};

/// A solid in the world, as rays are aimed at it.
pub(super) struct Target<'a> {
    placed: &'a PlacedSolid,
    outline: Outline,
}

/// A solid in its own space, about an axis.
struct Outline {
    /// Where the axis starts.
    bottom: DVec3,
    axis: DVec3,
    across: [DVec3; 2],
    /// Of the axis, from bottom to top.
    length: f64,
    /// The greatest.
    radius: f64,
    wall: Wall,
}

/// The radius by height.
enum Wall {
    /// From the one at the bottom to the one at the top, evenly.
    Cone([f64; 2]),
    /// Of the sphere between bottom and top.
    Sphere,
    /// With the height of its `p0` above the bottom.
    RoundedCone(RoundedCone, f64),
    /// Half of the widths along both directions across.
    Cuboid([f64; 2]),
}

impl Outline {
    fn new(solid: &AnySolid) -> Self {
        let between = |p0: DVec3, p1: DVec3, radii: [f64; 2]| {
            let length = (p1 - p0).length();
            Self::about(p0, (p1 - p0) / length, length, radii, Wall::Cone(radii))
        };
        match solid {
            AnySolid::Cylinder(one) => between(one.p0(), one.p1(), [one.radius(); 2]),
            AnySolid::Cone(one) => between(one.p0(), one.p1(), [one.radius0(), one.radius1()]),
            AnySolid::Disk(one) => {
                let radii = [one.radius(); 2];
                let axis = one.normal().normalize();
                Self::about(one.center(), axis, 0.0, radii, Wall::Cone(radii))
            }
            AnySolid::Sphere(one) => {
                let radius = one.radius();
                let bottom = one.center() - DVec3::Z * radius;
                Self::about(bottom, DVec3::Z, 2.0 * radius, [radius; 2], Wall::Sphere)
            }
            AnySolid::RoundedCone(one) => Self::of_rounded_cone(one),
            AnySolid::Cuboid(one) => Self::of_cuboid(one),
        }
    }

    fn about(bottom: DVec3, axis: DVec3, length: f64, radii: [f64; 2], wall: Wall) -> Self {
        let (one, other) = axis.any_orthonormal_pair();
        Self {
            bottom,
            axis,
            across: [one, other],
            length,
            radius: radii[0].max(radii[1]),
            wall,
        }
    }

    fn of_rounded_cone(cone: &RoundedCone) -> Self {
        let between = cone.p1() - cone.p0();
        let axis = between.try_normalize().unwrap_or(DVec3::Z);
        let (radius0, radius1) = (cone.radius0(), cone.radius1());
        let bottom = (-radius0).min(between.length() - radius1);
        let top = radius0.max(between.length() + radius1);
        let wall = Wall::RoundedCone(*cone, -bottom);
        let start = cone.p0() + axis * bottom;
        Self::about(start, axis, top - bottom, [radius0, radius1], wall)
    }

    fn of_cuboid(cuboid: &Cuboid) -> Self {
        let frame = cuboid.orientation().world_from_object();
        let half = cuboid.half_widths();
        Self {
            bottom: cuboid.center() - frame.z_axis * half.z,
            axis: frame.z_axis,
            across: [frame.x_axis, frame.y_axis],
            length: 2.0 * half.z,
            radius: half.x.max(half.y),
            wall: Wall::Cuboid([half.x, half.y]),
        }
    }

    /// The radius and the outward normal of the wall at a height, in a direction from the
    /// axis. Below the bottom and above the top it is as it is there.
    fn wall(&self, height: f64, outward: DVec3) -> (f64, DVec3) {
        let height = height.clamp(0.0, self.length);
        match &self.wall {
            Wall::Cone([radius0, radius1]) => {
                if radius0 == radius1 {
                    return (*radius0, outward);
                }
                let slope = (radius1 - radius0) / self.length;
                let normal = (outward - self.axis * slope).normalize();
                (radius0 + slope * height, normal)
            }
            Wall::Sphere => self.sphere(height - self.radius, self.radius, outward),
            Wall::RoundedCone(cone, start) => self.rounded_wall(cone, height - start, outward),
            Wall::Cuboid(half_widths) => {
                let along = self.across.map(|axis| outward.dot(axis));
                let reach = [0, 1].map(|i| half_widths[i] / along[i].abs());
                let first = usize::from(reach[1] < reach[0]);
                (reach[first], self.across[first] * along[first].signum())
            }
        }
    }

    /// A sphere's, at a height from its center.
    fn sphere(&self, height: f64, radius: f64, outward: DVec3) -> (f64, DVec3) {
        let across = ((radius - height) * (radius + height)).max(0.0).sqrt();
        (across, (outward * across + self.axis * height) / radius)
    }

    /// A rounded cone's, at a height from `p0`: of the spheres and the wall that touches
    /// them, what is farthest out.
    fn rounded_wall(&self, cone: &RoundedCone, height: f64, outward: DVec3) -> (f64, DVec3) {
        let length = (cone.p1() - cone.p0()).length();
        let (radius0, radius1) = (cone.radius0(), cone.radius1());
        let sine = (radius1 - radius0) / length;
        let seams = [-radius0 * sine, length - radius1 * sine];
        if sine.abs() < 1.0 && (seams[0]..=seams[1]).contains(&height) {
            let cosine = (1.0 - sine * sine).sqrt();
            let radius = (radius0 + sine * height) / cosine;
            return (radius, outward * cosine - self.axis * sine);
        }
        let spheres = [(height, radius0), (height - length, radius1)];
        let spheres = spheres.map(|(height, radius)| self.sphere(height, radius, outward));
        let first = usize::from(spheres[1].0 > spheres[0].0);
        spheres[first]
    }

    fn point(&self, height: f64, off: DVec3) -> DVec3 {
        self.bottom + self.axis * height + off
    }

    /// A unit vector across the axis.
    fn outward(&self, random: &mut Random) -> DVec3 {
        let (sin, cos) = libm::sincos(random.unit() * std::f64::consts::TAU);
        self.across[0] * cos + self.across[1] * sin
    }

    /// A random point of the solid.
    fn any_point(&self, random: &mut Random) -> DVec3 {
        let outward = self.outward(random);
        let radii = random.unit().sqrt();
        let height = self.length * random.unit();
        self.point_within(height, outward, radii)
    }

    /// The point at a height, so many radii of the wall there from the axis.
    fn point_within(&self, height: f64, outward: DVec3, radii: f64) -> DVec3 {
        let (radius, _) = self.wall(height, outward);
        self.point(height, outward * (radius * radii))
    }

    /// A vector that is tangential to the wall at a height: around, and some `up`.
    fn tangent(&self, height: f64, outward: DVec3, around: f64, up: f64) -> DVec3 {
        let (_, normal) = self.wall(height, outward);
        let along = self.axis - normal * self.axis.dot(normal);
        normal.cross(self.axis) * around + along * up
    }
}

/// A random point of a solid, in its own space.
pub(super) fn any_point_of(solid: &AnySolid, random: &mut Random) -> DVec3 {
    Outline::new(solid).any_point(random)
}

impl<'a> Target<'a> {
    pub fn new(placed: &'a PlacedSolid) -> Self {
        Self {
            placed,
            outline: Outline::new(&placed.solid),
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

    /// About the size in the world.
    pub fn size(&self) -> f64 {
        let Outline {
            axis,
            across,
            length,
            radius,
            ..
        } = &self.outline;
        self.world_vector(*axis * *length).length()
            + self.world_vector(across[0] * *radius).length()
    }

    /// A random point of the solid, in the world.
    pub fn any_point(&self, random: &mut Random) -> DVec3 {
        self.world_point(self.outline.any_point(random))
    }

    /// A random point of a solid a quarter thicker and longer, in the world.
    /// What is aimed at points of the solid itself hardly ever passes just
    /// beside it, so silhouettes would get too few rays.
    pub fn point_around(&self, random: &mut Random) -> DVec3 {
        let outward = self.outline.outward(random);
        let radii = 1.25 * random.unit().sqrt();
        let height = self.outline.length * random.uniform(-0.125, 1.125);
        self.world_point(self.outline.point_within(height, outward, radii))
    }

    /// From a point inside, a third of the time from next to the wall or an
    /// end, in any direction, along the wall now and then.
    pub fn inside_ray(&self, random: &mut Random) -> (DVec3, DVec3) {
        let Outline { length, radius, .. } = self.outline;
        let outward = self.outline.outward(random);
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
        let origin = self.outline.point_within(height, outward, radii);
        let heading = if random.below(4) == 0 {
            let around = sign(random);
            let up = random.uniform(-2.0, 2.0);
            self.outline.tangent(height, outward, around, up)
        } else {
            random.direction()
        };
        (self.world_point(origin), self.world_vector(heading))
    }

    /// A point beside the wall, and a heading that is tangential there.
    pub fn at_silhouette(&self, random: &mut Random) -> (DVec3, DVec3) {
        let outward = self.outline.outward(random);
        let radii = 1.0 + sign(random) * random.log_uniform(1e-6, 0.1);
        let around = sign(random);
        let up = random.uniform(-2.0, 2.0);
        let height = self.outline.length * random.uniform(-0.02, 1.02);
        let point = self.outline.point_within(height, outward, radii);
        let heading = self.outline.tangent(height, outward, around, up);
        (self.world_point(point), self.world_vector(heading))
    }

    /// A point next to a rim, and any heading.
    pub fn at_rim(&self, random: &mut Random) -> (DVec3, DVec3) {
        let Outline { length, radius, .. } = self.outline;
        let end = if random.below(2) == 0 { 0.0 } else { length };
        let outward = self.outline.outward(random);
        let rim = self.outline.point_within(end, outward, 1.0);
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
        } = self.outline;
        let off = self.outline.outward(random) * (1.2 * radius * random.unit().sqrt());
        let direction = axis * sign(random);
        let away = (length + radius) * random.uniform(0.6, 2.0);
        let middle = self.outline.point(0.5 * length, off);
        let tilt = if random.below(2) == 0 {
            DVec3::ZERO
        } else {
            self.outline.outward(random) * random.log_uniform(1e-9, 1e-2)
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
