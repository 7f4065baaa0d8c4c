//! PNG: 8-bit sRGB.

use std::io::{self, Cursor, Write};

use image::{ImageBuffer, ImageError, ImageFormat, Rgba};
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter, StreamWriter};

use super::contents::{Band, Bands, Contents};

/// The keyword of the text with the estimated error.
const ERROR: &str = "relative error";

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

/// The bytes of the PNG file that [`Output`](crate::Output) writes of a picture of `width` by
/// `height` pixels, at least one, whose rows come in bands.
///
/// # Errors
/// If a band cannot be read, or the encoder fails.
///
/// # Panics
/// If the contents have another channel than opacity.
pub fn picture_png_bytes(
    size: (u32, u32),
    contents: &Contents,
    bands: impl Bands,
) -> io::Result<Vec<u8>> {
    let channels = &contents.channels;
    assert!(!contents.need_exr(), "a PNG does not have {channels:?}");
    let mut bytes = Vec::new();
    write_bands(&mut bytes, size, contents, bands)?;
    Ok(bytes)
}

/// Writes a picture that comes in bands of rows. Its only channel can be opacity.
pub(super) fn write_bands(
    target: impl Write,
    (width, height): (u32, u32),
    contents: &Contents,
    mut next: impl Bands,
) -> io::Result<()> {
    let opacity = contents.opacity();
    let mut encoder = Encoder::new(target, width, height);
    encoder.set_color(match opacity {
        Some(_) => ColorType::Rgba,
        None => ColorType::Rgb,
    });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    if let Some(error) = contents.error {
        let added = encoder.add_text_chunk(ERROR.into(), error.to_string());
        added.map_err(system)?;
    }
    let mut writer = encoder.write_header().map_err(system)?;
    {
        let mut rows = Rows {
            stream: writer.stream_writer_with_size(CHUNK).map_err(system)?,
            contents,
            opacity,
            codes: Vec::new(),
        };
        let mut missing = u64::from(width) * u64::from(height);
        let mut band = Band::default();
        while missing > 0 {
            band.clear();
            next(&mut band)?;
            rows.write(&band, width as usize)?;
            missing = missing.saturating_sub(band.colors.len() as u64);
        }
        rows.stream.finish().map_err(system)?;
    }
    writer.finish().map_err(system)
}

/// Takes the rows of a picture.
struct Rows<'a, W: Write> {
    stream: StreamWriter<'a, W>,
    contents: &'a Contents,
    /// The place of opacity among the words of a pixel.
    opacity: Option<usize>,
    codes: Vec<u8>,
}

impl<W: Write> Rows<'_, W> {
    fn write(&mut self, band: &Band, width: usize) -> io::Result<()> {
        let display = self.contents.display;
        let words = self.contents.channels.len();
        // Row by row, so that the codes of a large film take no memory.
        for (row, colors) in band.colors.chunks(width).enumerate() {
            self.codes.clear();
            match self.opacity {
                None => {
                    let codes = colors.iter().flat_map(|&color| display.codes(color));
                    self.codes.extend(codes);
                }
                Some(place) => {
                    let pixels = band.words[row * width * words..].chunks(words);
                    let codes = colors.iter().zip(pixels).flat_map(|(&color, pixel)| {
                        let opacity = f32::from_bits(pixel[place]);
                        let alone = match opacity > 0.0 {
                            true => color.map(|value| value / opacity),
                            false => [0.0; 3],
                        };
                        let [red, green, blue] = display.codes(alone);
                        [red, green, blue, (opacity * 255.0 + 0.5) as u8]
                    });
                    self.codes.extend(codes);
                }
            }
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
