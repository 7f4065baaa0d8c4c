//! A bar that shows a length.
//!
//! Its length is drawn to a part of a pixel, so that it is right at any size of the picture.

use serde::{Deserialize, Serialize};

use super::inset::Inset;
use super::ticks::{number_text, power_of_ten};
use super::{Overlay, font};

/// Space between the text and the bar, and the bar's height, in heights of the text.
const GAP: f32 = 0.2;
const BAR: f32 = 0.25;

/// The share of the picture's width near that of a bar of a round length.
const SHARE: f64 = 0.2;

/// More than the ratio of a number to the nearest round one, √2.5 at most.
const GREATEST_RATIO: f64 = 1.6;

/// A scale bar.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScaleBar {
    /// The text over it.
    pub label: String,
    /// Its length over the height of the picture, greater than 0.
    pub length: f32,
    /// Its place and look.
    pub inset: Inset,
}

/// A bar is longer than the room in the picture.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the bar of length {length} is {times:.3} times as long as the picture has room for: state a length of at most {most}, or none"
)]
pub struct ScaleBarError {
    /// The length.
    pub length: f64,
    /// The bar over the room.
    pub times: f64,
    /// The greatest length that fits, rounded downward.
    pub most: f64,
}

impl ScaleBar {
    /// The bar of a length for a picture of a size that shows a length of 1 with a number of
    /// pixels. `None` is a length of 1, 2 or 5 times a power of ten whose bar is nearest to a
    /// fifth of the picture's width, in ratio.
    ///
    /// # Errors
    /// If a stated length is longer than the picture has room for.
    pub fn new(
        length: Option<f64>,
        unit: &str,
        inset: Inset,
        pixels_per_unit: f64,
        size: (u32, u32),
    ) -> Result<Self, ScaleBarError> {
        let room = f64::from(inset.room(size)).max(1.0);
        if let Some(length) = length.filter(|length| !(length * pixels_per_unit <= room)) {
            return Err(ScaleBarError {
                length,
                times: length * pixels_per_unit / room,
                most: rounded_down(room / pixels_per_unit),
            });
        }
        let length = length.unwrap_or_else(|| {
            let pixels = (SHARE * f64::from(size.0)).min(room / GREATEST_RATIO);
            nearest_round(pixels / pixels_per_unit)
        });
        let pixels = length * pixels_per_unit;
        let number = number_text(length);
        let label = match unit {
            "" => number,
            unit => format!("{number} {unit}"),
        };
        Ok(Self {
            label,
            length: (pixels / f64::from(size.1)) as f32,
            inset,
        })
    }

    /// The bar for a picture of a size.
    #[must_use]
    pub fn overlay(&self, size: (u32, u32)) -> Overlay {
        let (unit, color) = (self.inset.unit(size), self.inset.color);
        let length = self.length * size.1 as f32;
        let width = length.max(font::length(&self.label, unit.0)).ceil() as i32;
        let text = unit.pixels(1.0 + GAP);
        let height = unit.pixels(BAR);
        let (mut canvas, [left, top]) = self.inset.canvas(unit, [width, text + height]);
        let middle = left as f32 + 0.5 * width as f32;
        let text_middle = top as f32 + 0.5 * unit.0;
        font::draw_around(
            &mut canvas,
            &self.label,
            unit.0,
            [middle, text_middle],
            color,
        );
        // The left end is on the edge of a pixel.
        let first = (middle - 0.5 * length).round();
        let bar_top = (top + text) as f32;
        let end = [first + length, bar_top + height as f32];
        canvas.fill_between([first, bar_top], end, color);
        self.inset.overlay(unit, canvas, size)
    }
}

/// Three digits of a positive number that are not above it.
fn rounded_down(number: f64) -> f64 {
    // Rounding to three digits adds at most 0.5 %.
    format!("{:.2e}", number * 0.995).parse().unwrap_or(number)
}

/// The number of 1, 2 or 5 times a power of ten with the ratio nearest to 1.
fn nearest_round(number: f64) -> f64 {
    let exponent = libm::floor(libm::log10(number)) as i32;
    let all = (exponent - 1..=exponent + 1)
        .flat_map(|exponent| [1.0, 2.0, 5.0].map(|digit| digit * power_of_ten(exponent)));
    let ratio = |round: &f64| (round / number).max(number / round);
    all.min_by(|one, other| ratio(one).total_cmp(&ratio(other)))
        .unwrap_or(number)
}
