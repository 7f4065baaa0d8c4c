//! The hits that a query keeps, and their order.

use std::cmp::Ordering;

use arrayvec::ArrayVec;

use crate::scene::{GREATEST_DEPTH, PrototypeIndex};
use crate::solid::Meeting;

/// The placements on the way from the root to a prototype, outermost first.
pub(crate) type InstancePath = ArrayVec<u32, GREATEST_DEPTH>;

/// A hit as a query keeps it: what is needed to work it out afterwards.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    pub meeting: Meeting,
    pub prototype: PrototypeIndex,
    /// The position in the prototype's list of cylinders.
    pub record: u32,
    /// The number that the user knows it by.
    pub primitive: u32,
    pub path: InstancePath,
}

impl Found {
    /// How a hit that is not kept yet compares with this one: by `t`, then by
    /// the instance path, the primitive, entry before exit, and the part. No
    /// two hits of a ray are equal.
    #[inline]
    fn order(&self, meeting: &Meeting, path: &InstancePath, primitive: u32) -> Ordering {
        let by_t = meeting.t.partial_cmp(&self.meeting.t);
        by_t.expect("a hit's t is a number").then_with(|| {
            (path, primitive, meeting.crossing, meeting.part).cmp(&(
                &self.path,
                self.primitive,
                self.meeting.crossing,
                self.meeting.part,
            ))
        })
    }
}

/// What a query is after.
#[derive(Debug)]
pub(crate) enum Keep {
    /// The first hit.
    First(Option<Found>),
    /// The next hits after one that is known, at most so many.
    Next {
        after: Option<Found>,
        most: usize,
        /// In order.
        hits: Vec<Found>,
    },
}

impl Keep {
    /// The greatest `t` of a hit that would be kept.
    #[inline]
    pub fn bound(&self, t_max: f64) -> f64 {
        match self {
            Self::First(Some(first)) => first.meeting.t,
            Self::Next { most, hits, .. } if hits.len() == *most => {
                hits.last().map_or(t_max, |last| last.meeting.t)
            }
            Self::First(None) | Self::Next { .. } => t_max,
        }
    }

    /// Keeps a hit if it is wanted.
    #[inline]
    pub fn offer(
        &mut self,
        meeting: Meeting,
        path: &InstancePath,
        primitive: u32,
        found: impl FnOnce(Meeting, &InstancePath) -> Found,
    ) {
        let order = |kept: &Found| kept.order(&meeting, path, primitive);
        match self {
            Self::First(first) => {
                if first.as_ref().is_none_or(|first| order(first).is_lt()) {
                    *first = Some(found(meeting, path));
                }
            }
            Self::Next { after, most, hits } => {
                if after.as_ref().is_some_and(|after| order(after).is_le()) {
                    return;
                }
                let position = hits.partition_point(|kept| order(kept).is_gt());
                if position < *most {
                    hits.truncate(*most - 1);
                    hits.insert(position, found(meeting, path));
                }
            }
        }
    }
}
