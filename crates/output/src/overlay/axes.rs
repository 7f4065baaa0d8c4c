//! The axes of the world as a camera sees them.

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::inset::Inset;
use super::{Overlay, font};

/// The length of an axis that is seen in full, the width of its line, and the distance of the
/// middle of its name from its end, in heights of the text.
const ARM: f32 = 2.2;
const STROKE: f32 = 0.18;
const NAME: f32 = 0.65;
/// Half of the side of the square that has room for all directions and names.
const HALF: f32 = ARM + NAME + 0.5;

/// x red, y green, z blue, linear RGB: about as dark as each other.
const COLORS: [[f32; 3]; 3] = [[0.75, 0.02, 0.02], [0.01, 0.32, 0.03], [0.03, 0.12, 0.85]];
const NAMES: [&str; 3] = ["x", "y", "z"];

/// The axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axes {
    /// The unit vectors of x, y and z in camera coordinates: to the right, upward, forward.
    pub directions: [[f32; 3]; 3],
    /// Whether they have their names.
    pub labels: bool,
    /// Their place and look.
    pub inset: Inset,
}

impl Axes {
    /// The axes for a picture of a size.
    #[must_use]
    pub fn overlay(&self, size: (u32, u32)) -> Overlay {
        let unit = self.inset.unit(size);
        let side = 2 * unit.pixels(HALF);
        let (mut canvas, [left, top]) = self.inset.canvas(unit, [side; 2]);
        let middle = Vec2::new(left as f32, top as f32) + 0.5 * side as f32;
        let directions = self.directions.map(Vec3::from_array);
        let mut order = [0, 1, 2];
        // The farthest first.
        order.sort_by(|&one, &other| directions[other].z.total_cmp(&directions[one].z));
        for axis in order {
            // Rows are counted downward.
            let seen = directions[axis].truncate() * Vec2::new(1.0, -1.0);
            let end = middle + seen * (ARM * unit.0);
            canvas.line([middle, end], STROKE * unit.0, COLORS[axis]);
            if self.labels {
                // The name of an axis along the view is beside it.
                let aside = seen.try_normalize().filter(|_| seen.length() > 0.1);
                let aside = aside.unwrap_or(Vec2::splat(std::f32::consts::FRAC_1_SQRT_2));
                let place = (end + aside * (NAME * unit.0)).to_array();
                font::draw_around(&mut canvas, NAMES[axis], unit.0, place, self.inset.color);
            }
        }
        self.inset.overlay(unit, canvas, size)
    }
}
