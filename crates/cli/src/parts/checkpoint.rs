//! The finished tiles of a picture in a checkpoint: what a tile took, little-endian, and its pixels
//! as in a part.

use std::fs::File;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use anyhow::Context;
use cyltrace_parts::{Checkpoint, CheckpointError, Header};
use cyltrace_render::{KeptTiles, RayCounts, Reached, Taken};

use super::render::{pixel, pixel_bytes, write_pixels};

/// What an earlier run had rendered.
#[derive(Clone, Copy, Debug)]
pub struct Earlier {
    pub tiles: u64,
    pub rays: u64,
}

/// Tiles in a checkpoint.
pub struct KeptInFile {
    file: Checkpoint,
    /// The name of the file in messages.
    name: String,
    /// The number of all tiles.
    whole: u64,
    /// The tiles and rays of an earlier run that this one has restored.
    tiles: AtomicU64,
    rays: AtomicU64,
}

impl KeptInFile {
    /// Opens the checkpoint of the picture with this header, or begins one.
    pub fn open(path: &Path, header: &Header) -> Result<Self, CheckpointError> {
        Ok(Self {
            file: Checkpoint::open(path, header)?,
            name: format!("{path:?}"),
            whole: header.whole,
            tiles: AtomicU64::new(0),
            rays: AtomicU64::new(0),
        })
    }

    /// What is in the checkpoint, where it is not new.
    pub fn opened_text(&self) -> Option<String> {
        let (tiles, dropped) = (self.file.earlier_units(), self.file.dropped_bytes());
        let damage = match dropped {
            0 => String::new(),
            _ => format!("; its last {dropped} bytes were incomplete or damaged, and are removed"),
        };
        let (name, whole) = (&self.name, self.whole);
        (tiles > 0 || dropped > 0)
            .then(|| format!("{name} has {tiles} of {whole} tiles of an earlier run{damage}"))
    }

    /// What was restored.
    pub fn earlier(&self) -> Earlier {
        Earlier {
            tiles: self.tiles.load(Ordering::Relaxed),
            rays: self.rays.load(Ordering::Relaxed),
        }
    }

    /// Writes all finished tiles. Returns a message if they could not all be written.
    pub fn flush(&self) -> Option<String> {
        self.file.flush();
        let failure = self.file.failure()?;
        Some(format!(
            "the checkpoint {} lacks tiles: {failure}",
            self.name
        ))
    }

    /// Removes the file after the picture is on the disk, where that is a file: only then the
    /// checkpoint is of no more use.
    pub fn end(self, picture: &Path) -> anyhow::Result<()> {
        let synced = File::open(picture).and_then(|file| match file.metadata()?.is_file() {
            true => file.sync_all(),
            false => Ok(()),
        });
        synced.with_context(|| format!("cannot sync {picture:?}; the checkpoint is kept"))?;
        Ok(self.file.remove()?)
    }
}

impl KeptTiles for KeptInFile {
    fn restore(&self, tile: u64, colors: &mut [[f32; 3]], words: &mut [u32]) -> Option<Taken> {
        let bytes = self.file.earlier(tile)?;
        let (taken, pixels) = bytes.split_at_checked(TAKEN)?;
        let each = words.len() / colors.len().max(1);
        if pixels.len() != colors.len() * pixel_bytes(each) {
            return None;
        }
        for (number, bytes) in pixels.chunks_exact(pixel_bytes(each)).enumerate() {
            let (color, own) = pixel(bytes);
            colors[number] = color;
            for (to, word) in words[number * each..].iter_mut().zip(own) {
                *to = word;
            }
        }
        let taken = taken_of(taken);
        self.tiles.fetch_add(1, Ordering::Relaxed);
        self.rays.fetch_add(taken.rays.total(), Ordering::Relaxed);
        Some(taken)
    }

    fn keep(&self, tile: u64, colors: &[[f32; 3]], words: &[u32], taken: &Taken) {
        let mut bytes = bytes_of(taken);
        if write_pixels(&mut bytes, colors, words).is_ok() {
            self.file.add(tile, &bytes);
        }
    }
}

/// Bytes of what a tile took: the rays of each purpose, and what was reached.
const TAKEN: usize = 7 * 8;

fn bytes_of(taken: &Taken) -> Vec<u8> {
    let Reached {
        error,
        tiles_above,
        samples,
    } = taken.reached;
    let rays = taken.rays.by_purpose();
    let reached = [error.to_bits().into(), tiles_above, samples];
    let numbers = rays.into_iter().chain(reached);
    numbers.flat_map(u64::to_le_bytes).collect()
}

fn taken_of(bytes: &[u8]) -> Taken {
    let (numbers, _) = bytes.as_chunks();
    let mut numbers = numbers.iter().map(|&number| u64::from_le_bytes(number));
    let mut next = || numbers.next().unwrap_or_default();
    Taken {
        rays: RayCounts {
            camera: next(),
            shadow: next(),
            ao: next(),
            scattered: next(),
        },
        reached: Reached {
            error: f32::from_bits(next() as u32),
            tiles_above: next(),
            samples: next(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_tile_took_is_read_back() {
        let taken = Taken {
            rays: RayCounts {
                camera: 1,
                shadow: u64::MAX,
                ao: 3,
                scattered: 4,
            },
            reached: Reached {
                error: 0.1,
                tiles_above: 1,
                samples: 77,
            },
        };
        let bytes = bytes_of(&taken);
        assert_eq!(bytes.len(), TAKEN);
        assert_eq!(taken_of(&bytes), taken);
    }
}
