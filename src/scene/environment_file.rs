//! The environment of a scene file: a picture in Radiance HDR or OpenEXR.

use std::fs::{self, File};
use std::io::{BufReader, Cursor};
use std::path::Path;

use image::{ImageFormat, ImageReader};

use super::document::EnvironmentKeys;
use super::environment::Environment;
use super::error::SceneError;
use super::light_values::strength;
use super::limits::{GREATEST_PIXELS, MOST_PICTURE_BYTES};
use super::names::{printable, quoted};
use super::regular_file::read_regular;
use super::source::Source;

/// The bytes that a pixel takes while a picture is decoded (four f32) and converted (three).
const DECODING_BYTES: u64 = 28;

/// The environment with the pixels of its file, or `None` if that is not to be read. The keys are
/// validated in any case.
pub(super) fn environment(
    source: &Source,
    keys: &EnvironmentKeys,
    is_read: bool,
) -> Result<Option<Environment>, SceneError> {
    let wrong = |message: String| {
        source.error_with_help(
            keys.file.span(),
            message,
            "an environment is a picture of all directions in Radiance HDR (.hdr) or OpenEXR (.exr)",
        )
    };
    let strength = strength(source, keys.strength.as_ref(), 1.0)?;
    let path = source.resolve(keys.file.get_ref());
    let shown = path.display();
    let format = format_of(&path).ok_or_else(|| {
        let name = quoted(keys.file.get_ref());
        wrong(format!("{name} is not the name of such a picture"))
    })?;
    if !is_read {
        return Ok(None);
    }
    let bytes = read_regular(&path, MOST_PICTURE_BYTES).map_err(|error| {
        let unreadable = SceneError::Unreadable {
            path: path.clone(),
            source: error,
        };
        source.unreadable(&keys.file, unreadable)
    })?;
    let reader = || ImageReader::with_format(Cursor::new(&bytes[..]), format);
    let undecodable = |error: image::ImageError| {
        let reason = printable(&error.to_string());
        wrong(format!("cannot decode {shown}: {reason}"))
    };
    let (width, height) = reader().into_dimensions().map_err(undecodable)?;
    if u64::from(width) * u64::from(height) > GREATEST_PIXELS {
        return Err(wrong(format!(
            "{shown} has {width} x {height} pixels: at most {GREATEST_PIXELS} (2^28) are read"
        )));
    }
    let mut reader = reader();
    // The size is checked above.
    reader.no_limits();
    let picture = reader.decode().map_err(undecodable)?.into_rgb32f();
    let pixels = picture.pixels().map(|pixel| pixel.0).collect();
    let mut environment = Environment::new(width, height, pixels)
        .map_err(|error| wrong(format!("{shown}: {error}")))?;
    environment.strength = strength;
    environment.rotate_degrees = keys.rotate_degrees.map_or(0.0, |number| number.0);
    Ok(Some(environment))
}

/// An upper bound of the bytes that reading the file takes, the pixels included; 0 if it cannot be
/// read.
pub(super) fn reading_bytes(source: &Source, keys: &EnvironmentKeys) -> u64 {
    let decoding = pixels(source, keys).saturating_mul(DECODING_BYTES);
    let metadata = fs::metadata(source.resolve(keys.file.get_ref()));
    match (decoding, metadata) {
        (1.., Ok(metadata)) => metadata.len().saturating_add(decoding),
        _ => 0,
    }
}

/// The number of pixels of the file; 0 if it cannot be read.
pub(super) fn pixels(source: &Source, keys: &EnvironmentKeys) -> u64 {
    let path = source.resolve(keys.file.get_ref());
    let count = || {
        // Opening a pipe would wait for a writer.
        fs::metadata(&path).ok().filter(fs::Metadata::is_file)?;
        let file = BufReader::new(File::open(&path).ok()?);
        let reader = ImageReader::with_format(file, format_of(&path)?);
        let (width, height) = reader.into_dimensions().ok()?;
        Some(u64::from(width) * u64::from(height))
    };
    count().unwrap_or(0)
}

fn format_of(path: &Path) -> Option<ImageFormat> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    match extension.as_str() {
        "hdr" => Some(ImageFormat::Hdr),
        "exr" => Some(ImageFormat::OpenExr),
        _ => None,
    }
}
