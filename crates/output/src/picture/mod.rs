//! Pictures as files: 8-bit sRGB PNG and linear f32 EXR.
//!
//! A picture is written row by row, whether it is in memory as a [`Film`] or comes in bands
//! of rows ([`Output::write_bands`]). Equal pixels give equal files: the encoders get the
//! same rows in the same order.

mod contents;
mod exr;
mod png;

use std::io;
use std::path::{Path, PathBuf};

use super::{FileError, Film, NewFile};

pub use self::contents::{Band, Bands, Channel, Contents, Numbers};
pub use self::png::{picture_png_bytes, png_bytes};

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
    /// The file would need channels that its format does not have.
    #[error("a PNG cannot have channels: write {:?} in place of {path:?}", path.with_extension("exr"))]
    Channels {
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
    /// 8 bits a channel, sRGB, as [`Display`](crate::Display) shows the colors.
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

/// The format of a picture with these contents.
fn format_of(path: &Path, contents: &Contents) -> Result<Format, OutputError> {
    match Format::of(path)? {
        Format::Png if contents.need_exr() => Err(OutputError::Channels { path: path.into() }),
        format => Ok(format),
    }
}

/// A file that a picture will replace or create, see [`NewFile`].
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    format: Format,
    contents: Contents,
    file: NewFile,
}

impl Output {
    /// Checks that a picture can be written to `path`, as far as possible without
    /// creating anything.
    ///
    /// # Errors
    /// If the extension is unknown, its format cannot have the contents, or for those of
    /// [`NewFile::check`].
    pub fn check(path: &Path, contents: &Contents) -> Result<(), OutputError> {
        format_of(path, contents)?;
        Ok(NewFile::check(path)?)
    }

    /// Opens the temporary file of a picture.
    ///
    /// # Errors
    /// If the extension is unknown, its format cannot have the contents, or for those of
    /// [`NewFile::create`].
    pub fn create(path: &Path, contents: Contents) -> Result<Self, OutputError> {
        let format = format_of(path, &contents)?;
        Ok(Self {
            path: path.into(),
            format,
            contents,
            file: NewFile::create(path)?,
        })
    }

    /// States the estimated relative error of the picture in the file.
    pub fn state_error(&mut self, error: f32) {
        self.contents.error = Some(error);
    }

    /// Writes the picture and moves it to its place.
    ///
    /// # Errors
    /// If encoding, writing or renaming fails. Then no file is left behind.
    ///
    /// # Panics
    /// If the contents have channels, which a film does not.
    pub fn write(self, film: &Film) -> Result<(), OutputError> {
        let channels = &self.contents.channels;
        assert!(channels.is_empty(), "a film does not have {channels:?}");
        self.write_bands((film.width(), film.height()), contents::bands(film))
    }

