//! The threads that trace.

use std::num::NonZeroUsize;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// Stack of a worker. Nested placements trace recursively: 64 levels, the
/// deepest scene that loads, take up to 1.2 MB (`prototype` says how). Several
/// times that is kept so that nothing else has to be counted. Pages never
/// touched cost nothing.
const STACK_BYTES: usize = 8 << 20;

/// A pool of as many threads as requested, or as the machine has, whose
/// stacks hold the deepest nesting of placements.
///
/// # Errors
/// When the system refuses to start threads.
pub fn workers(threads: Option<NonZeroUsize>) -> Result<ThreadPool, ThreadPoolBuildError> {
    ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, NonZeroUsize::get))
        .stack_size(STACK_BYTES)
        .thread_name(|number| format!("cyltrace-{number}"))
        .build()
}
