//! What a picture's file has beside its colors.

use std::io;

use crate::{Display, Film};

/// A number of each pixel beside its color.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// The name in an EXR.
    pub name: &'static str,
    /// What its words are.
    pub numbers: Numbers,
}

impl Channel {
    /// Opacity, from 0 to 1. The colors of a picture with opacity are multiplied by it; those of
    /// its PNG are not.
    pub const OPACITY: Self = Self {
        name: "A",
        numbers: Numbers::F32,
    };
}

/// What the words of a channel are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// The bits of a float.
    F32,
    /// A whole number.
    U32,
}

/// What a picture's file has beside its colors, and how a PNG shows them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contents {
    /// The channels in the order of a pixel's words. A PNG can only have opacity.
    pub channels: Vec<Channel>,
    /// How a PNG shows the colors. An EXR has the colors themselves.
    pub display: Display,
    /// The relative error that was estimated, as the file states it.
    pub error: Option<f32>,
}

impl Contents {
    /// The place of opacity among the channels.
    pub(super) fn opacity(&self) -> Option<usize> {
        let mut channels = self.channels.iter();
        channels.position(|channel| *channel == Channel::OPACITY)
    }

    /// Whether there are channels that a PNG cannot have.
    pub(super) fn need_exr(&self) -> bool {
        let mut channels = self.channels.iter();
        channels.any(|channel| *channel != Channel::OPACITY)
    }
}

/// Rows of a picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Band {
    /// The colors, row by row, each row from the left.
    pub colors: Vec<[f32; 3]>,
    /// The words of the channels of each pixel, in the order of the pixels.
    pub words: Vec<u32>,
}

impl Band {
    /// Removes all rows.
    pub fn clear(&mut self) {
        self.colors.clear();
        self.words.clear();
    }
}

/// The rows of a picture from the top, some at a time. The band is empty when it is called, and
/// gets at least one row and only whole ones.
pub trait Bands: FnMut(&mut Band) -> io::Result<()> {}

impl<F: FnMut(&mut Band) -> io::Result<()>> Bands for F {}

/// Rows of a film that are written at a time: those of a block of an EXR.
const ROWS: usize = 64;

/// The rows of a film.
pub(super) fn bands(film: &Film) -> impl Bands {
    let mut rest = film.pixels().chunks(film.width() as usize * ROWS);
    move |band: &mut Band| {
        band.colors
            .extend_from_slice(rest.next().unwrap_or_default());
        Ok(())
    }
}
