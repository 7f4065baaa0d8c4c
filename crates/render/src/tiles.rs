//! The picture's tiles.

use std::ops::Range;

use cyltrace::scene;

/// Edge of a tile in pixels: near rays share what they read, and even a small
/// picture has tiles for many threads.
const TILE: u32 = 16;
const _: () = assert!(TILE <= 16, "`every_second_bit` has four bits");

/// A tile and its place in the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tile {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

/// The tiles of a picture, row by row from the top, each row from the left.
#[derive(Clone, Copy, Debug)]
pub struct Tiles {
    size: scene::Film,
}

impl Tiles {
    /// The tiles of a picture of this size, at least 1 x 1.
    #[must_use]
    pub fn of(size: scene::Film) -> Self {
        Self { size }
    }

    /// The number of tiles.
    #[must_use]
    pub fn count(self) -> u64 {
        let down = self.size.height.div_ceil(TILE);
        u64::from(self.across()) * u64::from(down)
    }

    /// The numbers of all tiles.
    #[must_use]
    pub fn all(self) -> Range<u64> {
        0..self.count()
    }

    /// The number of pixels of some tiles.
    #[must_use]
    pub fn pixels(self, tiles: Range<u64>) -> u64 {
        // Whole rows of tiles, and then the tiles of a last row.
        let before = |tile: u64| {
            let (row, column) = self.row_and_column(tile);
            let top = u64::from((row * TILE).min(self.size.height));
            let height = u64::from(TILE.min(self.size.height - top as u32));
            let left = u64::from((column * TILE).min(self.size.width));
            top * u64::from(self.size.width) + height * left
        };
        before(tiles.end) - before(tiles.start)
    }

    /// Puts the pixels of whole rows of tiles, tile by tile, in the order of a picture: row by
    /// row. The pixels must be those of the tiles from the left of `first_row`, a row of tiles,
    /// on; `pixels` of whole rows of tiles, each of `each` values.
    ///
    /// # Panics
    /// If the pixels are not those of whole rows of tiles.
    pub fn arrange<T: Copy + Default>(
        self,
        first_row: u64,
        each: usize,
        pixels: &[T],
        arranged: &mut Vec<T>,
    ) {
        let width = self.size.width as usize;
        arranged.clear();
        arranged.resize(pixels.len(), T::default());
        let first = first_row * u64::from(self.across());
        let top = first_row as usize * TILE as usize;
        let mut rest = pixels;
        for number in first.. {
            if rest.is_empty() {
                break;
            }
            let tile = self.tile(number);
            let (values, later) = rest.split_at(tile.pixels() * each);
            let rows = values.chunks_exact(tile.width as usize * each);
            for (row, values) in rows.enumerate() {
                let start = (tile.y as usize - top + row) * width + tile.x as usize;
                arranged[start * each..][..values.len()].copy_from_slice(values);
            }
            rest = later;
        }
    }

    /// The number of rows of tiles.
    #[must_use]
    pub fn rows(self) -> u64 {
        u64::from(self.size.height.div_ceil(TILE))
    }

    /// The tiles of a row of tiles.
    #[must_use]
    pub fn row(self, row: u64) -> Range<u64> {
        let across = u64::from(self.across());
        row * across..(row + 1) * across
    }

    fn across(self) -> u32 {
        self.size.width.div_ceil(TILE)
    }

    fn row_and_column(self, tile: u64) -> (u32, u32) {
        let across = u64::from(self.across());
        ((tile / across) as u32, (tile % across) as u32)
    }

    pub(super) fn tile(self, number: u64) -> Tile {
        let (row, column) = self.row_and_column(number);
        let (x, y) = (column * TILE, row * TILE);
        Tile {
            x,
            y,
            width: TILE.min(self.size.width - x),
            height: TILE.min(self.size.height - y),
        }
    }
}

impl Tile {
    /// The number of pixels.
    pub fn pixels(&self) -> usize {
        (self.width * self.height) as usize
    }

    /// Columns and rows of the tile along a curve of Morton's, whose runs of 4,
    /// 16, 64 are squares.
    pub fn pixels_along_curve(&self) -> impl Iterator<Item = (u32, u32)> {
        let (width, height) = (self.width, self.height);
        (0..TILE * TILE)
            .map(|place| (every_second_bit(place), every_second_bit(place >> 1)))
            .filter(move |&(column, row)| column < width && row < height)
    }
}

/// The number whose bits are bits 0, 2, 4 and 6.
fn every_second_bit(bits: u32) -> u32 {
    bits & 1 | bits >> 1 & 2 | bits >> 2 & 4 | bits >> 3 & 8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_counted_by_their_pixels_and_arranged_in_place() {
        for (width, height) in [(1, 1), (16, 16), (17, 33), (75, 50), (32, 15)] {
            let size = scene::Film { width, height };
            let tiles = Tiles::of(size);
            // Pixels that contain their own place, in the order of the tiles.
            let mut pixels = Vec::new();
            for number in 0..tiles.count() {
                let tile = tiles.tile(number);
                let start = pixels.len() as u64;
                assert_eq!(tiles.pixels(0..number), start, "{width}x{height}");
                for y in tile.y..tile.y + tile.height {
                    let row = tile.x..tile.x + tile.width;
                    pixels.extend(row.map(|x| [x as f32, y as f32, 0.0]));
                }
            }
            assert_eq!(pixels.len() as u32, width * height);
            let mut arranged = Vec::new();
            let mut rows = Vec::new();
            for row in 0..tiles.rows() {
                let range = tiles.row(row);
                let start = tiles.pixels(0..range.start) as usize;
                let count = tiles.pixels(range) as usize;
                tiles.arrange(row, 1, &pixels[start..start + count], &mut rows);
                arranged.append(&mut rows);
            }
            let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
            for (pixel, (x, y)) in arranged.into_iter().zip(places) {
                assert_eq!(pixel, [x as f32, y as f32, 0.0], "{width}x{height}");
            }
            tiles.arrange(0, 1, &pixels, &mut rows);
            assert_eq!(rows.len(), pixels.len());
            let values = pixels.as_flattened();
            let mut arranged = Vec::new();
            tiles.arrange(0, 3, values, &mut arranged);
            assert_eq!(arranged, rows.as_flattened());
        }
    }
}
