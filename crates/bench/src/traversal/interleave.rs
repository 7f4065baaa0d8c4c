//! Times of one beside another on the same rays.
//!
//! A sample is cut into pieces of some ten milliseconds, and in every round each
//! piece is run by all, one after the other. On a shared processor a longer
//! sample is nearly always disturbed; a short one seldom, which the median over
//! the rounds does not notice.
//!
//! The time of a sample is the sum of the pieces' medians. The ratio of two is the
//! mean of the pieces' ratios, each the median over the rounds of neighbouring
//! measurements, weighted by the time that the piece takes of the second sample.

use std::hint::black_box;
use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuildError};

use super::rays::TILE;
use crate::statistics::{Spread, ratios};
use crate::timing::Timer;
use cyltrace::tracer::workers;

/// Rays of a piece, which is also what one runs before it is another's turn. One
/// thread gets them as one batch; several share them.
///
/// With 256, modes of this library found the tree in the caches where the other
/// had left it for the same rays, and came out up to twice as fast as beside a
/// rival, that fills them with its own.
pub const PIECE: usize = 1024 * TILE;

/// A pool of threads that trace together.
#[derive(Clone)]
pub struct Workers {
    /// How many.
    pub threads: usize,
    pool: Arc<ThreadPool>,
}

impl Workers {
    /// Starts them.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn new(threads: usize) -> Result<Self, ThreadPoolBuildError> {
        let pool = Arc::new(workers(std::num::NonZeroUsize::new(threads))?);
        Ok(Self { threads, pool })
    }
}

impl Workers {
    /// Runs `work` on parts of `0..count`, each of which starts at a multiple
    /// of `TILE`, and adds up the results.
    pub fn share(&self, count: usize, work: impl Fn(Range<usize>) -> u64 + Sync) -> u64 {
        if self.threads == 1 {
            return work(0..count);
        }
        // Two turns each: threads are not woken at the same time.
        let size = (PIECE / TILE).div_ceil(2 * self.threads) * TILE;
        self.pool.install(|| {
            let part = |number: usize| {
                let first = number * size;
                work(first..(first + size).min(count))
            };
            let parts = (0..count.div_ceil(size)).into_par_iter();
            parts.map(part).reduce(|| 0, u64::wrapping_add)
        })
    }
}

/// Some rays that are traced again and again.
pub struct Sample<'a> {
    /// On which threads.
    pub workers: &'a Workers,
    /// How many rays.
    pub count: usize,
    /// Traces some of them, and answers with a number that depends on every
    /// answer.
    pub run: Box<dyn Fn(Range<usize>) -> u64 + Sync + 'a>,
}

impl Sample<'_> {
    fn piece(&self, piece: &Range<usize>) -> u64 {
        let run = |part: Range<usize>| (self.run)(piece.start + part.start..piece.start + part.end);
        self.workers.share(piece.len(), run)
    }
}

/// The seconds of each piece of a sample in each round.
pub struct Times(Vec<Vec<f64>>);

impl Times {
    /// The seconds of the sample: the sums of the pieces' medians and of their
    /// deviations, as if all were off together.
    pub fn sample(&self) -> Spread {
        let pieces = self.0.iter().map(|seconds| Spread::of(seconds));
        pieces.fold(NOTHING, |sum, piece| Spread {
            median: sum.median + piece.median,
            deviation: sum.deviation + piece.deviation,
        })
    }

    /// The time of this sample over that of another that was run in turns with it.
    pub fn over(&self, other: &Self) -> Spread {
        let whole = other.sample().median;
        let pieces = self.0.iter().zip(&other.0);
        pieces.fold(NOTHING, |sum, (seconds, others)| {
            let ratio = Spread::of(&ratios(seconds, others));
            let share = Spread::of(others).median / whole;
            Spread {
                median: sum.median + share * ratio.median,
                deviation: sum.deviation + share * ratio.deviation,
            }
        })
    }
}

const NOTHING: Spread = Spread {
    median: 0.0,
    deviation: 0.0,
};

/// Runs samples of the same rays in turns, after one round that warms up.
pub fn interleave(timer: &mut dyn Timer, samples: &[Sample<'_>], rounds: usize) -> Vec<Times> {
    let count = samples.first().map_or(0, |sample| sample.count);
    let starts = (0..count).step_by(PIECE);
    let pieces: Vec<Range<usize>> = starts.map(|at| at..(at + PIECE).min(count)).collect();
    let mut times: Vec<Times> = samples
        .iter()
        .map(|_| Times(vec![Vec::with_capacity(rounds); pieces.len()]))
        .collect();
    for round in 0..=rounds {
        for (number, piece) in pieces.iter().enumerate() {
            for turn in 0..samples.len() {
                let index = (round + number + turn) % samples.len();
                let seconds = timer.seconds(&mut || {
                    black_box(samples[index].piece(piece));
                });
                if round > 0 {
                    times[index].0[number].push(seconds);
                }
            }
        }
    }
    times
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    /// A clock on which a ray of work takes as long as the work says, on a
    /// machine that is slower by half after a number of samples.
    struct SlowingClock<'a> {
        last: &'a Mutex<f64>,
        slower_after: u32,
        samples: u32,
    }

    impl Timer for SlowingClock<'_> {
        fn seconds(&mut self, work: &mut dyn FnMut()) -> f64 {
            work();
            let factor = libm::pow(1.5, f64::from(self.samples / self.slower_after));
            self.samples += 1;
            *self.last.lock().unwrap() * factor
        }
    }

    fn sample<'a>(
        workers: &'a Workers,
        last: &'a Mutex<f64>,
        count: usize,
        seconds: f64,
    ) -> Sample<'a> {
        Sample {
            workers,
            count,
            run: Box::new(move |range| {
                *last.lock().unwrap() = seconds * range.len() as f64;
                0
            }),
        }
    }

    #[test]
    fn race_with_a_rival_twice_as_slow_gives_two_however_slow_the_rounds() {
        let (workers, last) = (Workers::new(1).unwrap(), Mutex::new(0.0));
        // Three pieces, the last of which is half as long.
        let count = 5 * PIECE / 2;
        let mut timer = SlowingClock {
            last: &last,
            slower_after: 6,
            samples: 0,
        };
        let samples = [1.0, 2.0].map(|seconds| sample(&workers, &last, count, seconds));
        let times = interleave(&mut timer, &samples, 5);
        let ratio = times[1].over(&times[0]);
        assert_eq!((ratio.median, ratio.deviation), (2.0, 0.0));
        // The third of five rounds, after one that warms up.
        let expected = count as f64 * 1.5 * 1.5 * 1.5;
        assert_eq!(times[0].sample().median, expected);
        assert_eq!(times[1].sample().median, 2.0 * expected);
    }

    #[test]
    fn over_pieces_count_by_their_time() {
        let times = |pieces: [f64; 2]| Times(pieces.map(|seconds| vec![seconds; 3]).into());
        let ratio = times([2.0, 9.0]).over(&times([1.0, 3.0]));
        assert!((ratio.median - 11.0 / 4.0).abs() < 1e-15, "{ratio:?}");
    }

    #[test]
    fn lap_threads_share_all_rays() {
        for threads in [1, 3] {
            let workers = Workers::new(threads).unwrap();
            let sample = Sample {
                workers: &workers,
                count: 1500,
                run: Box::new(|range| range.map(|number| number as u64).sum()),
            };
            assert_eq!(sample.piece(&(0..1500)), 1499 * 1500 / 2);
            assert_eq!(sample.piece(&(500..1500)), (500..1500).sum::<u64>());
        }
    }
}
