//! Counts of the work of queries, for benchmarks: callbacks from Embree, and tests of rays
//! against solids.
//!
//! Without the feature `counters` nothing is counted, and the functions are empty. Counts are
//! per thread, which is cheap and unaffected by queries on other threads.

/// The work of a thread's queries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Calls from Embree, for solids and for placements. A call for a packet counts once.
    pub callbacks: u64,
    /// Tests of a ray against a solid.
    pub solves: u64,
    /// Rays passed on to a placed prototype. A packet in an instance of Embree's counts once.
    pub placements: u64,
}

#[cfg(feature = "counters")]
mod counting {
    use std::cell::Cell;

    use super::Counts;

    thread_local! {
        static COUNTS: Cell<Counts> = const {
            Cell::new(Counts { callbacks: 0, solves: 0, placements: 0 })
        };
    }

    pub fn add(change: impl FnOnce(&mut Counts)) {
        COUNTS.with(|cell| {
            let mut counts = cell.get();
            change(&mut counts);
            cell.set(counts);
        });
    }

    pub fn take() -> Option<Counts> {
        Some(COUNTS.take())
    }
}

#[cfg(not(feature = "counters"))]
mod counting {
    use super::Counts;

    #[inline(always)]
    pub fn add(_: impl FnOnce(&mut Counts)) {}

    pub fn take() -> Option<Counts> {
        None
    }
}

/// The work of this thread's queries since the last call; `None` if the library was built
/// without the feature `counters`.
#[must_use]
pub fn take() -> Option<Counts> {
    counting::take()
}

#[inline(always)]
pub(super) fn called_back() {
    counting::add(|counts| counts.callbacks += 1);
}

#[inline(always)]
pub(super) fn solved(rays: u32) {
    counting::add(|counts| counts.solves += u64::from(rays));
}

#[inline(always)]
pub(super) fn passed_on(rays: u32) {
    counting::add(|counts| counts.placements += u64::from(rays));
}
