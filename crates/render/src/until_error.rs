//! Samples until the error of a tile is small enough.
//!
//! # The error
//! A pixel has two sequences of samples, each scrambled on its own (`sampler`), so that their
//! means `a` and `b` of `n` samples each are independent and equally distributed. The pixel's
//! value is `(a + b)/2`. As `E (a - b)² = 2 Var a` and `Var (a + b)/2 = (Var a)/2`,
//!
//! `v = (a - b)²/4`
//!
//! estimates the variance of the pixel's value without bias, although the samples of a sequence
//! are not independent: that they are spread evenly is in `a - b`. The error of a tile is the
//! root of the mean of `v` over its pixels and the components of their colors, divided by the
//! mean of these components, or by 0.01 (`spread`) where the tile is darker.
//!
//! # No bias
//! To stop when a tile looks good is a bias if the samples that are kept made it look so: a tile
//! that has not found its bright light yet looks good and is too dark. So the pixels of a
//! tile are divided at random into two halves, neither empty, and each half stops by the error of
//! the other one. (A tile of one pixel gets the greatest number of samples.) The number `N` of samples of a pixel is then a function of samples of other pixels,
//! which are independent of its own, and of nothing else. For every `n` the mean `M(n)` of its
//! samples has the expectation `I`, the pixel's true value, because every point of a scrambled
//! sequence is uniform, and every number of the sampler `random`. So
//! `E M(N) = Σ P(N = n) E M(n) = I`. A half that has stopped is sampled further while the other half
//! is undecided; these samples are not used for its own pixels. (The idea is that of the dual buffers
//! of Rousselle, Knaus, Zwicker, "Adaptive Rendering with Non-Local Means Filtering", ACM
//! Transactions on Graphics 31(6), 2012, with pixels in place of buffers, so that no pixel has half
//! of its samples.)
//!
//! A limit of time stops all tiles whatever their values are.
//!
//! `spread` derives how many samples an error needs, and how sure that is.

use std::time::{Duration, Instant};

use cyltrace::math::Random;
use rayon::prelude::*;

use super::integrator::Sample;
use super::kept::{Reached, Taken};
use super::outlines;
use super::place::{Place, Sums, write};
use super::rendering::{Work, pixels, stream, trace};
use super::sampler::PixelSampler;
use super::spread::{Spread, SpreadHistory};
use super::{RayCounts, RenderError, Settings, Tiles};

/// Sequences of a pixel.
const SEQUENCES: usize = 2;

/// The least number of samples of a pixel, one of each sequence.
pub(super) const LEAST_SAMPLES: u32 = SEQUENCES as u32;

/// The stream of random numbers of a pixel that decides its half, beside those of its sequences,
/// 1 and 2. Stream 0 has the samples of pictures with the same number everywhere.
const STREAM_OF_HALVES: u64 = 3;

/// When a picture has enough samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The greatest relative error of a tile. With 0, only tiles without noise stop early.
    pub error: f64,
    /// The time after which the rendering ends in any case, each tile with the samples that it
    /// has; each has a few. With it, the picture depends on the speed of the machine.
    pub time: Option<Duration>,
}

impl Target {
    /// The number of the rule that decides how many samples a tile gets. Parts of a picture belong
    /// together if they have the same one.
    pub const RULE: u32 = 2;

    /// The most samples that a pixel gets unless more or fewer are requested.
    pub const MOST_SAMPLES: u32 = 16_384;
}

/// Renders tiles on the rayon pool that this is called in.
pub(super) fn render(
    work: &Work,
    mut places: Vec<Place>,
    target: Target,
) -> Result<Taken, RenderError> {
    // A time that is too long to be added never ends.
    let deadline = target
        .time
        .and_then(|time| Instant::now().checked_add(time));
    let Some(deadline) = deadline else {
        // One tile after the other, so that few are in memory.
        return work.each_tile(places, |place| {
            let mut tile = TileSamples::new(work, target.error, place);
            while !tile.is_done() {
                tile.advance()?;
            }
            Ok(tile.taken())
        });
    };
    // All tiles side by side, so that none has much less when the time is over.
    let started = places.par_iter_mut().with_max_len(1);
    let started = started.map(|place| TileSamples::new(work, target.error, place));
    let mut tiles: Vec<_> = started.collect();
    loop {
        let rest = tiles.par_iter_mut().with_max_len(1);
        rest.filter(|tile| !tile.is_done()).try_for_each(|tile| {
            match tile.samples_of_each > 0 && Instant::now() >= deadline {
                true => {
                    tile.stop();
                    Ok(())
                }
                false => tile.advance(),
            }
        })?;
        if tiles.iter().all(TileSamples::is_done) {
            break;
        }
    }
    let all = tiles.into_iter().map(TileSamples::taken);
    Ok(all.fold(Taken::default(), Taken::and))
}

