//! The threads that trace.

use std::num::NonZeroUsize;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// The stack size of a worker. Nested placements trace recursively: 64 levels, the deepest
/// scene that loads, take up to 1.2 MB (see `prototype`). Several times that size leaves room
/// for everything else. Untouched pages cost nothing.
const STACK_BYTES: usize = 8 << 20;

/// A pool with the requested number of threads, or one per processor, with stacks for the
/// deepest nesting of placements.
///
/// # Errors
/// When the system cannot start threads.
pub fn workers(threads: Option<NonZeroUsize>) -> Result<ThreadPool, ThreadPoolBuildError> {
    ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, NonZeroUsize::get))
        .stack_size(STACK_BYTES)
        .thread_name(|number| format!("cyltrace-{number}"))
        .build()
}
