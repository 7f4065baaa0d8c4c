//! Keeps Embree's floating-point mode out of Rust code, and lets tests run Rust code in that
//! mode.
//!
//! While Embree builds a scene, its threads and the committing thread flush denormal numbers to
//! zero (FTZ and DAZ of MXCSR). Bounds callbacks run in that mode. Rust code assumes the
//! default mode, and a box must not depend on the thread that computed it. Queries run in the
//! caller's mode, and returned calls leave it unchanged; `tests/embree_ffi` tests all three.
//!
//! Embree's manual advises its callers to flush denormal numbers too, so the solvers may run in
//! that mode in another renderer. `crates/bench/tests/bench/invariance.rs` tests that the
//! results are the same.

use std::hint::black_box;

use super::sys;

/// Runs `body` with rounding to nearest and without flushing to zero.
pub fn with_default_float_mode<T>(body: impl FnOnce() -> T) -> T {
    // SAFETY: it only sets this thread's mode to the one that Rust code expects.
    let former = unsafe { sys::cyltrace_enter_default_float_mode() };
    until_restored(former, body)
}

/// Runs `body` on this thread with denormal results and operands replaced by zero. Threads that
/// `body` starts are not affected.
///
/// This function is for tests, not for speed. The compiler assumes the default mode: it
/// evaluates constants in that mode. So `body` should work on numbers that are known only at
/// run time.
pub fn with_flushed_denormals<T>(body: impl FnOnce() -> T) -> T {
    // SAFETY: the mode changes the value of operations on denormal numbers and
    // nothing else; no address, length or index of this crate depends on those.
    let former = unsafe { sys::cyltrace_enter_flushing_float_mode() };
    until_restored(former, body)
}

/// Runs `body` and restores the former mode of this thread. To the compiler arithmetic has no
/// side effects, so it could be moved across a call that sets the mode. The black boxes keep
/// the inputs and the result of `body` in place.
fn until_restored<T>(former: u64, body: impl FnOnce() -> T) -> T {
    let _restored = Restored(former);
    black_box(black_box(body)())
}

/// The former mode of this thread. It is restored on drop, also when a panic unwinds.
struct Restored(u64);

impl Drop for Restored {
    fn drop(&mut self) {
        // SAFETY: the mode is the former one of this thread; the guard never leaves the
        // function that created it, so modes are restored in order.
        unsafe { sys::cyltrace_restore_float_mode(self.0) };
    }
}
