//! Images on surfaces, from PNG files.
//!
//! The image covers a surface once: `u` runs from its left to its right edge and around again,
//! `v` from its bottom to its top. Between the centers of pixels, linear colors are interpolated
//! bilinearly; beyond the centers of the first and last row those rows continue.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Seek, Write};
use std::path::Path;

use glam::DVec3;
use png::{BitDepth, ColorType, Decoder, Encoder, Info, Transformations};

use super::srgb::{decode8, decode16};
use crate::scene::limits::GREATEST_PIXELS;

/// An image of sRGB codes.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    width: u32,
    height: u32,
    codes: Codes,
    /// The mean of the linear colors of all pixels.
    average: DVec3,
}

/// The codes of the pixels, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
enum Codes {
    Eight(Vec<[u8; 3]>),
    Sixteen(Vec<[u16; 3]>),
}

/// Why a file is no image for a surface.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// The file cannot be opened.
    #[error("{0}")]
    Unreadable(#[from] io::Error),
    /// The file is not a valid PNG.
    #[error("{0}")]
    Png(#[from] png::DecodingError),
    /// The image is too large.
    #[error("the image has {width} x {height} pixels: at most {GREATEST_PIXELS} are read")]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// A pixel is not opaque.
    #[error("a pixel is transparent: an image on a surface must be opaque")]
    Transparent,
}

impl Texture {
    /// Reads a PNG of 8 or 16 bits; images of fewer bits, of grays and of palettes are expanded.
    /// The codes are sRGB whatever the file states of its gamma.
    ///
    /// # Errors
    /// If the file is not such an image, or a pixel of it is not opaque.
    pub fn read(path: &Path) -> Result<Self, TextureError> {
        Self::decode(BufReader::new(File::open(path)?))
    }

    fn decode(input: impl BufRead + Seek) -> Result<Self, TextureError> {
        let mut decoder = Decoder::new(input);
        decoder.set_transformations(Transformations::EXPAND);
        let (width, height) = size(decoder.read_header_info()?)?;
        let mut reader = decoder.read_info()?;
        let too_large = TextureError::Size { width, height };
        let mut bytes = vec![0; reader.output_buffer_size().ok_or(too_large)?];
        let info = reader.next_frame(&mut bytes)?;
        let channels = info.color_type.samples();
        let codes = match info.bit_depth {
            BitDepth::Sixteen => {
                let pairs = bytes.as_chunks().0.iter();
                let codes: Vec<u16> = pairs.map(|pair| u16::from_be_bytes(*pair)).collect();
                drop(bytes);
                Codes::Sixteen(colors(&codes, channels, u16::MAX)?)
            }
            _ => Codes::Eight(colors(&bytes, channels, u8::MAX)?),
        };
        Ok(Self::new((width, height), codes))
    }

    fn new((width, height): (u32, u32), codes: Codes) -> Self {
        let pixels = f64::from(width) * f64::from(height);
        let sum: DVec3 = match &codes {
            Codes::Eight(codes) => codes.iter().copied().map(decode8).sum(),
            Codes::Sixteen(codes) => codes.iter().copied().map(decode16).sum(),
        };
        Self {
            width,
            height,
            codes,
            average: sum / pixels,
        }
    }

    /// Writes the image as a PNG that [`Texture::read`] reads as the same image.
    ///
    /// # Errors
    /// If the output fails.
    pub fn write(&self, output: impl Write) -> io::Result<()> {
        let mut encoder = Encoder::new(output, self.width, self.height);
        encoder.set_color(ColorType::Rgb);
        let wide: Vec<u8>;
        let bytes = match &self.codes {
            Codes::Eight(codes) => {
                encoder.set_depth(BitDepth::Eight);
                codes.as_flattened()
            }
            Codes::Sixteen(codes) => {
                encoder.set_depth(BitDepth::Sixteen);
                let codes = codes.as_flattened().iter();
                wide = codes.flat_map(|code| code.to_be_bytes()).collect();
                &wide
            }
        };
        let mut writer = encoder.write_header()?;
        writer.write_image_data(bytes)?;
        Ok(writer.finish()?)
    }

    /// The linear color at a place of a surface.
    #[must_use]
    pub fn at(&self, u: f64, v: f64) -> DVec3 {
        let (width, height) = (i64::from(self.width), i64::from(self.height));
        // In pixels from the center of the first one.
        let x = u * f64::from(self.width) - 0.5;
        let y = (1.0 - v) * f64::from(self.height) - 0.5;
        let (left, above) = (x.floor(), y.floor());
        let columns = [0, 1].map(|next| (left as i64 + next).rem_euclid(width));
        let rows = [0, 1].map(|next| (above as i64 + next).clamp(0, height - 1));
        let [upper, lower] = rows.map(|row| {
            let [one, other] = columns.map(|column| self.pixel((row * width + column) as usize));
            one.lerp(other, x - left)
        });
        upper.lerp(lower, y - above)
    }

    fn pixel(&self, position: usize) -> DVec3 {
        match &self.codes {
            Codes::Eight(codes) => decode8(codes[position]),
            Codes::Sixteen(codes) => decode16(codes[position]),
        }
    }

    /// The mean of the linear colors of all pixels.
    #[must_use]
    pub fn average(&self) -> DVec3 {
        self.average
    }

    /// The bytes of the pixels.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match &self.codes {
            Codes::Eight(codes) => size_of_val(codes.as_slice()),
            Codes::Sixteen(codes) => size_of_val(codes.as_slice()),
        }
    }
}

