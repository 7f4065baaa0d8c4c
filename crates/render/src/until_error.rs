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
//! tile are divided at random into two halves, and each half stops by the error of the other
//! one. The number `N` of samples of a pixel is then a function of samples of other pixels,
//! which are independent of its own, and of nothing else. For every `n` the mean `M(n)` of its
//! samples has the expectation `I`, the pixel's true value, because every point of a scrambled
//! sequence is uniform, and every number of the sampler `random`. So
//! `E M(N) = Σ P(N = n) E M(n) = I`. Until both halves have stopped, both are sampled; what the one
//! that stopped first gets after that is not used for its own pixels. (The idea is that of the dual buffers of Rousselle, Knaus, Zwicker, "Adaptive
//! Rendering with Non-Local Means Filtering", ACM Transactions on Graphics 31(6), 2012, with
//! pixels in place of buffers, so that no pixel has half of its samples.)
//!
//! A limit of time stops all tiles whatever their values are.
//!
//! # The promise
//! A tile stops when the error is small enough with a probability of about 95 %. With `S` the
//! sum of `v` over the values of a half, normal `a` and `b` make each `v` its variance `σ²`
//! times a chi-squared variable of one degree of freedom, so that `E v² = 3 σ⁴`. The squared
//! error that the half will have varies by `2 Σ σ⁴`, `S` itself by as much, together by
//! `4/3 Σ v²`. Of a tile of two such halves the relative deviation is `1/√2` of that. So a half
//! stops where `S + 1.645/√2 √(4/3 Σ v²)` is at most the target's. The components of a color
//! are taken as one value, since they vary together.
//!
//! # When is decided
//! A half is decided at numbers of samples of two or three significant bits, each a fifth or so
//! above the one before. Far from the target most decisions are unneeded, and small steps trace few
//! samples of a pixel together, which costs time. So after a decision the next one is
//! at the number where the error is expected to be nearly small enough ([`next`]). That number is
//! computed from the other half's samples too, so that `N` remains a function of them alone. With a
//! limit of time, no number is left out.

use std::time::{Duration, Instant};

use cyltrace::math::Random;
use rayon::prelude::*;

use super::integrator::Sample;
use super::kept::{Reached, Taken};
use super::outlines;
use super::place::{Place, Sums, write};
use super::rendering::{Work, pixels, stream, trace};
use super::sampler::PixelSampler;
use super::spread::Spread;
use super::{RayCounts, RenderError, Settings, Tiles};

/// Samples of a sequence before the first decision. Fewer would decide by luck.
const FIRST: u32 = 4;

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
    let of_tile = (size_of::<TileSamples>() + size_of::<Place>()) as u64;
    pixels * of_pixel as u64 + Tiles::of(settings.film).count() * of_tile
}

/// How fast the squared error is taken to fall, `N^(-1/FALL)`. It falls as `N^-1` or faster; less
/// is expected of more samples than they do, so that few tiles take more than they need.
const FALL: f64 = 0.8;

/// Most growth of a number of samples between two decisions: the first estimates are rough.
const MOST_GROWTH: f64 = 4.0;

/// The number of samples of a sequence at which a half is decided after `taken`, where the squared
/// error was `excess` times the greatest that would be small enough.
fn next(taken: u32, excess: f64) -> u32 {
    if taken == 0 {
        return FIRST;
    }
    // The numbers up to the next power of two are a multiple of an eighth of it.
    let unit = |number: u32| (number.next_power_of_two() / 8).max(1);
    let least = taken + unit(taken + 1);
    let growth = libm::pow(excess, FALL).clamp(1.0, MOST_GROWTH);
    let expected = (f64::from(taken) * growth) as u32;
    (expected / unit(expected) * unit(expected)).max(least)
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
    /// The number of samples at which each half is decided next.
    due: [u32; 2],
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
        let halves = all[0]
            .iter()
            .map(|&(position, _)| (position, half(position)));
        let sums = Sums::new(all[0].len(), SEQUENCES, &settings.channels);
        Self {
            work,
            error,
            place,
            pixels: halves.collect(),
            samplers: all.map(|pixels| pixels.into_iter().map(|(_, sampler)| sampler).collect()),
            sums,
            samples_of_each: 0,
            due: [next(0, 1.0); 2],
            stopped: [None, None],
            rays: RayCounts::default(),
            samples: 0,
        }
    }

    fn is_done(&self) -> bool {
        self.stopped.iter().all(Option::is_some)
    }

    /// Takes samples up to the next decision, and decides.
    fn advance(&mut self) -> Result<(), RenderError> {
        let most = (self.work.settings.spp / LEAST_SAMPLES).max(1);
        let halves = [0, 1].into_iter();
        let due = halves.filter(|&half| self.stopped[half].is_none());
        let due = due.map(|half| self.due[half]).min();
        let end = due.unwrap_or(most).min(most);
        let more = u64::from(end - self.samples_of_each);
        // The samples of a pixel are neighbours, those of both sequences.
        let place = |number: u64| (number / more) as usize;
        let sample = |number: u64| {
            let (pixel, sequence) = (place(number) / SEQUENCES, place(number) % SEQUENCES);
            Sample {
                pixel: self.pixels[pixel].0,
                sampler: self.samplers[sequence][pixel],
                number: self.samples_of_each + (number % more) as u32,
            }
        };
        let count = (self.pixels.len() * SEQUENCES) as u64 * more;
        let sums = &mut self.sums;
        trace(self.work, count, sample, &mut self.rays, |first, batch| {
            sums.add(batch, |sample| place(first + sample as u64));
        })?;
        self.samples_of_each = end;
        let spreads = [0, 1].map(|half| self.spread(half));
        for half in [0, 1] {
            // A tile of few pixels may have all of them in one half, which then decides for itself.
            let other = match spreads[1 - half].pixels > 0.0 {
                true => spreads[1 - half],
                false => spreads[half],
            };
            if self.stopped[half].is_none() && (end >= self.due[half] || end == most) {
                match end == most || other.is_within(self.error) {
                    true => self.stop_half(half),
                    false => self.due[half] = next(end, self.foreseen(other)),
                }
            }
        }
        Ok(())
    }

    /// How much greater than permitted the squared error of a half was, if that says when it
    /// is decided next.
    fn foreseen(&self, spread: Spread) -> f64 {
        let has_time = self
            .work
            .settings
            .target
            .is_some_and(|target| target.time.is_some());
        match has_time {
            true => 1.0,
            false => spread.excess(self.error),
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decisions_are_at_numbers_of_few_bits_that_grow_with_the_error() {
        let all = |excess: f64| {
            let numbers =
                std::iter::successors(Some(next(0, excess)), move |&n| Some(next(n, excess)));
            numbers.take(12).collect::<Vec<_>>()
        };
        assert_eq!(all(1.0), [4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28]);
        // 2^0.8 is 1.74.
        assert_eq!(all(2.0)[..6], [4, 6, 10, 16, 24, 40]);
        assert_eq!(all(f64::INFINITY)[..4], [4, 16, 64, 256]);
        assert_eq!(next(8, f64::NAN), 10);
    }
}
