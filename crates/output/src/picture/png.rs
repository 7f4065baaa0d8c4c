//! PNG: 8-bit sRGB.

use std::io::{self, Cursor, Write};

use image::{ImageBuffer, ImageError, ImageFormat, Rgba};
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter, StreamWriter};

use super::Bands;
use crate::{Film, srgb};

/// Bytes of compressed data in a chunk of the file. Each chunk adds 12 bytes.
const CHUNK: usize = 1 << 16;

/// The bytes of a PNG file of red, green, blue and opacity.
///
/// # Errors
/// If the encoder fails.
///
/// # Panics
/// When there is not one colour a pixel.
pub fn png_bytes(width: u32, height: u32, pixels: &[[u8; 4]]) -> Result<Vec<u8>, ImageError> {
    let picture: ImageBuffer<Rgba<u8>, Vec<u8>> =
        ImageBuffer::from_raw(width, height, pixels.as_flattened().to_vec())
            .expect("there is one color per pixel");
    let mut bytes = Vec::new();
    picture.write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png)?;
    Ok(bytes)
}

/// The bytes of the PNG file that [`Output`](crate::Output) writes of a film.
///
/// # Errors
/// If the encoder fails.
pub fn film_png_bytes(film: &Film) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    write_film(&mut bytes, film)?;
    Ok(bytes)
}

/// Writes a film.
pub(super) fn write_film(target: impl Write, film: &Film) -> io::Result<()> {
    encode(target, (film.width(), film.height()), |rows| {
        rows.write(film.pixels())
    })
}

/// Writes a picture that comes in bands of rows.
pub(super) fn write_bands(
    target: impl Write,
    (width, height): (u32, u32),
    mut bands: impl Bands,
) -> io::Result<()> {
    encode(target, (width, height), |rows| {
        let mut missing = u64::from(width) * u64::from(height);
        let mut band = Vec::new();
        while missing > 0 {
            band.clear();
            bands(&mut band)?;
            rows.write(&band)?;
            missing = missing.saturating_sub(band.len() as u64);
        }
        Ok(())
    })
}

/// Encodes a picture whose rows `write` writes.
fn encode<W: Write>(
    target: W,
    (width, height): (u32, u32),
    write: impl FnOnce(&mut Rows<W>) -> io::Result<()>,
) -> io::Result<()> {
    let mut encoder = Encoder::new(target, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    let mut writer = encoder.write_header().map_err(system)?;
    {
        let mut rows = Rows {
            stream: writer.stream_writer_with_size(CHUNK).map_err(system)?,
            codes: Vec::new(),
            row: 3 * width as usize,
        };
        write(&mut rows)?;
        rows.stream.finish().map_err(system)?;
    }
    writer.finish().map_err(system)
}

/// Takes the rows of a picture.
struct Rows<'a, W: Write> {
    stream: StreamWriter<'a, W>,
    codes: Vec<u8>,
    /// Bytes of a row.
    row: usize,
}

impl<W: Write> Rows<'_, W> {
    fn write(&mut self, pixels: &[[f32; 3]]) -> io::Result<()> {
        // Row by row, so that the codes of a large film take no memory.
        for row in pixels.as_flattened().chunks(self.row) {
            self.codes.clear();
            self.codes
                .extend(row.iter().map(|&value| srgb::encode(value)));
            self.stream.write_all(&self.codes)?;
        }
        Ok(())
    }
}

/// The system's error, if it is one.
fn system(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
