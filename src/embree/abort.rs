//! Ends the process, naming the callback, when a callback panics.
//!
//! Unwinding through Embree's C++ frames would be undefined, and carrying the
//! panic past them would leave queries half answered. A panic in an
//! `extern "C"` function aborts by itself, but doesn't say which callback it
//! came from.

use std::mem;

/// Holds while a callback's body runs; if it unwinds, panics again with the
/// callback's name, which aborts because a panic is under way already.
pub struct AbortOnPanic {
    callback: &'static str,
}

impl AbortOnPanic {
    /// From here to [`passed`](Self::passed) a panic ends the process with
    /// `callback` in the message.
    #[inline(always)]
    pub fn new(callback: &'static str) -> Self {
        Self { callback }
    }

    /// There was no panic.
    #[inline(always)]
    pub fn passed(self) {
        mem::forget(self);
    }

    /// Runs `body`; a panic in it ends the process with `callback` in the
    /// message.
    #[inline]
    pub fn run<T>(callback: &'static str, body: impl FnOnce() -> T) -> T {
        let guard = Self::new(callback);
        let value = body();
        guard.passed();
        value
    }
}

impl Drop for AbortOnPanic {
    #[cold]
    fn drop(&mut self) {
        panic!(
            "a panic in Embree's `{}` callback can't be passed on through C: aborting",
            self.callback
        );
    }
}
