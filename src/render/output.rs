//! Pictures as files: 8-bit sRGB PNG and linear f32 EXR.
//!
//! A picture is written to a temporary file beside its target and renamed, so
//! that whatever stood there stays whole until the new picture is whole too.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use image::{ImageBuffer, ImageFormat, Rgb};
use tempfile::NamedTempFile;

use super::{Film, srgb};

/// Why a picture cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The file name does not say PNG or EXR.
    #[error("cannot tell the picture's format from {path:?}: its name must end in .png or .exr")]
    Extension {
        /// The file as asked for.
        path: PathBuf,
    },
    /// The directory of the file does not exist, or is no directory.
    #[error("cannot write {path:?}: there is no directory {directory:?}")]
    NoDirectory {
        /// The file as asked for.
        path: PathBuf,
        /// Its directory.
        directory: PathBuf,
    },
    /// There is a directory in the file's place.
    #[error("cannot write {path:?}: it is a directory")]
    IsDirectory {
        /// The file as asked for.
        path: PathBuf,
    },
    /// The system refuses to create, write or rename the file.
    #[error("cannot write {path:?}: {source}")]
    System {
        /// The file as asked for.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The picture cannot be encoded.
    #[error("cannot encode {path:?}: {source}")]
    Encoding {
        /// The file as asked for.
        path: PathBuf,
        /// What the encoder says.
        source: image::ImageError,
    },
}

/// How a picture is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

/// A file that a picture will replace or create.
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    format: Format,
    temporary: NamedTempFile,
}

impl Output {
    /// Says whether a picture could be written to `path`, as far as that can
    /// be told without creating anything.
    ///
    /// # Errors
    /// When the extension is unknown, the directory does not exist, or `path`
    /// is a directory.
    pub fn check(path: &Path) -> Result<(), OutputError> {
        Format::of(path)?;
        let directory = directory_of(path);
        if !directory.is_dir() {
            return Err(OutputError::NoDirectory {
                path: path.into(),
                directory: directory.into(),
            });
        }
        if path.is_dir() {
            return Err(OutputError::IsDirectory { path: path.into() });
        }
        Ok(())
    }

    /// Creates the temporary file of `path`; it is removed when the value is
    /// dropped before [`Output::write`] ends.
    ///
    /// # Errors
    /// Those of [`Output::check`], or when the directory cannot be written to.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        Self::check(path)?;
        let mut builder = tempfile::Builder::new();
        builder.prefix(".cyltrace-");
        // Temporary files are private by default; a picture is as readable as
        // any file that the user's umask lets him create.
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        let temporary =
            builder
                .tempfile_in(directory_of(path))
                .map_err(|source| OutputError::System {
                    path: path.into(),
                    source,
                })?;
        Ok(Self {
            path: path.into(),
            format: Format::of(path)?,
            temporary,
        })
    }

    /// Writes the picture and moves it to its place.
    ///
    /// # Errors
    /// When encoding, writing or renaming fails. Nothing is left behind then.
    pub fn write(self, film: &Film) -> Result<(), OutputError> {
        let Self {
            path,
            format,
            temporary,
        } = self;
        let mut writer = BufWriter::new(temporary);
        let encoded = match format {
            Format::Png => png(film).write_to(&mut writer, ImageFormat::Png),
            Format::Exr => exr(film).write_to(&mut writer, ImageFormat::OpenExr),
        };
        encoded.map_err(|source| OutputError::Encoding {
            path: path.clone(),
            source,
        })?;
        let system = |source| OutputError::System {
            path: path.clone(),
            source,
        };
        writer.flush().map_err(system)?;
        let temporary = writer
            .into_inner()
            .map_err(|error| system(error.into_error()))?;
        temporary
            .persist(&path)
            .map_err(|error| system(error.error))?;
        Ok(())
    }
}

/// The directory that a file lies in: `.` for a bare name.
fn directory_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

fn png(film: &Film) -> ImageBuffer<Rgb<u8>, Vec<u8>> {
    let codes = film.pixels().iter().flatten().map(|&v| srgb::encode(v));
    ImageBuffer::from_raw(film.width(), film.height(), codes.collect())
        .expect("a film holds one colour a pixel")
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
    .expect("a film holds one colour a pixel")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Random;

    /// A film of hard values: noise, and what a clamp or a rounding may lose.
    fn film() -> Film {
        let mut random = Random::new(21, 0);
        let mut pixels: Vec<[f32; 3]> = (0..130 * 70)
            .map(|_| std::array::from_fn(|_| random.uniform(-0.1, 1.2) as f32))
            .collect();
        pixels[0] = [1e-30, 65_504.5, 3.4e38];
        Film::new(130, 70, pixels)
    }

    fn left_in(directory: &Path) -> Vec<PathBuf> {
        let entries = fs::read_dir(directory).expect("readable directory");
        entries.map(|entry| entry.expect("entry").path()).collect()
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
        assert_eq!(left_in(directory.path()), [path]);
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
    fn output_dropped_unwritten_nothing_left_and_old_file_kept() {
        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("old.png");
        fs::write(&path, "old").expect("written");
        drop(Output::create(&path).expect("created"));
        assert_eq!(left_in(directory.path()), [path.clone()]);
        assert_eq!(fs::read(&path).expect("read"), b"old");
    }

    #[test]
    fn output_unusable_paths_refused_by_name() {
        let directory = tempfile::tempdir().expect("directory");
        for (name, expected) in [
            ("picture.jpg", ".png or .exr"),
            ("picture", ".png or .exr"),
            ("missing/picture.png", "no directory"),
        ] {
            let error = Output::create(&directory.path().join(name)).expect_err(name);
            let message = error.to_string();
            assert!(
                message.contains(expected) && message.contains(name),
                "{message}"
            );
        }
        fs::create_dir(directory.path().join("taken.png")).expect("directory");
        let error = Output::create(&directory.path().join("taken.png")).expect_err("a directory");
        assert!(error.to_string().contains("is a directory"), "{error}");
    }
}
