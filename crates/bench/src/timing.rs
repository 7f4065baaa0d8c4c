//! Times of several things, taken in turns.
//!
//! What is compared must be disturbed alike, so the contenders are run one
//! after the other in every round, each round starts with another of them,
//! and what is compared is compared within a round. A sample repeats its work
//! until it is long enough for the clock.

use std::hint::black_box;
use std::time::Instant;

use crate::formulations::Batch;

/// Measures how long some work takes.
pub trait Timer {
    /// The seconds that `work` takes, more than 0.
    fn seconds(&mut self, work: &mut dyn FnMut()) -> f64;
}

/// The system's steady clock.
#[derive(Clone, Copy, Debug, Default)]
pub struct WallClock;

impl Timer for WallClock {
    fn seconds(&mut self, work: &mut dyn FnMut()) -> f64 {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64().max(f64::MIN_POSITIVE)
    }
}

/// The processor time of the calling thread: while other programs have its processor,
/// it does not run. Where there is no such clock, it is [`WallClock`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ThreadClock;

#[cfg(unix)]
impl Timer for ThreadClock {
    fn seconds(&mut self, work: &mut dyn FnMut()) -> f64 {
        use rustix::time::{ClockId, clock_gettime};
        let now = || clock_gettime(ClockId::ThreadCPUTime);
        let start = now();
        work();
        let end = now();
        let seconds = (end.tv_sec - start.tv_sec) as f64;
        (seconds + 1e-9 * (end.tv_nsec - start.tv_nsec) as f64).max(f64::MIN_POSITIVE)
    }
}

#[cfg(not(unix))]
impl Timer for ThreadClock {
    fn seconds(&mut self, work: &mut dyn FnMut()) -> f64 {
        WallClock.seconds(work)
    }
}

/// How often and how long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounds {
    /// Samples of each contender, at least 1.
    pub rounds: usize,
    /// Least length of a sample in seconds; shorter work is repeated.
    pub sample_s: f64,
}

/// A sample never repeats its work more often than this.
const MOST_REPEATS: f64 = 1e6;

/// The seconds of one run of each batch, in each round: `[batch][round]`.
/// `after_round` is called once a round.
pub fn interleave(
    timer: &mut dyn Timer,
    batches: &[Box<dyn Batch>],
    plan: Rounds,
    after_round: &mut dyn FnMut(),
) -> Vec<Vec<f64>> {
    let mut run = |batch: &dyn Batch, repeats: usize| {
        timer.seconds(&mut || {
            for _ in 0..repeats {
                black_box(batch.run());
            }
        })
    };
    // The first run warms caches and pages, the second measures the length of one.
    let repeats: Vec<usize> = batches
        .iter()
        .map(|batch| {
            run(batch.as_ref(), 1);
            let once = run(batch.as_ref(), 1);
            (plan.sample_s / once).ceil().clamp(1.0, MOST_REPEATS) as usize
        })
        .collect();
    let mut samples = vec![Vec::with_capacity(plan.rounds); batches.len()];
    for round in 0..plan.rounds {
        for turn in 0..batches.len() {
            let index = (round + turn) % batches.len();
            let seconds = run(batches[index].as_ref(), repeats[index]);
            samples[index].push(seconds / repeats[index] as f64);
        }
        after_round();
    }
    samples
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Mutex};

    use super::*;

    type Log = Arc<Mutex<Vec<u64>>>;

    /// Work that writes its name down.
    struct Named(u64, Log);

    impl Batch for Named {
        fn run(&self) -> u64 {
            self.1.lock().unwrap().push(self.0);
            self.0
        }
    }

    /// A clock on which every run of work `n` takes `n` seconds.
    struct Counted(Log);

    impl Timer for Counted {
        fn seconds(&mut self, work: &mut dyn FnMut()) -> f64 {
            let before = self.0.lock().unwrap().len();
            work();
            let log = self.0.lock().unwrap();
            log[before..].iter().sum::<u64>() as f64
        }
    }

    fn measure(names: &[u64], plan: Rounds) -> (Vec<Vec<f64>>, Vec<u64>, usize) {
        let log = Log::default();
        let batches: Vec<Box<dyn Batch>> = names
            .iter()
            .map(|&name| Box::new(Named(name, Arc::clone(&log))) as Box<dyn Batch>)
            .collect();
        let mut rounds = 0;
        let mut timer = Counted(Arc::clone(&log));
        let samples = interleave(&mut timer, &batches, plan, &mut || rounds += 1);
        let log = log.lock().unwrap().clone();
        (samples, log, rounds)
    }

    #[test]
    fn interleave_rounds_start_with_each_in_turn() {
        let plan = Rounds {
            rounds: 4,
            sample_s: 0.5,
        };
        let (samples, log, rounds) = measure(&[1, 2, 3], plan);
        assert_eq!(samples, [[1.0; 4], [2.0; 4], [3.0; 4]]);
        assert_eq!(log[..6], [1, 1, 2, 2, 3, 3]);
        assert_eq!(log[6..], [1, 2, 3, 2, 3, 1, 3, 1, 2, 1, 2, 3]);
        assert_eq!(rounds, 4);
    }

    #[test]
    fn interleave_short_work_is_repeated_and_reported_for_one_run() {
        let plan = Rounds {
            rounds: 2,
            sample_s: 6.0,
        };
        let (samples, log, _) = measure(&[2, 7], plan);
        assert_eq!(samples, [[2.0; 2], [7.0; 2]]);
        // Three runs of 2 s are exactly long enough, one of 7 s is longer.
        assert_eq!(log[4..], [2, 2, 2, 7, 7, 2, 2, 2]);
    }

    #[test]
    #[cfg(unix)]
    fn thread_clock_counts_work_and_not_sleep() {
        let pause = std::time::Duration::from_millis(50);
        let asleep = ThreadClock.seconds(&mut || std::thread::sleep(pause));
        let mut sum = 0_u64;
        let working = ThreadClock.seconds(&mut || {
            let start = Instant::now();
            while start.elapsed() < pause {
                sum = black_box(sum.wrapping_add(1));
            }
        });
        assert!(0.0 < asleep && asleep < working, "{asleep} {working}");
    }

    #[test]
    fn wall_clock_work_is_done_once_and_takes_time() {
        let mut runs = 0;
        let seconds = WallClock.seconds(&mut || runs += 1);
        assert!(runs == 1 && seconds > 0.0);
    }
}
