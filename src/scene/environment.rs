//! The light from all directions as a picture.

use std::fmt;
use std::sync::Arc;

/// Light from infinitely far away, as a picture of all directions.
///
/// The picture is a map with evenly spaced longitudes and latitudes: the middle of a pixel is at
/// the share `x` of the width from the left and the share `y` of the height from the top, and
/// shows the radiance from the azimuth `360° (1/2 - x)`, from the x axis towards the y axis, and
/// the elevation `180° (1/2 - y)`. So its top row is at the zenith, z, and its middle at the x
/// axis: the picture of a panorama camera that looks along x.
#[derive(Clone, PartialEq)]
pub struct Environment {
    width: u32,
    height: u32,
    pixels: Arc<[[f32; 3]]>,
    /// Factor on the pixels; 0 or greater.
    pub strength: f64,
    /// Turns the picture about z: degrees that are added to azimuths.
    pub rotate_degrees: f64,
}

/// Pixels cannot be an environment.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvironmentError {
    /// The numbers do not fit together.
    #[error("{width} x {height} pixels are not {count}: there must be at least one, and all")]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// The pixels there are.
        count: usize,
    },
    /// A pixel is no radiance.
    #[error(
        "the pixel in column {column} and row {row}, counted from 0, is {color:?}: radiance must be finite and not negative"
    )]
    Pixel {
        /// The column, from 0 at the left.
        column: u32,
        /// The row, from 0 at the top.
        row: u32,
        /// Its value.
        color: [f32; 3],
    },
}

impl Environment {
    /// An environment of strength 1 that is not turned. The pixels are linear RGB, row by row
    /// from the top.
    ///
    /// # Errors
    /// If the number of pixels is zero or not `width * height`, or a component is negative,
    /// infinite or NaN.
    pub fn new(width: u32, height: u32, pixels: Arc<[[f32; 3]]>) -> Result<Self, EnvironmentError> {
        let count = pixels.len();
        if count == 0 || count as u64 != u64::from(width) * u64::from(height) {
            return Err(EnvironmentError::Size {
                width,
                height,
                count,
            });
        }
        let is_radiance = |component: &f32| component.is_finite() && *component >= 0.0;
        let wrong = pixels
            .iter()
            .position(|pixel| !pixel.iter().all(is_radiance));
        if let Some(index) = wrong {
            return Err(EnvironmentError::Pixel {
                column: (index % width as usize) as u32,
                row: (index / width as usize) as u32,
                color: pixels[index],
            });
        }
        Ok(Self {
            width,
            height,
            pixels,
            strength: 1.0,
            rotate_degrees: 0.0,
        })
    }

    /// Pixels across.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Pixels down.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The pixels, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &Arc<[[f32; 3]]> {
        &self.pixels
    }
}

/// Without the pixels, which may be millions.
impl fmt::Debug for Environment {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter
            .debug_struct("Environment")
            .field("width", &self.width)
            .field("height", &self.height)
            .field("strength", &self.strength)
            .field("rotate_degrees", &self.rotate_degrees)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_that_are_no_radiance_are_an_error_with_their_place() {
        let pixels = |wrong: f32| {
            let mut pixels = vec![[0.5; 3]; 6];
            pixels[4][1] = wrong;
            Environment::new(3, 2, pixels.into())
        };
        assert!(pixels(0.0).is_ok());
        for wrong in [-1e-30, f32::NAN, f32::INFINITY] {
            let message = pixels(wrong).expect_err("no radiance").to_string();
            assert!(message.contains("column 1 and row 1"), "{message}");
        }
        for (width, height, count) in [(0, 0, 0), (2, 2, 3), (2, 2, 5), (4, 0, 4)] {
            let pixels = vec![[1.0; 3]; count].into();
            assert!(Environment::new(width, height, pixels).is_err());
        }
    }
}
