//! The samples of tiles, spread over threads.
//!
//! A pixel is a pure function of its index, so the picture does not depend on
//! which thread computes what, or when.

use std::sync::atomic::Ordering;

use rayon::prelude::*;

use super::integrator::{Batch, Sample, View};
use super::kept::Taken;
use super::outlines;
use super::place::{Place, Sums, write};
use super::sampler::PixelSampler;
use super::tiles::Tile;
use super::{RayCounts, RenderError, Settings, Watch};

/// Samples that are traced together: many, so that those whose rays are near each other share
/// packets and caches, and few enough that rays and hits, about 0.6 MB, stay in a core's
/// cache. A forest renders in 0.97 of the time that 256 take, a lattice in the same.
const SAMPLES_AT_ONCE: usize = 2048;

/// What all tiles have in common.
pub(super) struct Work<'a> {
    pub view: &'a View<'a>,
    pub settings: &'a Settings,
    pub watch: &'a Watch<'a>,
}

impl Work<'_> {
    /// Restores each tile that is kept, and lets `render` make the others.
    pub fn each_tile(
        &self,
        places: Vec<Place>,
        render: impl Fn(&mut Place) -> Result<Taken, RenderError> + Sync,
    ) -> Result<Taken, RenderError> {
        let tile = |mut place: Place| {
            let Some(kept) = self.watch.kept else {
                return render(&mut place);
            };
            if let Some(taken) = kept.restore(place.number, place.colors, place.words) {
                (self.watch.progress)(place.colors.len() as u64);
                return Ok(taken);
            }
            let taken = render(&mut place)?;
            kept.keep(place.number, place.colors, place.words, &taken);
            Ok(taken)
        };
        places
            .into_par_iter()
            // At the end of a part, threads wait for a tile, not for a share of them.
            .with_max_len(1)
            .map(tile)
            .try_reduce(Taken::default, |all, tile| Ok(all.and(tile)))
    }
}

/// Renders tiles on the rayon pool that this is called in, with the same number of samples for
/// every pixel.
pub(super) fn render(work: &Work, places: Vec<Place>) -> Result<Taken, RenderError> {
    work.each_tile(places, |place| {
        let rays = render_tile(work, place)?;
        (work.watch.progress)(place.colors.len() as u64);
        Ok(Taken {
            rays,
            ..Taken::default()
        })
    })
}

/// Renders the pixels of a tile, and returns the rays they took.
fn render_tile(work: &Work, place: &mut Place) -> Result<RayCounts, RenderError> {
    let settings = work.settings;
    let pixels = pixels(&place.tile, settings, 0);
    let mut sums = Sums::new(pixels.len(), 1, &settings.channels);
    let mut rays = RayCounts::default();
    // Samples of a pixel are neighbours, and those of its neighbours next to
    // them.
    let spp = u64::from(settings.spp);
    let count = pixels.len() as u64 * spp;
    let pixel = |number: u64| (number / spp) as usize;
    let sample = |number: u64| {
        let (position, sampler) = pixels[pixel(number)];
        Sample {
            pixel: position,
            sampler,
            number: (number % spp) as u32,
        }
    };
    trace(work, count, sample, &mut rays, |first, batch| {
        sums.add(batch, |sample| pixel(first + sample as u64));
    })?;
    let positions = pixels.iter().map(|(position, _)| *position).enumerate();
    let channels = &settings.channels;
    write(
        place,
        positions,
        &sums,
        settings.spp,
        channels,
        work.view,
        &mut rays,
    );
    outlines::draw(place, channels, work.view, &mut rays);
    Ok(rays)
}

/// The pixels of a tile with their columns and rows in the picture, along a curve that keeps
/// neighbours together, and the numbers of one of their sequences of samples.
pub(super) fn pixels(
    tile: &Tile,
    settings: &Settings,
    sequence: u64,
) -> Vec<((u32, u32), PixelSampler)> {
    let pixel = |(column, row)| {
        let position = (tile.x + column, tile.y + row);
        (
            position,
            PixelSampler::new(
                settings.sampler,
                settings.seed,
                stream(position, settings, sequence),
            ),
        )
    };
    tile.pixels_along_curve().map(pixel).collect()
}

/// The number of a stream of random numbers of a pixel. A picture has less than 2^32 pixels.
pub(super) fn stream((x, y): (u32, u32), settings: &Settings, sequence: u64) -> u64 {
    let pixel = u64::from(y) * u64::from(settings.film.width) + u64::from(x);
    sequence << 32 | pixel
}

/// Traces samples with the numbers from 0 to `count`, many at a time. `take` gets the number of
/// the first one of a batch, and the batch.
pub(super) fn trace(
    work: &Work,
    count: u64,
    sample: impl Fn(u64) -> Sample,
    rays: &mut RayCounts,
    mut take: impl FnMut(u64, &mut Batch),
) -> Result<(), RenderError> {
    let (mut batch, mut samples) = (Batch::default(), Vec::new());
    for first in (0..count).step_by(SAMPLES_AT_ONCE) {
        if work.watch.cancelled.load(Ordering::Relaxed) {
            return Err(RenderError::Cancelled);
        }
        let numbers = first..count.min(first + SAMPLES_AT_ONCE as u64);
        samples.clear();
        samples.extend(numbers.map(&sample));
        work.view.trace(&samples, &mut batch, rays);
        take(first, &mut batch);
    }
    Ok(())
}