/// The bytes that the samples of all tiles take where they are taken side by side.
pub(super) fn samples_bytes(settings: &Settings) -> u64 {
    let pixels = u64::from(settings.film.width) * u64::from(settings.film.height);
    let of_pixel = size_of::<((u32, u32), usize)>()
        + SEQUENCES * size_of::<((u32, u32), PixelSampler)>()
        + SEQUENCES * Sums::bytes_each(&settings.channels);
    let of_spreads = 2 * SpreadHistory::MOST_BYTES;
    let of_tile = (size_of::<TileSamples>() + size_of::<Place>() + of_spreads) as u64;
    pixels * of_pixel as u64 + Tiles::of(settings.film).count() * of_tile
}

/// A tile while it is sampled.
struct TileSamples<'a, 'p> {
    work: &'a Work<'a>,
    error: f64,
    place: &'a mut Place<'p>,
    /// Column, row and half of each pixel.
    pixels: Vec<((u32, u32), usize)>,
    samplers: [Vec<PixelSampler>; SEQUENCES],
    sums: Sums,
    /// Samples of each sequence so far.
    samples_of_each: u32,
    /// How the values that decide for each half, those of the other one, spread while it was
    /// undecided.
    spreads: [SpreadHistory; 2],
    /// The number of samples at which each half stops, once that is decided.
    ends: [Option<u32>; 2],
    /// What each half has come to, once it has stopped.
    stopped: [Option<Spread>; 2],
    rays: RayCounts,
    samples: u64,
}

impl<'a, 'p> TileSamples<'a, 'p> {
    fn new(work: &'a Work<'a>, error: f64, place: &'a mut Place<'p>) -> Self {
        let settings = work.settings;
        let all = [1, 2].map(|sequence| pixels(&place.tile, settings, sequence));
        let half = |position| {
            let stream = stream(position, settings, STREAM_OF_HALVES);
            Random::new(settings.seed, stream).below(2) as usize
        };
        let positions = all[0].iter().map(|&(position, _)| position);
        let mut halves: Vec<_> = positions.map(|one| (one, half(one))).collect();
        if let [first, rest @ ..] = &mut halves[..]
            && rest.iter().all(|(_, half)| *half == first.1)
        {
            first.1 = 1 - first.1;
        }
        let sums = Sums::new(all[0].len(), SEQUENCES, &settings.channels);
        Self {
            work,
            error,
            place,
            pixels: halves,
            samplers: all.map(|pixels| pixels.into_iter().map(|(_, sampler)| sampler).collect()),
            sums,
            samples_of_each: 0,
            spreads: [SpreadHistory::default(), SpreadHistory::default()],
            ends: [None, None],
            stopped: [None, None],
            rays: RayCounts::default(),
            samples: 0,
        }
    }

    fn is_done(&self) -> bool {
        self.stopped.iter().all(Option::is_some)
    }

    /// The number of samples at which a half that has not stopped is decided or stops.
    fn due(&self, half: usize) -> u32 {
        self.ends[half].unwrap_or_else(|| self.spreads[half].next(self.error))
    }

    /// Takes samples up to the next number at which something is decided or stops.
    fn advance(&mut self) -> Result<(), RenderError> {
        let settings = self.work.settings;
        let most = (settings.spp / LEAST_SAMPLES).max(1);
        let has_time = settings.target.is_some_and(|target| target.time.is_some());
        let taken = self.samples_of_each;
        let step_end = match has_time && taken > 0 {
            // With a limit of time, a step is at most an eighth of the next power of two, so that
            // little time passes after the end.
            true => taken + ((taken + 1).next_power_of_two() / 8).max(1),
            false => u32::MAX,
        };
        let due = [0, 1].map(|half| match self.stopped[half] {
            Some(_) => u32::MAX,
            None => self.due(half),
        });
        let end = due[0].min(due[1]).min(most).min(step_end);
        self.sample(end)?;
        for half in [0, 1] {
            if due[half] == end && self.ends[half].is_none() {
                self.decide(half);
            }
        }
        for half in [0, 1] {
            let is_over = end == most || self.ends[half] == Some(end);
            if self.stopped[half].is_none() && is_over {
                self.stop_half(half);
            }
        }
        Ok(())
    }