    /// Writes a picture of `width` by `height` pixels, at least one, whose rows come in bands,
    /// and moves it to its place. A PNG takes the memory of one band, an EXR that of 64 rows
    /// and a band.
    ///
    /// # Errors
    /// If a band cannot be read, or encoding, writing or renaming fails. Then no file is left
    /// behind.
    pub fn write_bands(mut self, size: (u32, u32), bands: impl Bands) -> Result<(), OutputError> {
        let written = match self.format {
            Format::Png => png::write_bands(&mut self.file, size, &self.contents, bands),
            Format::Exr => exr::write_bands(&mut self.file, size, &self.contents, bands),
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
        Output::create(&path, Contents::default())
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
        Output::create(&path, Contents::default())
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
            let output = || Output::create(&path, Contents::default()).expect("created");
            output().write(&film).expect("written");
            let whole = std::fs::read(&path).expect("read");
            for rows in [1, 16, 65, 70] {
                let mut bands = film.pixels().chunks(rows * film.width() as usize);
                let next = |band: &mut Band| {
                    band.colors
                        .extend_from_slice(bands.next().expect("no more bands than rows"));
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
            let next = |band: &mut Band| {
                rows += 1;
                if rows == 30 {
                    return Err(io::Error::other("a part cannot be read"));
                }
                band.colors.resize(130, [0.5; 3]);
                Ok(())
            };
            let output = Output::create(&path, Contents::default()).expect("created");
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

    /// Two channels and opacity, of a picture with more rows than a block.
    fn contents_and_words() -> (Contents, Vec<u32>) {
        let channel = |name, numbers| Channel { name, numbers };
        let channels = vec![
            channel("Z", Numbers::F32),
            Channel::OPACITY,
            channel("Id", Numbers::U32),
        ];
        let words = (0..130 * 70).flat_map(|pixel| {
            let depth = if pixel % 3 == 0 {
                f32::INFINITY
            } else {
                pixel as f32
            };
            [depth.to_bits(), (0.25_f32).to_bits(), u32::MAX - pixel]
        });
        let contents = Contents {
            channels,
            error: Some(0.015),
            ..Contents::default()
        };
        (contents, words.collect())
    }

    #[test]
    fn exr_with_channels_read_back_same_words() {
        use ::exr::image::FlatSamples;
        use ::exr::image::read::read_first_flat_layer_from_file;

        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("film.exr");
        let (film, (contents, words)) = (film(), contents_and_words());
        let output = Output::create(&path, contents.clone()).expect("created");
        let mut row = 0;
        let next = |band: &mut Band| {
            // Bands of 9 rows, the last of 7.
            let pixels = row * 130..(row + 9).min(70) * 130;
            band.colors
                .extend_from_slice(&film.pixels()[pixels.clone()]);
            band.words
                .extend_from_slice(&words[3 * pixels.start..3 * pixels.end]);
            row += 9;
            Ok(())
        };
        output.write_bands((130, 70), next).expect("written");
        let read = read_first_flat_layer_from_file(&path).expect("readable");
        let layer = read.layer_data;
        let error = &layer.attributes.other[&b"relativeError"[..]];
        assert_eq!(format!("{error:?}"), "F32(0.015)");
        let mut names = Vec::new();
        for channel in &layer.channel_data.list {
            let name = channel.name.to_string();
            let bits: Vec<u32> = match &channel.sample_data {
                FlatSamples::F32(values) => values.iter().map(|value| value.to_bits()).collect(),
                FlatSamples::U32(values) => values.clone(),
                FlatSamples::F16(_) => panic!("{name} has 16 bits"),
            };
            let colors = |place: usize| film.pixels().iter().map(move |p| p[place].to_bits());
            let of_words = |place: usize| words.iter().skip(place).step_by(3).copied();
            let expected: Vec<u32> = match name.as_str() {
                "R" => colors(0).collect(),
                "G" => colors(1).collect(),
                "B" => colors(2).collect(),
                "Z" => of_words(0).collect(),
                "A" => of_words(1).collect(),
                "Id" => of_words(2).collect(),
                other => panic!("{other}"),
            };
            assert!(bits == expected, "{name}");
            names.push(name);
        }
        assert_eq!(names, ["A", "B", "G", "Id", "R", "Z"]);
    }

    #[test]
    fn png_with_opacity_has_colors_that_are_not_multiplied_and_states_the_error() {
        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("film.png");
        let contents = Contents {
            channels: vec![Channel::OPACITY],
            error: Some(0.015),
            ..Contents::default()
        };
        let output = Output::create(&path, contents).expect("created");
        let next = |band: &mut Band| {
            band.colors = vec![[0.25, 0.125, 0.0], [0.0; 3], [1.0, 0.5, 2.0]];
            band.words = [0.5_f32, 0.0, 1.0].map(f32::to_bits).to_vec();
            Ok(())
        };
        output.write_bands((3, 1), next).expect("written");
        let read = image::open(&path).expect("readable").into_rgba8();
        let pixels: Vec<[u8; 4]> = read.pixels().map(|pixel| pixel.0).collect();
        let half = srgb::encode(0.5);
        let quarter = srgb::encode(0.25);
        assert_eq!(
            pixels,
            [[half, quarter, 0, 128], [0; 4], [255, half, 255, 255]]
        );
        let bytes = std::fs::read(&path).expect("read");
        let text = b"tEXtrelative error\x000.015";
        assert!(bytes.windows(text.len()).any(|window| window == text));
    }

    #[test]
    fn channels_of_a_png_are_refused_with_the_name_that_would_be_right() {
        let (contents, _) = contents_and_words();
        let refused = Output::check(Path::new("a.png"), &contents).expect_err("a PNG");
        assert!(refused.to_string().contains("a.exr"), "{refused}");
    }

    #[test]
    fn output_of_unknown_format_refused_by_name() {
        for name in ["picture.jpg", "picture", ".png"] {
            let message = Output::check(Path::new(name), &Contents::default())
                .expect_err(name)
                .to_string();
            assert!(
                message.contains(".png or .exr") && message.contains(name),
                "{message}"
            );
        }
    }
}
