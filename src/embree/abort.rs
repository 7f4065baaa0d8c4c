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
    /// Runs `body`; a panic in it ends the process with `callback` in the
    /// message.
    #[inline]
    pub fn run<T>(callback: &'static str, body: impl FnOnce() -> T) -> T {
        let guard = Self { callback };
        let value = body();
        mem::forget(guard);
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
