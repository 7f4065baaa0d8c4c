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
    pub tile: Tile,
    pub colors: &'a mut [[f32; 3]],
    pub words: &'a mut [u32],
}

/// What the samples of some pixels sum up to.
#[derive(Clone, Debug)]
pub(super) struct Sums {
    colors: Vec<DVec3>,
    /// Sums of squares; empty unless the variance is wanted.
    squares: Vec<DVec3>,
    /// Samples that hit; empty unless opacity is wanted. Then colors are of these alone.
    hits: Vec<u32>,
}

impl Sums {
    pub fn new(pixels: usize, channels: &Channels) -> Self {
        let of = |is_wanted: bool| if is_wanted { pixels } else { 0 };
        Self {
            colors: vec![DVec3::ZERO; pixels],
            squares: vec![DVec3::ZERO; of(channels.has_variance())],
            hits: vec![0; of(channels.has_opacity())],
        }
    }

    /// Adds a batch of samples, of which `pixel` says whose they are.
    pub fn add(&mut self, batch: &mut Batch, pixel: impl Fn(usize) -> usize) {
        if !self.hits.is_empty() {
            for sample in 0..batch.colors.len() {
                let is_hit = batch.is_hit(sample);
                self.hits[pixel(sample)] += u32::from(is_hit);
                if !is_hit {
                    batch.colors[sample] = DVec3::ZERO;
                }
            }
        }
        for (sample, color) in batch.colors.iter().enumerate() {
            self.colors[pixel(sample)] += *color;
        }
        if !self.squares.is_empty() {
            for (sample, color) in batch.colors.iter().enumerate() {
                self.squares[pixel(sample)] += *color * *color;
            }
        }
    }

    /// The sum of a pixel's colors.
    pub fn color(&self, pixel: usize) -> DVec3 {
        self.colors[pixel]
    }
}

/// Writes the pixels at the numbers `pixels` of `sums`, each with its column and row. `samples`
/// is the number of samples of a pixel that are in all of `sums` together.
pub(super) fn write(
    place: &mut Place,
    pixels: impl Iterator<Item = (usize, (u32, u32))>,
    sums: &[&Sums],
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
        let all = |of: fn(&Sums) -> &[DVec3]| -> DVec3 {
            sums.iter().filter_map(|sums| of(sums).get(pixel)).sum()
        };
        let sum = all(|sums| &sums.colors);
        let mean = sum / f64::from(samples);
        let at = ((y - place.tile.y) * place.tile.width + (x - place.tile.x)) as usize;
        place.colors[at] = mean.as_vec3().to_array();
        let covered: u32 = sums.iter().filter_map(|sums| sums.hits.get(pixel)).sum();
        let squares = all(|sums| &sums.squares);
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
        let middles: Vec<Ray> = pixels.map(|pixel| view.camera.ray(middle(pixel))).collect();
        rays.camera += middles.len() as u64;
        view.tracer.closest_batch_with(&middles, fields, &mut hits);
    }
    hits
}
