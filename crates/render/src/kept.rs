//! Tiles that outlive a rendering, so that a later one of the same picture need not make them again.

use super::RayCounts;

/// What a picture with a [`crate::Target`] has reached.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reached {
    /// The greatest error of a tile, as estimated from its own samples.
    pub error: f32,
    /// The number of tiles whose estimated error is greater than the target's.
    pub tiles_above: u64,
    /// The samples of all pixels.
    pub samples: u64,
}

impl Reached {
    /// What both have reached together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            error: self.error.max(other.error),
            tiles_above: self.tiles_above + other.tiles_above,
            samples: self.samples + other.samples,
        }
    }
}

/// What tiles took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Taken {
    /// The rays traced.
    pub rays: RayCounts,
    /// What was reached; zeros without a target.
    pub reached: Reached,
}

impl Taken {
    /// What both took together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            rays: self.rays + other.rays,
            reached: self.reached.and(other.reached),
        }
    }
}

/// Keeps finished tiles of a picture. Both functions are called from any of the threads, at most
/// once for each tile.
pub trait KeptTiles: Sync {
    /// Fills the colors and the words of a tile that an earlier rendering has finished, in the
    /// order of [`super::RenderedTiles`], and returns what it took then. `None` if there is no
    /// such tile; then the tile is rendered.
    fn restore(&self, tile: u64, colors: &mut [[f32; 3]], words: &mut [u32]) -> Option<Taken>;

    /// Keeps a tile that this rendering has finished.
    fn keep(&self, tile: u64, colors: &[[f32; 3]], words: &[u32], taken: &Taken);
}
