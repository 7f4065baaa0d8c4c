//! The legend of a data color: a bar with round numbers for a range, squares with names for
//! categories.

use serde::{Deserialize, Serialize};

use super::canvas::Canvas;
use super::inset::{Inset, Unit};
use super::ticks::ticks;
use super::{Overlay, font};

/// Heights of the title, of the bar and of a line with a category, all lengths in heights of
/// the text.
const TITLE: f32 = 1.15;
const BAR: f32 = 9.0;
const LINE: f32 = 1.3;
/// The width of the bar and of a category's square.
const SWATCH: f32 = 0.9;
/// Space between its parts.
const GAP: f32 = 0.4;
/// The length and width of the line beside a number.
const TICK: f32 = 0.25;
const STROKE: f32 = 0.07;
/// The most steps between numbers beside the bar.
const MOST_STEPS: u32 = 5;

/// A legend.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Legend {
    /// The line above it; none if empty.
    pub title: String,
    /// Its place and look.
    pub inset: Inset,
    /// What it shows.
    pub scale: Scale,
}

/// What a legend shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Scale {
    /// A range of numbers.
    Range {
        /// The numbers of the first and last color, the first less than the second.
        #[serde(with = "exact")]
        ends: [f64; 2],
        /// Linear RGB at even steps from the first to the last, at least one.
        colors: Vec<[f32; 3]>,
    },
    /// Categories with their colors, linear RGB.
    Categories(Vec<([f32; 3], String)>),
}

/// Numbers as texts, because a JSON parser may be off by a rounding.
mod exact {
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    pub fn serialize<S: Serializer>(numbers: &[f64; 2], to: S) -> Result<S::Ok, S::Error> {
        numbers.map(|number| format!("{number:?}")).serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 2], D::Error> {
        let [first, last] = <[String; 2]>::deserialize(from)?;
        let number = |text: String| text.parse().map_err(D::Error::custom);
        Ok([number(first)?, number(last)?])
    }
}

impl Legend {
    /// The legend for a picture of this size.
    #[must_use]
    pub fn overlay(&self, size: (u32, u32)) -> Overlay {
        let (unit, color) = (self.inset.unit(size), self.inset.color);
        let title = match self.title.is_empty() {
            true => 0,
            false => unit.pixels(TITLE + GAP),
        };
        let labels = self.labels(unit);
        let texts = labels.iter().map(|label| font::length(&label.text, unit.0));
        let beside = unit.pixels(SWATCH) + unit.pixels(TICK) + unit.pixels(GAP);
        let widest = beside as f32 + texts.fold(0.0, f32::max);
        let widest = widest.max(font::length(&self.title, TITLE * unit.0));
        let content = match &self.scale {
            Scale::Range { .. } => unit.pixels(BAR),
            Scale::Categories(list) => unit.pixels(LINE) * list.len() as i32,
        };
        let (mut canvas, [left, top]) = self
            .inset
            .canvas(unit, [widest.ceil() as i32, title + content]);
        let place = [left, top];
        font::draw(&mut canvas, &self.title, TITLE * unit.0, place, color);
        let corner = [left, top + title];
        if let Scale::Range { colors, .. } = &self.scale {
            canvas.fill(corner, [unit.pixels(SWATCH), content], |row| {
                // From the last color at the top to the first.
                let place = 1.0 - (f64::from(row) + 0.5) / f64::from(content);
                colors[((place * colors.len() as f64) as usize).min(colors.len() - 1)]
            });
        }
        for label in &labels {
            label.draw(&mut canvas, corner, unit, color);
        }
        self.inset.overlay(unit, canvas, size)
    }

    /// The texts beside the bar or the squares, from the upper left corner of these.
    fn labels(&self, unit: Unit) -> Vec<Label> {
        match &self.scale {
            Scale::Range { ends, .. } => {
                let height = f64::from(unit.pixels(BAR));
                let at = |number: f64| height * (1.0 - (number - ends[0]) / (ends[1] - ends[0]));
                let ticks = ticks(*ends, MOST_STEPS).into_iter();
                let labels = ticks.map(|(number, text)| Label {
                    middle: at(number).round() as i32,
                    mark: Mark::Tick,
                    text,
                });
                labels.collect()
            }
            Scale::Categories(list) => {
                let line = unit.pixels(LINE);
                let labels = (0..).zip(list).map(|(index, (color, text))| Label {
                    middle: line * index + line / 2,
                    mark: Mark::Square(*color),
                    text: text.clone(),
                });
                labels.collect()
            }
        }
    }
}

/// A text with a mark to its left.
struct Label {
    /// The row of its middle.
    middle: i32,
    mark: Mark,
    text: String,
}

enum Mark {
    /// A line at the right edge of the bar.
    Tick,
    /// A square of a color.
    Square([f32; 3]),
}

impl Label {
    fn draw(&self, canvas: &mut Canvas, [left, top]: [i32; 2], unit: Unit, color: [f32; 3]) {
        let middle = top + self.middle;
        let side = unit.pixels(SWATCH);
        let after = match self.mark {
            Mark::Tick => {
                let (length, stroke) = (unit.pixels(TICK), unit.pixels(STROKE));
                canvas.fill([left + side, middle - stroke / 2], [length, stroke], |_| {
                    color
                });
                side + length
            }
            Mark::Square(of_square) => {
                canvas.fill([left, middle - side / 2], [side; 2], |_| of_square);
                side
            }
        };
        let text_top = middle - (unit.0 / 2.0).round() as i32;
        let text_left = left + after + unit.pixels(GAP);
        font::draw(canvas, &self.text, unit.0, [text_left, text_top], color);
    }
}
