//! Attaches solids of one kind in a group to its Embree scene, as a user geometry.

use super::blocks::{Blocked, block_bytes};
use super::group_solids::{GroupSolids, Records, Single};
use super::members::Members;
use super::numbers::Numbers;
use super::prototype_ref::PrototypeRef;
use crate::embree::{self, SceneBuilder};
use crate::tracer::filter::Filtered;
use crate::tracer::options::Layout;
use crate::tracer::query::Query;

/// The scene that solids are attached to, and its options.
pub(crate) struct Attaching<'a> {
    pub prototype_ref: &'a PrototypeRef,
    pub layout: Layout,
    /// The greatest number of threads that make blocks.
    pub threads: usize,
    pub builder: &'a mut SceneBuilder<Query>,
}

impl Attaching<'_> {
    /// Attaches solids of a convex kind.
    pub fn attach<R: Records<Solid: Filtered>>(
        &mut self,
        numbers: &Numbers,
        records: R,
    ) -> Result<(), embree::Error> {
        let solids = GroupSolids::new(self.prototype_ref, numbers, records);
        let attached = if self.layout.has_blocks(u64::from(solids.len())) {
            self.builder.attach_user(Blocked::new(solids, self.threads))
        } else {
            self.builder.attach_user(Single(solids))
        };
        attached.map(drop)
    }
}

/// The bytes of all blocks of a group.
pub(super) fn kept_blocks_bytes(members: &Members, layout: Layout) -> usize {
    let counts = members.single_counts().map(u64::from);
    let blocks = counts.filter(|&count| layout.has_blocks(count));
    blocks.map(block_bytes).sum::<u64>() as usize
}
