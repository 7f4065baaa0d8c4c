//! Long work without the interpreter's lock, which Ctrl-C ends and a callback watches.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// How often the interpreter looks for signals and reports progress: often enough for a
/// progress bar, seldom enough not to be noticed.
const INTERVAL: Duration = Duration::from_millis(50);

/// Work in progress, shared by its threads.
#[derive(Default)]
pub struct Work {
    done: AtomicU64,
    cancelled: AtomicBool,
    /// To the thread that waits; `None` if no thread does.
    waiting: Option<Sender<Message>>,
}

/// What the waiting thread receives.
enum Message {
    Call(Call),
    Finished,
}

/// A call of Python code.
type Call = Box<dyn FnOnce(Python<'_>) -> PyResult<()> + Send>;

impl Work {
    /// Counts finished items.
    pub fn add(&self, items: u64) {
        self.done.fetch_add(items, Ordering::Relaxed);
    }

    /// Sets the number of finished items, unless more have finished.
    pub fn reach(&self, items: u64) {
        self.done.fetch_max(items, Ordering::Relaxed);
    }

    /// Becomes true when the work shall end early. Its result is then dropped.
    pub fn cancelled(&self) -> &AtomicBool {
        &self.cancelled
    }

    /// As [`Work::cancelled`].
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Runs `call` on the thread that waits for the work, with the interpreter's lock, and
    /// waits for its result. An exception cancels the work. `None` if the work is cancelled.
    ///
    /// Python code runs there and not on the threads of a pool, which would take other work of
    /// the pool while the code waits for a pool of its own.
    pub fn in_python<T: Send + 'static>(
        &self,
        call: impl FnOnce(Python<'_>) -> PyResult<T> + Send + 'static,
    ) -> Option<T> {
        let (sender, receiver) = sync_channel(1);
        let call = move |py: Python<'_>| {
            // The receiver exists as long as the work waits for the result.
            let _ = sender.send(call(py)?);
            Ok(())
        };
        let waiting = self.waiting.as_ref()?;
        waiting.send(Message::Call(Box::new(call))).ok()?;
        receiver.recv().ok()
    }
}

/// Runs `work` on a thread of its own, and calls `progress(done, total)` now and then and at
/// the end. The caller's thread waits for it without the interpreter's lock.
///
/// # Errors
/// When a signal handler, `progress` or a call of the work raises an exception: that exception.
pub fn run<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    total: u64,
    work: impl FnOnce(&Work) -> T + Send,
) -> PyResult<T> {
    let (sender, inbox) = channel();
    let state = Work {
        waiting: Some(sender),
        ..Work::default()
    };
    let report = || -> PyResult<()> {
        py.check_signals()?;
        if let Some(progress) = progress {
            progress.call1((state.done.load(Ordering::Relaxed).min(total), total))?;
        }
        Ok(())
    };
    let result = thread::scope(|scope| {
        let state = &state;
        let worker = scope.spawn(move || {
            // Wakes the waiting thread even if the work panics.
            let _finish = Finish(state);
            work(state)
        });
        let outcome = wait(py, inbox, report);
        if outcome.is_err() {
            state.cancelled.store(true, Ordering::Relaxed);
        }
        let joined = py.detach(|| worker.join());
        outcome.map(|()| joined.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })?;
    report()?;
    Ok(result)
}

/// Makes the calls of the work until it has finished. The inbox is dropped at the end with the
/// calls that are left in it, so that no thread of the work waits for their results.
fn wait(
    py: Python<'_>,
    mut inbox: Receiver<Message>,
    report: impl Fn() -> PyResult<()>,
) -> PyResult<()> {
    let mut next_report = Instant::now() + INTERVAL;
    loop {
        let left = next_report.saturating_duration_since(Instant::now());
        let inbox = &mut inbox;
        match py.detach(move || inbox.recv_timeout(left)) {
            Ok(Message::Call(call)) => call(py)?,
            Ok(Message::Finished) | Err(RecvTimeoutError::Disconnected) => return Ok(()),
            Err(RecvTimeoutError::Timeout) => {}
        }
        if Instant::now() >= next_report {
            report()?;
            next_report = Instant::now() + INTERVAL;
        }
    }
}

/// Says that the work has finished when it is dropped.
struct Finish<'a>(&'a Work);

impl Drop for Finish<'_> {
    fn drop(&mut self) {
        if let Some(waiting) = &self.0.waiting {
            // Nobody waits any more after an exception.
            let _ = waiting.send(Message::Finished);
        }
    }
}
