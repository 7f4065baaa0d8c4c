//! The picture in memory: linear RGB in f32.

/// A finished picture: linear RGB, row by row from the top, each row from the
/// left.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    pixels: Vec<[f32; 3]>,
}

impl Film {
    /// The film with these pixels.
    ///
    /// # Panics
    /// When there are not `width * height` of them.
    #[must_use]
    pub fn new(width: u32, height: u32, pixels: Vec<[f32; 3]>) -> Self {
        assert_eq!(
            pixels.len() as u64,
            u64::from(width) * u64::from(height),
            "a film of {width} x {height} has one color per pixel"
        );
        Self {
            width,
            height,
            pixels,
        }
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

    /// All pixels, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }
}
