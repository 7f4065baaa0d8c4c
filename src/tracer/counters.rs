//! Counts of what queries do, for benchmarks: how often Embree calls back, and
//! how many rays are put to how many cylinders.
//!
//! Without the feature `counters` nothing is counted, and the functions are
//! empty. Counts are a thread's own, so that counting costs no more than it has
//! to and queries on other threads do not disturb it.

/// What the queries of a thread did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Calls from Embree, for solids and for placements. One of a packet counts
    /// once.
    pub callbacks: u64,
    /// Rays put to a cylinder, or to a block of cylinders, which counts once.
    pub solves: u64,
    /// Rays handed on to a placed prototype. A packet that a callback in an instance of
    /// Embree's needs there counts once.
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

/// What this thread's queries did since the last call; `None` where the library
/// was built without the feature `counters`.
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
pub(super) fn handed_on(rays: u32) {
    counting::add(|counts| counts.placements += u64::from(rays));
}
