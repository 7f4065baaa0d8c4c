//! Ends the process, naming the callback, when a callback panics.
//!
//! Unwinding through Embree's C++ frames is undefined behavior, and resuming the panic after
//! the C call would leave queries half finished. A panic in an `extern "C"` function aborts by
//! itself, but without the name of the callback.

use std::mem;

/// A guard for the body of a callback. If the body unwinds, the guard panics again with the
/// callback's name. A panic while panicking aborts.
pub struct AbortOnPanic {
    callback: &'static str,
}

impl AbortOnPanic {
    /// Starts the guard. Until [`passed`](Self::passed), a panic ends the process with
    /// `callback` in the message.
    #[inline(always)]
    pub fn new(callback: &'static str) -> Self {
        Self { callback }
    }

    /// Ends the guard: the body did not panic.
    #[inline(always)]
    pub fn passed(self) {
        mem::forget(self);
    }

    /// Runs `body`. A panic in it ends the process with `callback` in the message.
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
