//! Attaches the solids of a group to its Embree scene: a user geometry for
//! each kind that it contains.

use super::blocks::{Blocked, block_bytes};
use super::cylinders::{Cylinders, KnownCylinders};
use super::ends::{Capped, Ends, EndsKind, Mixed, Open};
use super::members::Members;
use super::prototype_ref::{PrototypeRef, SolidList};
use super::solids::{Filtered, Single, Solids};
use crate::embree::{self, SceneBuilder};
use crate::solid::{Composition, Cone, Cuboid, Disk, RoundedCone, Sphere};
use crate::tracer::filter::HasFilter;
use crate::tracer::options::Layout;
use crate::tracer::query::Query;
use crate::tracer::traced::TracedSolid;

/// Attaches cylinders in the layout that is asked for, made on up to `threads`
/// threads.
pub(super) fn attach_cylinders(
    cylinders: &Cylinders,
    layout: Layout,
    threads: usize,
    builder: &mut SceneBuilder<Query>,
) -> Result<(), embree::Error> {
    if cylinders.len() == 0 {
        return Ok(());
    }
    match cylinders.ends() {
        EndsKind::Open => attach::<Open>(cylinders, layout, threads, builder),
        EndsKind::Capped => attach::<Capped>(cylinders, layout, threads, builder),
        EndsKind::Mixed => attach::<Mixed>(cylinders, layout, threads, builder),
    }
}

fn attach<E: Ends>(
    cylinders: &Cylinders,
    layout: Layout,
    threads: usize,
    builder: &mut SceneBuilder<Query>,
) -> Result<(), embree::Error> {
    let known = KnownCylinders::<E>::new(cylinders.clone());
    attach_filtered(known, layout, threads, builder)
}

/// Attaches the solids of other kinds, likewise.
///
/// Set operations are a primitive each: what a few bytes can say of one is its box, which
/// Embree tests as well.
pub(super) fn attach_solids(
    prototype_ref: &PrototypeRef,
    members: &Members,
    layout: Layout,
    threads: usize,
    builder: &mut SceneBuilder<Query>,
) -> Result<(), embree::Error> {
    attach_list::<Sphere>(prototype_ref, members, layout, threads, builder)?;
    attach_list::<Cuboid>(prototype_ref, members, layout, threads, builder)?;
    attach_list::<Cone>(prototype_ref, members, layout, threads, builder)?;
    attach_list::<RoundedCone>(prototype_ref, members, layout, threads, builder)?;
    attach_list::<Disk>(prototype_ref, members, layout, threads, builder)?;
    let composed = SolidList::<Composition>::new(prototype_ref, members);
    if composed.len() > 0 {
        builder.attach_user(Single(composed))?;
    }
    Ok(())
}

fn attach_list<S: TracedSolid + HasFilter>(
    prototype_ref: &PrototypeRef,
    members: &Members,
    layout: Layout,
    threads: usize,
    builder: &mut SceneBuilder<Query>,
) -> Result<(), embree::Error> {
    let solids = SolidList::<S>::new(prototype_ref, members);
    if solids.len() == 0 {
        return Ok(());
    }
    attach_filtered(solids, layout, threads, builder)
}

fn attach_filtered<S: Filtered>(
    solids: S,
    layout: Layout,
    threads: usize,
    builder: &mut SceneBuilder<Query>,
) -> Result<(), embree::Error> {
    let attached = if layout.has_blocks(u64::from(solids.len())) {
        builder.attach_user(Blocked::new(solids, threads))
    } else {
        builder.attach_user(Single(solids))
    };
    attached.map(|_| ())
}

/// The bytes of all blocks of a group.
pub(super) fn kept_blocks_bytes(members: &Members, layout: Layout) -> usize {
    let counts = members.single_counts().map(u64::from);
    let blocks = counts.filter(|&count| layout.has_blocks(count));
    blocks.map(block_bytes).sum::<u64>() as usize
}
