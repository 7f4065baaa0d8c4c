//! The rays of a packet in the prototypes from the root to the current one.
//!
//! A level takes some two kilobytes. So each is written in place, and its memory is reused for
//! the next prototype at that depth.

use crate::tracer::frame::PacketLevel;

/// The levels of the prototypes that are being traced, and that of the next one.
pub(super) struct Levels {
    /// At least `depth + 1` levels.
    all: Vec<PacketLevel>,
    /// The number of prototypes that are being traced.
    depth: usize,
}

impl Levels {
    /// No prototype is being traced.
    pub fn new() -> Self {
        Self {
            all: vec![PacketLevel::NOWHERE],
            depth: 0,
        }
    }

    /// The level of the current callbacks.
    #[inline(always)]
    pub fn current(&self) -> &PacketLevel {
        &self.all[self.innermost()]
    }

    /// The level of the prototype that the packet enters next.
    #[inline(always)]
    pub fn next(&mut self) -> &mut PacketLevel {
        &mut self.all[self.depth]
    }

    /// Both levels.
    #[inline]
    pub fn current_and_next(&mut self) -> (&PacketLevel, &mut PacketLevel) {
        let innermost = self.innermost();
        let (before, after) = self.all.split_at_mut(self.depth);
        (&before[innermost], &mut after[0])
    }

    /// Makes the next level the current one.
    #[inline]
    pub fn descend(&mut self) {
        self.depth += 1;
        if self.all.len() == self.depth {
            self.all.push(PacketLevel::NOWHERE);
        }
    }

    /// Returns to the previous level.
    #[inline]
    pub fn ascend(&mut self) {
        self.depth = self.innermost();
    }

    #[inline(always)]
    fn innermost(&self) -> usize {
        let before = self.depth.checked_sub(1);
        before.expect("callbacks run within a prototype")
    }
}
