//! Where something in a corner is, and how large and in which colors.

use serde::{Deserialize, Serialize};

use super::Overlay;
use super::canvas::Canvas;

/// Space within the edge of an inset, and outside to the picture's edge, in heights of the text.
const PADDING: f32 = 0.6;
const MARGIN: f32 = 0.8;

/// The place and look of what is drawn over a corner of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Inset {
    /// Where it is.
    pub corner: Corner,
    /// The height of its text over the height of the picture, greater than 0.
    pub size: f32,
    /// The color of the text, linear RGB.
    pub color: [f32; 3],
    /// The color behind, linear RGB.
    pub background: [f32; 3],
    /// The opacity of the color behind, in [0, 1].
    pub opacity: f32,
}

/// A corner of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Corner {
    TopLeft,
    TopRight,
    BottomLeft,
    BottomRight,
}

/// Lengths in pixels for a height of the text.
#[derive(Clone, Copy)]
pub(super) struct Unit(pub f32);

impl Unit {
    /// A length in whole pixels, at least 1.
    pub fn pixels(self, length: f32) -> i32 {
        ((length * self.0).round() as i32).max(1)
    }
}

impl Inset {
    /// The height of the text in a picture of a size.
    pub(super) fn unit(&self, (_, height): (u32, u32)) -> Unit {
        Unit(self.size * height as f32)
    }

    /// A canvas for contents of a size in pixels, and the pixel of their left upper corner.
    pub(super) fn canvas(&self, unit: Unit, contents: [i32; 2]) -> (Canvas, [i32; 2]) {
        let padding = unit.pixels(PADDING);
        let size = contents.map(|length| (length + 2 * padding) as u32);
        let canvas = Canvas::new(size, self.background, self.opacity);
        (canvas, [padding; 2])
    }

    /// The canvas in its corner.
    pub(super) fn overlay(&self, unit: Unit, canvas: Canvas, size: (u32, u32)) -> Overlay {
        let margin = unit.pixels(MARGIN) as u32;
        let far = |whole: u32, part: u32| whole.saturating_sub(part + margin);
        let (right, bottom) = (far(size.0, canvas.width), far(size.1, canvas.height()));
        let (left, top) = match self.corner {
            Corner::TopLeft => (margin, margin),
            Corner::TopRight => (right, margin),
            Corner::BottomLeft => (margin, bottom),
            Corner::BottomRight => (right, bottom),
        };
        Overlay {
            left,
            top,
            width: canvas.width,
            pixels: canvas.pixels,
        }
    }

    /// The width that is left for the contents in a picture of a size, in pixels.
    pub(super) fn room(&self, size: (u32, u32)) -> f32 {
        let unit = self.unit(size);
        size.0 as f32 - 2.0 * (unit.pixels(PADDING) + unit.pixels(MARGIN)) as f32
    }
}
