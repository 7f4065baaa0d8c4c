//! The cylinders of the families.
//!
//! All are drawn alike: a radius, a length in radii and a distance from the
//! scene's origin, each log-uniform within the limits that make a family.

use crate::math::Random;
use crate::solid::{Caps, Cylinder};

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
    /// The discs.
    pub caps: Caps,
}

/// How far a cylinder's middle is from the scene's origin.
#[derive(Clone, Copy, Debug)]
pub(super) enum Offset {
    /// In sizes of the cylinder, length and radius together.
    Sizes([f64; 2]),
    /// In radii.
    Radii([f64; 2]),
    /// It is the origin: the ends are rounded, the middle is not.
    None,
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
            Offset::None => 0.0,
        };
        let middle = random.direction() * offset;
        let half_axis = random.direction() * (length / 2.0);
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
