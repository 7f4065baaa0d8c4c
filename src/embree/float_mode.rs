//! Keeps Embree's floating-point mode out of Rust code, and puts Rust code into
//! it where a test asks what then happens.
//!
//! While Embree builds a scene, its threads and the one that commits flush
//! denormal numbers to zero (FTZ and DAZ of MXCSR), and bounds callbacks run
//! among that. Rust code assumes the default mode, and a box must not depend on
//! which thread computed it. Queries and returned calls are in the caller's
//! mode; `tests/embree_ffi` tests all three.
//!
//! Embree's manual advises its callers to flush denormal numbers too, so that
//! the solvers may well run in that mode in another's renderer:
//! `crates/bench/tests/bench/invariance.rs` tests that they answer the same.

use std::hint::black_box;

use super::sys;

/// Runs `body` with rounding to nearest and without flushing to zero.
pub fn with_default_float_mode<T>(body: impl FnOnce() -> T) -> T {
    // SAFETY: it only sets this thread's mode to the one Rust code expects.
    let former = unsafe { sys::cyltrace_enter_default_float_mode() };
    until_restored(former, body)
}

/// Runs `body` with denormal numbers taken for zero, as results and as operands,
/// on this thread and none that it starts.
///
/// This is to try what code does in that mode, and no way to speed. The
/// compiler knows nothing of the mode: what it works out itself is in the
/// default one. So let `body` work on numbers that are known only when it runs.
pub fn with_flushed_denormals<T>(body: impl FnOnce() -> T) -> T {
    // SAFETY: the mode changes the value of operations on denormal numbers and
    // nothing else; no address, length or index of this crate depends on those.
    let former = unsafe { sys::cyltrace_enter_flushing_float_mode() };
    until_restored(former, body)
}

/// Runs `body` and gives this thread its former mode back. To the compiler
/// arithmetic has no effects, so it may be moved past a call that sets the
/// mode; black boxes keep what goes into `body` and what comes out of it here.
fn until_restored<T>(former: u64, body: impl FnOnce() -> T) -> T {
    let _restored = Restored(former);
    black_box(black_box(body)())
}

/// The mode that this thread was in before, which it gets back on drop, also
/// when a panic unwinds.
struct Restored(u64);

impl Drop for Restored {
    fn drop(&mut self) {
        // SAFETY: the mode is the one that this thread was in before; the guard
        // never leaves the function that made it, so no other lies between.
        unsafe { sys::cyltrace_restore_float_mode(self.0) };
    }
}
