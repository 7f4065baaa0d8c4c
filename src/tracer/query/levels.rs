//! The rays of a packet in the prototypes on the way.
//!
//! A level has some two kilobytes. So each is written where it stays, and its memory is
//! used again for whatever the packet comes to next at that depth.

use crate::tracer::frame::PacketLevel;

/// The levels of the prototypes that are being traced, and that of the prototype that the
/// packet comes to next.
pub(super) struct Levels {
    /// At least one more than `depth`.
    all: Vec<PacketLevel>,
    /// How many prototypes are being traced.
    depth: usize,
}

impl Levels {
    /// None being traced.
    pub fn new() -> Self {
        Self {
            all: vec![PacketLevel::NOWHERE],
            depth: 0,
        }
    }

    /// The level that callbacks run in.
    #[inline(always)]
    pub fn current(&self) -> &PacketLevel {
        &self.all[self.innermost()]
    }

    /// The level of the prototype that the packet comes to.
    #[inline(always)]
    pub fn next(&mut self) -> &mut PacketLevel {
        &mut self.all[self.depth]
    }

    /// Both.
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

    /// Goes back to the level before.
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