    /// Decides when a half stops, if the other half's values say so already.
    fn decide(&mut self, half: usize) {
        let spread = self.spread(1 - half);
        let spreads = &mut self.spreads[half];
        spreads.push(self.samples_of_each, spread);
        self.ends[half] = spreads.enough(self.error);
    }

    /// Takes samples up to a number, of the halves that have not stopped or decide.
    fn sample(&mut self, end: u32) -> Result<(), RenderError> {
        let decides = |half: usize| self.ends[1 - half].is_none();
        let is_sampled = [0, 1].map(|half| self.stopped[half].is_none() || decides(half));
        let numbers = 0..self.pixels.len();
        let pixels: Vec<_> = numbers
            .filter(|&one| is_sampled[self.pixels[one].1])
            .collect();
        let more = u64::from(end - self.samples_of_each);
        // The samples of a pixel are neighbours, those of both sequences.
        let place = |number: u64| {
            let sequence = (number / more) as usize;
            (pixels[sequence / SEQUENCES], sequence % SEQUENCES)
        };
        let sample = |number: u64| {
            let (pixel, sequence) = place(number);
            Sample {
                pixel: self.pixels[pixel].0,
                sampler: self.samplers[sequence][pixel],
                number: self.samples_of_each + (number % more) as u32,
            }
        };
        let count = (pixels.len() * SEQUENCES) as u64 * more;
        let sums = &mut self.sums;
        trace(self.work, count, sample, &mut self.rays, |first, batch| {
            sums.add(batch, |sample| {
                let (pixel, sequence) = place(first + sample as u64);
                pixel * SEQUENCES + sequence
            });
        })?;
        self.samples_of_each = end;
        Ok(())
    }

    /// Stops with the samples so far.
    fn stop(&mut self) {
        for half in [0, 1] {
            if self.stopped[half].is_none() {
                self.stop_half(half);
            }
        }
    }

    fn stop_half(&mut self, half: usize) {
        let pixels = self.pixels.iter().enumerate();
        let own = pixels.filter(|(_, (_, of))| *of == half);
        let own = own.map(|(pixel, (position, _))| (pixel, *position));
        let samples = SEQUENCES as u32 * self.samples_of_each;
        let count = own.clone().count() as u64;
        let (view, channels) = (self.work.view, &self.work.settings.channels);
        write(
            self.place,
            own,
            &self.sums,
            samples,
            channels,
            view,
            &mut self.rays,
        );
        self.stopped[half] = Some(self.spread(half));
        self.samples += count * u64::from(samples);
        (self.work.watch.progress)(count);
    }

    /// How the values of a half spread.
    fn spread(&self, half: usize) -> Spread {
        let mut spread = Spread::default();
        for (pixel, (_, of)) in self.pixels.iter().enumerate() {
            if *of == half {
                let count = f64::from(self.samples_of_each);
                let sums = self.sums.colors(pixel);
                let (first, second) = (sums[0] / count, sums[1] / count);
                let variance = (first - second).length_squared() / 12.0;
                spread.pixels += 1.0;
                spread.values += (first + second).element_sum() / 6.0;
                spread.variances += variance;
                spread.squares += variance * variance;
            }
        }
        spread
    }

    fn taken(mut self) -> Taken {
        let (view, channels) = (self.work.view, &self.work.settings.channels);
        outlines::draw(self.place, channels, view, &mut self.rays);
        let halves = self.stopped.map(Option::unwrap_or_default);
        let error = halves[0].and(halves[1]).error();
        Taken {
            rays: self.rays,
            reached: Reached {
                error: error as f32,
                tiles_above: u64::from(error > self.error),
                samples: self.samples,
            },
        }
    }
}
