//! Keeps Embree's floating-point mode out of Rust code.
//!
//! While Embree builds a scene, its threads and the one that commits flush
//! denormal numbers to zero (FTZ and DAZ of MXCSR), and bounds callbacks run
//! among that. Rust code assumes the default mode, and a box must not depend on
//! which thread computed it. Queries and returned calls are in the caller's
//! mode; `tests/embree_ffi.rs` holds all three.

use super::sys;

/// Runs `body` with rounding to nearest and without flushing to zero.
pub fn with_default_float_mode<T>(body: impl FnOnce() -> T) -> T {
    // SAFETY: it only sets this thread's mode to the one Rust code expects.
    let former = unsafe { sys::cyltrace_enter_default_float_mode() };
    let value = body();
    // SAFETY: the mode is the one that this thread was in before; should `body`
    // panic, the process ends (invariant 8).
    unsafe { sys::cyltrace_restore_float_mode(former) };
    value
}
