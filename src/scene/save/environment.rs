//! The environment, with its pixels in an EXR file.

use std::io::{self, Cursor, Write};

use exr::image::write::WritableImage;
use exr::image::{Image, SpecificChannels};
use exr::math::Vec2;

use super::{SaveError, Saver};
use crate::scene::environment::Environment;

impl<W: Write> Saver<'_, W> {
    /// The environment of the scene, if it has one.
    pub fn environment(&mut self) -> Result<(), SaveError> {
        let Some(environment) = &self.scene.environment else {
            return Ok(());
        };
        let name = self.tables.add_file("environment", "exr", |output| {
            output.write_all(&encoded(environment)?)
        })?;
        let mut entry = self.text.table("[environment]");
        entry.text("file", &name);
        entry.number("strength", environment.strength);
        entry.number("rotate_degrees", environment.rotate_degrees);
        self.text.check()
    }
}

/// The pixels as a file; the encoder needs to seek.
fn encoded(environment: &Environment) -> io::Result<Vec<u8>> {
    let (width, height) = (environment.width() as usize, environment.height() as usize);
    let channels = SpecificChannels::rgb(|position: Vec2<usize>| {
        let [red, green, blue] = environment.pixels()[position.y() * width + position.x()];
        (red, green, blue)
    });
    let picture = Image::from_channels((width, height), channels);
    let mut bytes = Cursor::new(Vec::new());
    // With several threads, the encoder would write blocks as its threads finish them.
    let written = picture.write().non_parallel().to_buffered(&mut bytes);
    written.map_err(|error| match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other),
    })?;
    Ok(bytes.into_inner())
}
