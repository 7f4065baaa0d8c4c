//! What is drawn over a finished picture: `legend` lays out the legend of a data color with
//! round numbers from `ticks`, `scale_bar` a bar of a known length, and `axes` those of the world,
//! each as an `inset` in a corner, on a `canvas` with text of an embedded `font`.
//!
//! All lengths are in units of the text, so a picture of twice the size has the same legend at
//! twice the size. Edges are on whole pixels but for lengths with a meaning, and text is
//! anti-aliased.

mod axes;
mod canvas;
mod font;
mod inset;
mod legend;
mod scale_bar;
mod ticks;

#[cfg(test)]
mod tests;

use std::io;

use serde::{Deserialize, Serialize};

use crate::{Band, Bands};

pub use axes::Axes;
pub use inset::{Corner, Inset};
pub use legend::{Legend, Scale};
pub use scale_bar::{ScaleBar, ScaleBarError};

/// What is drawn over a picture, each in a corner of its own.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the types say it")]
pub struct Insets {
    pub legend: Option<Legend>,
    pub scale_bar: Option<ScaleBar>,
    pub axes: Option<Axes>,
}

impl Insets {
    /// Those for a picture of a size.
    #[must_use]
    pub fn overlays(&self, size: (u32, u32)) -> Vec<Overlay> {
        let legend = self.legend.iter().map(|legend| legend.overlay(size));
        let scale_bar = self.scale_bar.iter().map(|bar| bar.overlay(size));
        let axes = self.axes.iter().map(|axes| axes.overlay(size));
        legend.chain(scale_bar).chain(axes).collect()
    }
}

/// A rectangle of pixels over a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlay {
    left: u32,
    top: u32,
    width: u32,
    /// Linear RGB times opacity, and opacity, row by row.
    pixels: Vec<[f32; 4]>,
}

impl Overlay {
    /// Draws over a row of the picture, counted from the top. The picture's colors are clamped
    /// to [0, 1] where the overlay covers them, as they are in a PNG. `words` are those of the
    /// row's channels if the first is opacity.
    pub fn draw(&self, row: u32, colors: &mut [[f32; 3]], words: Option<&mut [u32]>) {
        let width = self.width as usize;
        let Some(start) = row.checked_sub(self.top).map(|row| row as usize * width) else {
            return;
        };
        let Some(line) = self.pixels.get(start..start + width) else {
            return;
        };
        let left = self.left as usize;
        if let Some(words) = words {
            let each = words.len() / colors.len();
            let covered = words.chunks_exact_mut(each).skip(left);
            for (words, &[.., opacity]) in covered.zip(line) {
                let below = f32::from_bits(words[0]);
                words[0] = (below * (1.0 - opacity) + opacity).to_bits();
            }
        }
        for (color, &[red, green, blue, opacity]) in colors.iter_mut().skip(left).zip(line) {
            if opacity > 0.0 {
                let over = [red, green, blue];
                *color = std::array::from_fn(|channel| {
                    color[channel].clamp(0.0, 1.0) * (1.0 - opacity) + over[channel]
                });
            }
        }
    }
}

/// The rows of a picture of this width, with overlays over them. The first
/// channel is opacity if `has_opacity` says so.
pub fn with_overlays(
    overlays: Vec<Overlay>,
    width: u32,
    has_opacity: bool,
    mut bands: impl Bands,
) -> impl Bands {
    let mut row = 0;
    move |band: &mut Band| -> io::Result<()> {
        bands(band)?;
        if overlays.is_empty() {
            return Ok(());
        }
        let (width, each) = (width as usize, band.words.len() / band.colors.len().max(1));
        for (number, line) in band.colors.chunks_mut(width).enumerate() {
            let words = number * width * each..(number + 1) * width * each;
            for overlay in &overlays {
                let words = has_opacity.then(|| &mut band.words[words.clone()]);
                overlay.draw(row, line, words);
            }
            row += 1;
        }
        Ok(())
    }
}
