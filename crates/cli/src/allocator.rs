//! The program's allocator: the system's, which it counts and limits.
//!
//! A scene's records are estimated before they are made (`limit.rs`), but what a parser
//! needs on the way is known only when it allocates it. So while a scene is read and
//! parsed, all allocations together may not exceed a limit. And where the system itself
//! refuses, as under `ulimit -v`, Rust would abort. In both cases the program prints
//! which limit was exceeded, removes temporary files and ends with exit code 2.
//!
//! Each thread counts its own allocations and adds them to the total now and then, so
//! that threads do not wait for each other: the total is off by up to [`SHARE`] a
//! thread. Embree's own memory and stacks are not counted.

#![allow(
    unsafe_code,
    reason = "an allocator cannot be written without; each block forwards the caller's promise"
)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicBool, AtomicI64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use super::COULD_NOT_RUN;
use super::ending::{end_now, end_without_memory};

/// Bytes that a thread counts before it adds them to the total, 64 KiB: less makes
/// threads wait for each other more often, more makes the total less exact.
const SHARE: i64 = 64 << 10;

/// Bytes that reading may take beyond its limit, 16 MiB: buffers and threads, which
/// every command needs for any scene.
const ALLOWANCE: i64 = 16 << 20;

/// No limit.
const NONE: i64 = i64::MAX;

/// Bytes that are allocated, but for what threads have not added yet.
static TOTAL: AtomicI64 = AtomicI64::new(0);

/// The total that may not be exceeded.
static LIMIT: AtomicI64 = AtomicI64::new(NONE);

/// The error message for an exceeded limit.
static REFUSAL: Mutex<String> = Mutex::new(String::new());

thread_local! {
    /// Bytes that this thread has not added to the total.
    static SINCE: Cell<i64> = const { Cell::new(0) };
}

/// The system's allocator, counted and limited.
pub struct LimitedAllocator;

/// While it lives, allocations are limited.
pub struct AllocationLimit;

impl AllocationLimit {
    /// Ends the program with `refusal` when it allocates more than `bytes` from here on.
    pub fn new(bytes: u64, refusal: String) -> Self {
        *REFUSAL.lock().unwrap_or_else(PoisonError::into_inner) = refusal;
        let bytes = i64::try_from(bytes).unwrap_or(NONE);
        let total = TOTAL.load(Ordering::Relaxed);
        let limit = total.saturating_add(bytes).saturating_add(ALLOWANCE);
        LIMIT.store(limit, Ordering::Relaxed);
        Self
    }
}

impl Drop for AllocationLimit {
    fn drop(&mut self) {
        LIMIT.store(NONE, Ordering::Relaxed);
    }
}

// SAFETY: every call is forwarded to the system's allocator with the arguments that the
// caller vouches for, and its answer is returned unchanged. Counting neither unwinds nor
// allocates; where it ends the program, it does not return.
unsafe impl GlobalAlloc for LimitedAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(signed(layout.size()));
        // SAFETY: `layout` has a size above 0, as our caller guarantees.
        available(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(signed(layout.size()));
        // SAFETY: `layout` has a size above 0, as our caller guarantees.
        available(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        count(-signed(layout.size()));
        // SAFETY: `memory` came from `System` with this layout: the functions above and
        // below return nothing else, and our caller passes both unchanged.
        unsafe { System.dealloc(memory, layout) };
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(signed(size) - signed(layout.size()));
        // SAFETY: `memory` came from `System` with this layout, as for `dealloc`; our
        // caller guarantees that `size` is above 0 and, rounded up to the alignment, at
        // most `isize::MAX`.
        available(unsafe { System.realloc(memory, layout, size) }, size)
    }
}

/// A layout's size is at most `isize::MAX`.
fn signed(size: usize) -> i64 {
    size as i64
}

/// Counts bytes, and ends the program when they are too many.
fn count(bytes: i64) {
    // A thread that ends has no cell any more; what it still allocates is not counted.
    let _ = SINCE.try_with(|since| {
        let bytes = since.get() + bytes;
        if bytes.abs() < SHARE {
            since.set(bytes);
            return;
        }
        since.set(0);
        let total = TOTAL.fetch_add(bytes, Ordering::Relaxed) + bytes;
        // The first to see it lifts the limit, for the end needs memory, too.
        if total > LIMIT.load(Ordering::Relaxed) && LIMIT.swap(NONE, Ordering::Relaxed) != NONE {
            let refusal = REFUSAL.lock().unwrap_or_else(PoisonError::into_inner);
            end_now(&refusal, COULD_NOT_RUN);
        }
    });
}

/// The memory that the system gave; ends the program where it gave none.
fn available(memory: *mut u8, size: usize) -> *mut u8 {
    static IS_ENDING: AtomicBool = AtomicBool::new(false);
    if !memory.is_null() {
        return memory;
    }
    if !IS_ENDING.swap(true, Ordering::Relaxed) {
        end_without_memory(size, COULD_NOT_RUN);
    }
    // Another thread is ending the program.
    loop {
        thread::park();
    }
}
