//! Long work without the interpreter's lock, which Ctrl-C ends and a callback watches.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

/// How often the interpreter looks for signals and reports progress: often enough for a
/// progress bar, seldom enough not to be noticed.
const INTERVAL: Duration = Duration::from_millis(50);

/// Work in progress, shared by its threads.
#[derive(Default)]
pub struct Work {
    done: AtomicU64,
    cancelled: AtomicBool,
    finished: AtomicBool,
}

impl Work {
    /// Counts finished items.
    pub fn add(&self, items: u64) {
        self.done.fetch_add(items, Ordering::Relaxed);
    }

    /// Becomes true when the work shall end early. Its result is then dropped.
    pub fn cancelled(&self) -> &AtomicBool {
        &self.cancelled
    }

    /// As [`Work::cancelled`].
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Runs `work` on a thread of its own, and calls `progress(done, total)` now and then and at
/// the end. The caller's thread waits for it without the interpreter's lock.
///
/// # Errors
/// When a signal handler or `progress` raises an exception: that exception.
pub fn run<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    total: u64,
    work: impl FnOnce(&Work) -> T + Send,
) -> PyResult<T> {
    let state = Work::default();
    let report = || -> PyResult<()> {
        py.check_signals()?;
        if let Some(progress) = progress {
            progress.call1((state.done.load(Ordering::Relaxed).min(total), total))?;
        }
        Ok(())
    };
    let result = thread::scope(|scope| {
        let waiting = thread::current();
        let state = &state;
        let worker = scope.spawn(move || {
            // Wakes the waiting thread even if the work panics.
            let _finish = Finish(state, waiting);
            work(state)
        });
        let mut outcome = Ok(());
        while outcome.is_ok() && !state.finished.load(Ordering::Acquire) {
            py.detach(|| thread::park_timeout(INTERVAL));
            if !state.finished.load(Ordering::Acquire) {
                outcome = report();
            }
        }
        if outcome.is_err() {
            state.cancelled.store(true, Ordering::Relaxed);
        }
        let joined = py.detach(|| worker.join());
        outcome.map(|()| joined.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })?;
    report()?;
    Ok(result)
}

/// Says that the work has finished when it is dropped.
struct Finish<'a>(&'a Work, thread::Thread);

impl Drop for Finish<'_> {
    fn drop(&mut self) {
        self.0.finished.store(true, Ordering::Release);
        self.1.unpark();
    }
}
