//! Pictures as files: 8-bit sRGB PNG and linear f32 EXR.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{ImageBuffer, ImageError, ImageFormat, Rgb, Rgba};

use super::{FileError, Film, NewFile, srgb};

/// Why a picture cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The file name does not say PNG or EXR.
    #[error("unknown picture format of {path:?}: the name must end in .png or .exr")]
    Extension {
        /// The path as given.
        path: PathBuf,
    },
    /// The file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The picture cannot be encoded, or not all of it could be written.
    #[error("cannot write the picture {path:?}")]
    Encoding {
        /// The path as given.
        path: PathBuf,
        /// The encoder's error.
        source: image::ImageError,
    },
}

/// How a picture is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// 8 bits a channel, sRGB, clamped to [0, 1] without tone mapping.
    Png,
    /// 32-bit floats, linear, nothing clamped.
    Exr,
}

impl Format {
    /// The format that the file's extension names, in any case.
    ///
    /// # Errors
    /// For any other extension, or none.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        let extension = path.extension().map(|e| e.to_ascii_lowercase());
        match extension.as_ref().and_then(|e| e.to_str()) {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            _ => Err(OutputError::Extension { path: path.into() }),
        }
    }
}

/// A file that a picture will replace or create, see [`NewFile`].
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    format: Format,
    file: NewFile,
}

impl Output {
    /// Checks that a picture can be written to `path`, as far as possible without
    /// creating anything.
    ///
    /// # Errors
    /// If the extension is unknown, or for those of [`NewFile::check`].
    pub fn check(path: &Path) -> Result<(), OutputError> {
        Format::of(path)?;
        Ok(NewFile::check(path)?)
    }

    /// Opens the temporary file of a picture.
    ///
    /// # Errors
    /// If the extension is unknown, or for those of [`NewFile::create`].
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        Ok(Self {
            path: path.into(),
            format: Format::of(path)?,
            file: NewFile::create(path)?,
        })
    }

    /// Writes the picture and moves it to its place.
    ///
    /// # Errors
    /// If encoding, writing or renaming fails. Then no file is left behind.
    pub fn write(mut self, film: &Film) -> Result<(), OutputError> {
        let encoded = match self.format {
            Format::Png => png(film).write_to(&mut self.file, ImageFormat::Png),
            Format::Exr => exr(film).write_to(&mut self.file, ImageFormat::OpenExr),
        };
        encoded.map_err(|source| OutputError::Encoding {
            path: self.path,
            source,
        })?;
        Ok(self.file.finish()?)
    }
}

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

/// The bytes of the PNG file that [`Output`] writes of a film.
///
/// # Errors
/// If the encoder fails.
pub fn film_png_bytes(film: &Film) -> Result<Vec<u8>, ImageError> {
    let mut bytes = Vec::new();
    png(film).write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png)?;
    Ok(bytes)
}

fn png(film: &Film) -> ImageBuffer<Rgb<u8>, Vec<u8>> {
    let codes = film.pixels().iter().flatten().map(|&v| srgb::encode(v));
    ImageBuffer::from_raw(film.width(), film.height(), codes.collect())
        .expect("a film has one color per pixel")
}

/// The blocks of the file come in order, so that equal films give equal
/// files: `image` is built without its `rayon` feature, with which the EXR
/// encoder would write blocks as its threads finish them.
fn exr(film: &Film) -> ImageBuffer<Rgb<f32>, Vec<f32>> {
    ImageBuffer::from_raw(
        film.width(),
        film.height(),
        film.pixels().as_flattened().to_vec(),
    )
    .expect("a film has one color per pixel")
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::math::Random;

    /// A film of hard values: noise, and what a clamp or a rounding may lose.
    fn film() -> Film {
        let mut random = Random::new(21, 0);
        let mut pixels: Vec<[f32; 3]> = (0..130 * 70)
            .map(|_| std::array::from_fn(|_| random.uniform(-0.1, 1.2) as f32))
            .collect();
        pixels[0] = [1e-30, 65_504.5, 3.4e38];
        Film::new(130, 70, pixels)
    }

    #[test]
    fn exr_read_back_same_bits() {
        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("film.EXR");
        let film = film();
        Output::create(&path)
            .and_then(|o| o.write(&film))
            .expect("written");
        let read = image::open(&path).expect("readable").into_rgb32f();
        assert_eq!((read.width(), read.height()), (130, 70));
        let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(read.as_raw()), bits(film.pixels().as_flattened()));
    }

    #[test]
    fn png_read_back_srgb_codes() {
        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("film.png");
        let film = film();
        Output::create(&path)
            .and_then(|o| o.write(&film))
            .expect("written");
        let read = image::open(&path).expect("readable").into_rgb8();
        for (n, (code, &value)) in read
            .as_raw()
            .iter()
            .zip(film.pixels().as_flattened())
            .enumerate()
        {
            assert_eq!(*code, srgb::encode(value), "channel {n}: {value:e}");
        }
    }

    #[test]
    fn output_of_unknown_format_refused_by_name() {
        for name in ["picture.jpg", "picture", ".png"] {
            let message = Output::check(Path::new(name)).expect_err(name).to_string();
            assert!(
                message.contains(".png or .exr") && message.contains(name),
                "{message}"
            );
        }
    }
}
