//! Pictures as files: 8-bit sRGB PNG and linear f32 EXR.
//!
//! A picture is written row by row, whether it is in memory as a [`Film`] or comes in bands
//! of rows ([`Output::write_bands`]). Equal pixels give equal files: the encoders get the
//! same rows in the same order.

mod exr;
mod png;

use std::io;
use std::path::{Path, PathBuf};

use super::{FileError, Film, NewFile};

pub use self::png::{film_png_bytes, png_bytes};

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
        /// The error of the encoder, the system or the source of the rows.
        source: io::Error,
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

/// The rows of a picture from the top, some at a time, each row from the left. The vector is
/// empty when it is called, and gets at least one row and only whole ones.
pub trait Bands: FnMut(&mut Vec<[f32; 3]>) -> io::Result<()> + Send {}

impl<F: FnMut(&mut Vec<[f32; 3]>) -> io::Result<()> + Send> Bands for F {}

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
        let written = match self.format {
            Format::Png => png::write_film(&mut self.file, film),
            Format::Exr => exr::write_film(&mut self.file, film),
        };
        self.finish(written)
    }

    /// Writes a picture of `width` by `height` pixels, at least one, whose rows come in bands,
    /// and moves it to its place. A PNG takes the memory of one band, an EXR that of 64 rows
    /// and a band.
    ///
    /// # Errors
    /// If a band cannot be read, or encoding, writing or renaming fails. Then no file is left
    /// behind.
    pub fn write_bands(
        mut self,
        (width, height): (u32, u32),
        bands: impl Bands,
    ) -> Result<(), OutputError> {
        let written = match self.format {
            Format::Png => png::write_bands(&mut self.file, (width, height), bands),
            Format::Exr => exr::write_bands(&mut self.file, (width, height), bands),
        };
        self.finish(written)
    }

    fn finish(self, written: io::Result<()>) -> Result<(), OutputError> {
        written.map_err(|source| OutputError::Encoding {
            path: self.path,
            source,
        })?;
        Ok(self.file.finish()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::srgb;
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
    fn picture_in_bands_has_the_bytes_of_the_film() {
        let directory = tempfile::tempdir().expect("directory");
        let film = film();
        let size = (film.width(), film.height());
        for name in ["film.png", "film.exr"] {
            let path = directory.path().join(name);
            let output = || Output::create(&path).expect("created");
            output().write(&film).expect("written");
            let whole = std::fs::read(&path).expect("read");
            for rows in [1, 16, 65, 70] {
                let mut bands = film.pixels().chunks(rows * film.width() as usize);
                let next = |band: &mut Vec<[f32; 3]>| {
                    band.extend_from_slice(bands.next().expect("no more bands than rows"));
                    Ok(())
                };
                output().write_bands(size, next).expect("written");
                let written = std::fs::read(&path).expect("read");
                assert!(written == whole, "{name} in bands of {rows} rows");
            }
        }
    }

    #[test]
    fn error_of_a_band_is_reported_and_leaves_no_file() {
        let directory = tempfile::tempdir().expect("directory");
        for name in ["film.png", "film.exr"] {
            let path = directory.path().join(name);
            let mut rows = 0;
            let next = |band: &mut Vec<[f32; 3]>| {
                rows += 1;
                if rows == 30 {
                    return Err(io::Error::other("a part cannot be read"));
                }
                band.resize(130, [0.5; 3]);
                Ok(())
            };
            let output = Output::create(&path).expect("created");
            let error = output.write_bands((130, 200), next).expect_err(name);
            let source = std::error::Error::source(&error).expect("a source");
            assert!(
                source.to_string().contains("a part cannot be read"),
                "{source}"
            );
        }
        let left = std::fs::read_dir(directory.path())
            .expect("readable")
            .count();
        assert_eq!(left, 0);
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
