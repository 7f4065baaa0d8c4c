//! Where the pixels of a tile are written, and what their samples sum up to.

use std::ops::Range;

use cyltrace::math::Ray;
use cyltrace::tracer::PartialHit;
use glam::{DVec2, DVec3};

use super::RayCounts;
use super::channels::{Channels, PixelValues};
use super::integrator::{Batch, View};
use super::tiles::{Tile, Tiles};

/// The colors and words of some tiles, in the order of the tiles, those of a tile row by row.
#[derive(Debug, Default)]
pub(super) struct Pixels {
    pub colors: Vec<[f32; 3]>,
    pub words: Vec<u32>,
}

impl Pixels {
    /// Black pixels. A large picture is in memory once.
    pub fn new(pixels: u64, words: usize) -> Self {
        Self {
            colors: vec![[0.0; 3]; pixels as usize],
            words: vec![0; pixels as usize * words],
        }
    }

    /// The places of the tiles.
    pub fn places(&mut self, tiles: Tiles, numbers: Range<u64>, words: usize) -> Vec<Place<'_>> {
        let (mut colors, mut rest) = (&mut self.colors[..], &mut self.words[..]);
        let mut places = Vec::new();
        for number in numbers {
            let tile = tiles.tile(number);
            let pixels = tile.pixels();
            let (own, later) = colors.split_at_mut(pixels);
            let (own_words, later_words) = rest.split_at_mut(pixels * words);
            places.push(Place {
                number,
                tile,
                colors: own,
                words: own_words,
            });
            (colors, rest) = (later, later_words);
        }
        places
    }
}

/// The place of a tile's pixels.
pub(super) struct Place<'a> {
    /// The number of the tile.
    pub number: u64,
    pub tile: Tile,
    pub colors: &'a mut [[f32; 3]],
    pub words: &'a mut [u32],
}

/// What the samples of some pixels sum up to, each of their sequences by itself. The sums of a
/// pixel's sequences are next to each other.
#[derive(Clone, Debug)]
pub(super) struct Sums {
    sequences: usize,
    colors: Vec<DVec3>,
    /// Sums of squares; empty unless the variance is requested.
    squares: Vec<DVec3>,
    /// Samples that hit; empty unless opacity is requested. Then colors are of these alone.
    hits: Vec<u32>,
}

impl Sums {
    pub fn new(pixels: usize, sequences: usize, channels: &Channels) -> Self {
        let all = pixels * sequences;
        let of = |is_requested: bool| if is_requested { all } else { 0 };
        Self {
            sequences,
            colors: vec![DVec3::ZERO; all],
            squares: vec![DVec3::ZERO; of(channels.has_variance())],
            hits: vec![0; of(channels.has_opacity())],
        }
    }

    /// The bytes of a sequence of a pixel.
    pub fn bytes_each(channels: &Channels) -> usize {
        let of = |is_requested: bool, bytes| if is_requested { bytes } else { 0 };
        size_of::<DVec3>()
            + of(channels.has_variance(), size_of::<DVec3>())
            + of(channels.has_opacity(), size_of::<u32>())
    }

    /// Adds a batch of samples. `place` is the pixel of a sample by its number in the batch, times
    /// the number of sequences, plus the sample's sequence.
    pub fn add(&mut self, batch: &mut Batch, place: impl Fn(usize) -> usize) {
        if !self.hits.is_empty() {
            for sample in 0..batch.colors.len() {
                let is_hit = batch.is_hit(sample);
                self.hits[place(sample)] += u32::from(is_hit);
                if !is_hit {
                    batch.colors[sample] = DVec3::ZERO;
                }
            }
        }
        for (sample, color) in batch.colors.iter().enumerate() {
            self.colors[place(sample)] += *color;
        }
        if !self.squares.is_empty() {
            for (sample, color) in batch.colors.iter().enumerate() {
                self.squares[place(sample)] += *color * *color;
            }
        }
    }

    /// The sums of a pixel's colors, of each sequence.
    pub fn colors(&self, pixel: usize) -> &[DVec3] {
        self.of(&self.colors, pixel)
    }

    /// What a list has of a pixel.
    fn of<'a, T>(&self, list: &'a [T], pixel: usize) -> &'a [T] {
        let start = pixel * self.sequences;
        list.get(start..start + self.sequences).unwrap_or_default()
    }
}

/// Writes the pixels at the numbers `pixels` of `sums`, each with its column and row. `samples`
/// is the number of samples of a pixel in all sequences together.
pub(super) fn write(
    place: &mut Place,
    pixels: impl Iterator<Item = (usize, (u32, u32))>,
    sums: &Sums,
    samples: u32,
    channels: &Channels,
    view: &View,
    rays: &mut RayCounts,
) {
    let pixels: Vec<_> = pixels.collect();
    let positions = pixels.iter().map(|(_, position)| *position);
    let hits = middle_hits(view, positions, channels, rays);
    let mut words = Vec::new();
    for (number, (pixel, (x, y))) in pixels.into_iter().enumerate() {
        let sum: DVec3 = sums.colors(pixel).iter().sum();
        let mean = sum / f64::from(samples);
        let at = ((y - place.tile.y) * place.tile.width + (x - place.tile.x)) as usize;
        place.colors[at] = mean.as_vec3().to_array();
        let covered: u32 = sums.of(&sums.hits, pixel).iter().sum();
        let squares: DVec3 = sums.of(&sums.squares, pixel).iter().sum();
        let values = PixelValues {
            hit: hits.get(number).and_then(Option::as_ref),
            opacity: covered as f32 / samples as f32,
            variance: variance(sum, squares, samples),
            samples,
        };
        words.clear();
        channels.push(&values, &view.colors, &mut words);
        place.words[at * words.len()..][..words.len()].copy_from_slice(&words);
    }
}

/// The variance of samples, estimated from their sum and the sum of their squares; 0 for one.
fn variance(sum: DVec3, squares: DVec3, samples: u32) -> DVec3 {
    let count = f64::from(samples);
    ((squares - sum * sum / count) / (count - 1.0).max(1.0)).max(DVec3::ZERO)
}

/// The first hits of the rays through the middles of pixels; none if no channel needs them.
fn middle_hits(
    view: &View,
    pixels: impl Iterator<Item = (u32, u32)>,
    channels: &Channels,
    rays: &mut RayCounts,
) -> Vec<Option<PartialHit>> {
    let mut hits = Vec::new();
    if let Some(fields) = channels.fields(&view.colors) {
        let middle = |(x, y)| DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let mut middles: Vec<Ray> = pixels.map(|pixel| view.camera.ray(middle(pixel))).collect();
        rays.camera += middles.len() as u64;
        view.first_hits(&mut middles, fields, &mut hits);
    }
    hits
}
