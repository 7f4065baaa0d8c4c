//! OpenEXR: 32-bit linear floats.

use std::io::{self, Seek, Write};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use exr::error::Error;
use exr::image::Image;
use exr::image::SpecificChannels;
use exr::image::write::WritableImage;
use exr::math::Vec2;

use super::Bands;
use crate::Film;

/// Writes a film.
pub(super) fn write_film(target: impl Write + Seek, film: &Film) -> io::Result<()> {
    let width = film.width() as usize;
    write(target, (film.width(), film.height()), |x, y| {
        film.pixels()[y * width + x]
    })
}

/// Writes a picture that comes in bands of rows.
pub(super) fn write_bands(
    target: impl Write + Seek,
    (width, height): (u32, u32),
    bands: impl Bands,
) -> io::Result<()> {
    // The encoder takes pixels by their positions and knows no error; it takes them in order.
    let window = Mutex::new(Window {
        bands,
        width: width as usize,
        rows: 0..0,
        pixels: Vec::new(),
        band: Vec::new(),
        error: None,
    });
    let written = write(target, (width, height), |x, y| {
        let mut window = window.lock().unwrap_or_else(PoisonError::into_inner);
        window.pixel(x, y)
    });
    let window = window.into_inner().unwrap_or_else(PoisonError::into_inner);
    match window.error {
        Some(error) => Err(error),
        None => written,
    }
}

/// Writes a picture of which `pixel` gives each pixel once. The blocks of the file come in
/// order, so that equal pictures give equal files: with several threads, the encoder would
/// write blocks as its threads finish them.
fn write(
    target: impl Write + Seek,
    (width, height): (u32, u32),
    pixel: impl Fn(usize, usize) -> [f32; 3] + Sync,
) -> io::Result<()> {
    let channels = SpecificChannels::rgb(|position: Vec2<usize>| {
        let [red, green, blue] = pixel(position.x(), position.y());
        (red, green, blue)
    });
    let picture = Image::from_channels((width as usize, height as usize), channels);
    let written = picture.write().non_parallel().to_buffered(target);
    written.map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other),
    })
}

/// Rows in which the encoder has not read its next block, and may read again: the encoder
/// reads blocks of `BLOCK` rows from left to right.
struct Window<B> {
    bands: B,
    width: usize,
    /// The rows in `pixels`.
    rows: Range<usize>,
    pixels: Vec<[f32; 3]>,
    /// The next band, empty between calls.
    band: Vec<[f32; 3]>,
    /// The first error of the bands.
    error: Option<io::Error>,
}

/// Rows of a block of the file, the default of the `exr` crate for this kind of picture.
const BLOCK: usize = 64;

impl<B: Bands> Window<B> {
    /// A pixel; black after an error, which fails the picture.
    fn pixel(&mut self, x: usize, y: usize) -> [f32; 3] {
        let block = y - y % BLOCK;
        if self.rows.start < block && self.error.is_none() {
            self.pixels.drain(..(block - self.rows.start) * self.width);
            self.rows.start = block;
        }
        while self.rows.end <= y && self.error.is_none() {
            let read = (self.bands)(&mut self.band);
            self.error = read.err();
            self.rows.end += self.band.len() / self.width;
            self.pixels.append(&mut self.band);
        }
        let place = (y - self.rows.start) * self.width + x;
        self.pixels.get(place).copied().unwrap_or_default()
    }
}
