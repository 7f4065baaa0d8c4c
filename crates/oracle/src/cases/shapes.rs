//! The cylinders of the families, and what spheres, cuboids and disks share.
//!
//! All cylinders are drawn alike: a radius, a length in radii and a distance from the
//! scene's origin, each log-uniform within the limits that make a family.

use glam::DVec3;

use cyltrace::math::Random;
use cyltrace::solid::{Caps, Cylinder};

use super::Inputs;

/// Limits of what is drawn; `[least, greatest]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// Scene units.
    pub radius: [f64; 2],
    /// In radii.
    pub length: [f64; 2],
    /// How far the middle is from the scene's origin.
    pub offset: Offset,
    /// The disks.
    pub caps: Caps,
}

/// How far a cylinder's middle is from the scene's origin.
#[derive(Clone, Copy, Debug)]
pub(super) enum Offset {
    /// In sizes of the cylinder, length and radius together.
    Sizes([f64; 2]),
    /// In radii.
    Radii([f64; 2]),
    /// Up to 0.4 lengths along the axis, which passes the origin.
    Along,
}

impl Shape {
    /// An ordinary cylinder: stout to slender, near the scene's origin.
    pub const ORDINARY: Self = Self {
        radius: [0.05, 0.5],
        length: [1.0, 50.0],
        offset: Offset::Sizes([0.1, 3.0]),
        caps: Caps::Both,
    };

    /// The same with other lengths, in radii.
    pub const fn long(length: [f64; 2]) -> Self {
        Self {
            length,
            ..Self::ORDINARY
        }
    }

    /// A cylinder within the limits, times `scale`; `None` where the rounded
    /// numbers are none, as when both ends round to the same point.
    pub fn draw(&self, random: &mut Random, inputs: Inputs, scale: f64) -> Option<Cylinder> {
        let radius = random.log_uniform(self.radius[0], self.radius[1]);
        let length = radius * random.log_uniform(self.length[0], self.length[1]);
        let offset = match self.offset {
            Offset::Sizes([least, greatest]) => {
                (length + radius) * random.log_uniform(least, greatest)
            }
            Offset::Radii([least, greatest]) => radius * random.log_uniform(least, greatest),
            Offset::Along => length * random.uniform(-0.4, 0.4),
        };
        let way = random.direction();
        let half_axis = match self.offset {
            Offset::Along => way,
            Offset::Sizes(_) | Offset::Radii(_) => random.direction(),
        } * (length / 2.0);
        let middle = way * offset;
        let end = |side: f64| inputs.vector((middle + half_axis * side) * scale);
        Cylinder::new(
            end(-1.0),
            end(1.0),
            inputs.number(radius * scale),
            self.caps,
        )
        .ok()
    }
}

/// The scale of all lengths and the length of directions: 1, or anything for a
/// family of scales.
pub(super) fn scale_and_speed(random: &mut Random, is_any: bool) -> (f64, f64) {
    if !is_any {
        return (1.0, 1.0);
    }
    let scale = random.log_uniform(1e-20, 1e20);
    (scale, random.log_uniform(1e-10, 1e10))
}

/// A center and a radius, of spheres and disks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Round {
    pub center: DVec3,
    pub radius: f64,
}

impl Round {
    /// One at 0.1 to 10 radii from the scene's origin, or at 1e4 to 1e7.
    pub fn draw(random: &mut Random, inputs: Inputs, scale: f64, is_far_off: bool) -> Self {
        let radius = inputs.number(scale * random.log_uniform(0.05, 0.5));
        let offset = if is_far_off {
            random.log_uniform(1e4, 1e7)
        } else {
            random.log_uniform(0.1, 10.0)
        };
        Self {
            center: inputs.vector(random.direction() * (radius * offset)),
            radius,
        }
    }
}
