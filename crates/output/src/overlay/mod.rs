//! What is drawn over a finished picture: `legend` lays out the legend of a data color with
//! round numbers from `ticks`, on a `canvas` with text of an embedded `font`.
//!
//! All lengths are in units of the text, so a picture of twice the size has the same legend at
//! twice the size. Edges are on whole pixels, and text is anti-aliased.

mod canvas;
mod font;
mod legend;
mod ticks;

#[cfg(test)]
mod tests;

use std::io;

use crate::{Band, Bands};

pub use legend::{Corner, Legend, Scale};

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

/// The rows of a picture of this width, with an overlay over them if there is one. The first
/// channel is opacity if `has_opacity` says so.
pub fn with_overlay(
    overlay: Option<Overlay>,
    width: u32,
    has_opacity: bool,
    mut bands: impl Bands,
) -> impl Bands {
    let mut row = 0;
    move |band: &mut Band| -> io::Result<()> {
        bands(band)?;
        let Some(overlay) = &overlay else {
            return Ok(());
        };
        let (width, each) = (width as usize, band.words.len() / band.colors.len().max(1));
        for (number, line) in band.colors.chunks_mut(width).enumerate() {
            let words = number * width * each..(number + 1) * width * each;
            let words = has_opacity.then(|| &mut band.words[words]);
            overlay.draw(row, line, words);
            row += 1;
        }
        Ok(())
    }
}
