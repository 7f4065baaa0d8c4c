//! Attaches the solids of a group to its Embree scene: one user geometry per kind.

use super::blocks::{Blocked, block_bytes};
use super::group_solids::{GroupSolids, InPrototype, Records, Single};
use super::members::Members;
use super::numbers::Numbers;
use super::prototype_ref::PrototypeRef;
use crate::embree::{self, SceneBuilder};
use crate::solid::Composition;
use crate::tracer::kinds::TracedKind;
use crate::tracer::options::Layout;
use crate::tracer::query::Query;
use crate::with_solid_kind;

/// The scene that solids are attached to, and its options.
pub(crate) struct Attaching<'a> {
    pub prototype_ref: &'a PrototypeRef,
    pub layout: Layout,
    /// The greatest number of threads that make blocks.
    pub threads: usize,
    pub builder: &'a mut SceneBuilder<Query>,
}

impl Attaching<'_> {
    /// Attaches all solids of a group.
    ///
    /// Set operations are a primitive each: a few bytes of a copy could represent only the box,
    /// which Embree tests as well.
    pub fn attach_all(&mut self, members: &Members) -> Result<(), embree::Error> {
        for (kind, numbers) in members.solids() {
            with_solid_kind!(kind, S => S::attach(numbers, self))?;
        }
        Ok(())
    }

    /// Attaches solids of a convex kind.
    pub fn attach<R: Records<Solid: TracedKind>>(
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

/// As [`TracedKind::attach`].
trait AttachComposed {
    fn attach(numbers: &Numbers, to: &mut Attaching) -> Result<(), embree::Error>;
}

impl AttachComposed for Composition {
    fn attach(numbers: &Numbers, to: &mut Attaching) -> Result<(), embree::Error> {
        let solids = GroupSolids::new(to.prototype_ref, numbers, InPrototype::<Self>::new());
        to.builder.attach_user(Single(solids)).map(drop)
    }
}

/// The bytes of all blocks of a group.
pub(super) fn kept_blocks_bytes(members: &Members, layout: Layout) -> usize {
    let counts = members.single_counts().map(u64::from);
    let blocks = counts.filter(|&count| layout.has_blocks(count));
    blocks.map(block_bytes).sum::<u64>() as usize
}
