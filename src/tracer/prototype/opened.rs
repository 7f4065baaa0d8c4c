//! Prototypes that are opened into their parents.
//!
//! A prototype that contains only a few placements of innermost prototypes, such as an assembly
//! of parts, costs each ray near it a callback and an entry into a scene of a few boxes. So it
//! is *opened* if Embree can have everything that it places as instances in the parent's scene
//! (`instances` derives the required growth of boxes). Results are the same bits: paths have
//! both placements, and the f64 ray goes through both, and is moved nearer where the opened
//! prototype would have moved it. A ray reaches the parts without a callback, and the parts are
//! built with the parent.

use std::sync::Arc;

use crate::scene::{Placement, PrototypeIndex, Scene};
use crate::tracer::frame::Frame;

/// The greatest number of placements of an opened prototype: beyond it, a tree of its own pays.
pub(crate) const MOST_INNER: usize = 8;

/// The greatest number of placements of a prototype that opens its children. It limits the
/// number of added instances, at most `MOST_INNER` times as many.
pub(crate) const MOST_OUTER: usize = 512;

/// The placements between a prototype and an instance in its scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Through {
    /// A placement of the prototype.
    One(u32),
    /// A placement of an opened prototype, and one in it.
    Two { outer: u32, inner: u32 },
}

impl Through {
    /// Embree's number of the instance, in a prototype with `placements` placements.
    pub fn number(self, placements: usize) -> u32 {
        match self {
            Self::One(number) => number,
            Self::Two { outer, inner } => outer + (inner + 1) * placements as u32,
        }
    }

    /// The inverse of [`Through::number`].
    #[inline(always)]
    pub fn of(number: u32, placements: usize) -> Self {
        let placements = placements as u32;
        if number < placements {
            return Self::One(number);
        }
        Self::Two {
            outer: number % placements,
            inner: number / placements - 1,
        }
    }
}

/// The frames of opened prototypes, in the order of their indices.
#[derive(Clone, Debug, Default)]
pub(crate) struct OpenedFrames(Arc<[(PrototypeIndex, Frame)]>);

impl OpenedFrames {
    pub fn new(mut frames: Vec<(PrototypeIndex, Frame)>) -> Self {
        frames.sort_unstable_by_key(|(index, _)| *index);
        frames.dedup_by_key(|(index, _)| *index);
        Self(frames.into())
    }

    /// The frame of an opened prototype.
    pub fn of(&self, index: PrototypeIndex) -> &Frame {
        let position = self.0.binary_search_by_key(&index, |(known, _)| *known);
        let position = position.expect("the frames of all opened prototypes are known");
        &self.0[position].1
    }
}

/// The placements in a prototype, if it may be opened; `is_innermost` is whether Embree may
/// have instances of a prototype.
pub(super) fn inner_placements(
    scene: &Scene,
    index: PrototypeIndex,
    is_innermost: impl Fn(PrototypeIndex) -> bool,
) -> Option<&[Placement]> {
    let prototype = &scene.prototypes[index.0 as usize];
    let placements = &prototype.placements[..];
    let may_be_opened = prototype.solids.is_empty()
        && (1..=MOST_INNER).contains(&placements.len())
        && placements.iter().all(|inner| is_innermost(inner.of));
    may_be_opened.then_some(placements)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_instance_has_a_number_of_its_own() {
        for placements in [1, 2, 7, MOST_OUTER] {
            let mut known = std::collections::HashSet::new();
            for outer in 0..placements as u32 {
                let inner = (0..MOST_INNER as u32).map(|inner| Through::Two { outer, inner });
                for through in inner.chain([Through::One(outer)]) {
                    let number = through.number(placements);
                    assert_eq!(Through::of(number, placements), through);
                    assert!(known.insert(number), "{number} twice");
                }
            }
        }
    }
}