/// The bytes of the pixels of an image file, from its header; 0 if it cannot be read.
pub(in crate::scene) fn header_bytes(path: &Path) -> u64 {
    let file = File::open(path).ok().filter(|_| path.is_file());
    let bytes = file.and_then(|file| {
        let mut decoder = Decoder::new(BufReader::new(file));
        let info = decoder.read_header_info().ok()?;
        let (width, height) = size(info).ok()?;
        let code = if info.bit_depth == BitDepth::Sixteen {
            2
        } else {
            1
        };
        Some(3 * code * u64::from(width) * u64::from(height))
    });
    bytes.unwrap_or(0)
}

/// The size of an image, if it is not too large.
fn size(info: &Info) -> Result<(u32, u32), TextureError> {
    let (width, height) = info.size();
    match u64::from(width) * u64::from(height) <= GREATEST_PIXELS {
        true => Ok((width, height)),
        false => Err(TextureError::Size { width, height }),
    }
}

/// The colors of pixels of one to four channels: gray or RGB, with or without opacity.
fn colors<T: Copy + PartialEq>(
    codes: &[T],
    channels: usize,
    opaque: T,
) -> Result<Vec<[T; 3]>, TextureError> {
    let pixels = codes.chunks_exact(channels).map(|pixel| match *pixel {
        [gray] => Ok([gray; 3]),
        [gray, opacity] if opacity == opaque => Ok([gray; 3]),
        [red, green, blue] => Ok([red, green, blue]),
        [red, green, blue, opacity] if opacity == opaque => Ok([red, green, blue]),
        _ => Err(TextureError::Transparent),
    });
    pixels.collect()
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// An image of 2 x 2 pixels: red and green above blue and white.
    fn corners() -> Texture {
        let codes = vec![[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]];
        Texture::new((2, 2), Codes::Eight(codes))
    }

    fn png(color: ColorType, depth: BitDepth, bytes: &[u8]) -> Vec<u8> {
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(bytes).expect("pixels");
        writer.finish().expect("an image");
        file
    }

    #[test]
    fn places_at_centers_are_pixels_and_others_are_interpolated() {
        let image = corners();
        assert_eq!(image.at(0.25, 0.75), DVec3::X);
        assert_eq!(image.at(0.75, 0.75), DVec3::Y);
        assert_eq!(image.at(0.25, 0.25), DVec3::Z);
        assert_eq!(image.at(0.75, 0.25), DVec3::ONE);
        // Halfway, across the seam at u = 0 as well.
        let halfway = DVec3::new(0.5, 0.5, 0.0);
        for u in [0.5, 0.0, 1.0] {
            assert_eq!(image.at(u, 0.75), halfway, "{u}");
        }
        assert_eq!(image.at(0.5, 0.5), DVec3::new(0.5, 0.5, 0.5));
        // A quarter of the way from blue to white.
        assert_eq!(image.at(0.375, 0.25), DVec3::new(0.25, 0.25, 1.0));
        // The rows do not wrap.
        assert_eq!(image.at(0.25, 1.0), DVec3::X);
        assert_eq!(image.at(0.25, 0.0), DVec3::Z);
        assert_eq!(image.average(), DVec3::splat(0.5));
    }

    #[test]
    fn images_of_all_depths_are_read_and_written_as_the_same() {
        let read = |file: &[u8]| Texture::decode(Cursor::new(file));
        let sixteen = png(
            ColorType::Rgb,
            BitDepth::Sixteen,
            &[0, 1, 0, 2, 0, 3, 9, 8, 7, 6, 5, 4],
        );
        let sixteen = read(&sixteen).expect("an image");
        let codes = vec![[1, 2, 3], [0x0908, 0x0706, 0x0504]];
        assert_eq!(sixteen.codes, Codes::Sixteen(codes));
        let opaque = png(
            ColorType::GrayscaleAlpha,
            BitDepth::Eight,
            &[7, 255, 9, 255],
        );
        let opaque = read(&opaque).expect("an image");
        assert_eq!(opaque.codes, Codes::Eight(vec![[7; 3], [9; 3]]));
        let bits = png(ColorType::Grayscale, BitDepth::One, &[0b0100_0000]);
        assert_eq!(
            read(&bits).expect("an image").codes,
            Codes::Eight(vec![[0; 3], [255; 3]])
        );
        for image in [sixteen, opaque, corners()] {
            let mut file = Vec::new();
            image.write(&mut file).expect("written");
            assert_eq!(read(&file).expect("an image"), image);
        }
        let transparent = png(
            ColorType::Rgba,
            BitDepth::Eight,
            &[1, 2, 3, 255, 1, 2, 3, 254],
        );
        let error = read(&transparent).expect_err("a transparent pixel");
        assert!(matches!(error, TextureError::Transparent), "{error}");
        assert!(read(b"no image").is_err());
    }
}
