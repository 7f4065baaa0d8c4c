//! Attaches the solids of a group to its Embree scene: a user geometry for
//! each kind that it contains.

use super::blocks::Blocked;
use super::cylinders::{Cylinders, KnownCylinders};
use super::described::{Described, SolidList};
use super::ends::{Capped, Ends, EndsKind, Mixed, Open};
use super::members::Members;
use super::solids::Single;
use crate::embree::{self, SceneBuilder};
use crate::solid::{Composition, Cone, Cuboid, Disk, RoundedCone, Sphere};
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
    let attached = if layout.has_blocks(u64::from(cylinders.len())) {
        builder.attach_user(Blocked::new(known, threads))
    } else {
        builder.attach_user(Single(known))
    };
    attached.map(|_| ())
}

/// Attaches the solids of other kinds.
pub(super) fn attach_solids(
    described: &Described,
    members: &Members,
    builder: &mut SceneBuilder<Query>,
) -> Result<(), embree::Error> {
    attach_list::<Sphere>(described, members, builder)?;
    attach_list::<Cuboid>(described, members, builder)?;
    attach_list::<Cone>(described, members, builder)?;
    attach_list::<RoundedCone>(described, members, builder)?;
    attach_list::<Disk>(described, members, builder)?;
    attach_list::<Composition>(described, members, builder)
}

fn attach_list<S: TracedSolid>(
    described: &Described,
    members: &Members,
    builder: &mut SceneBuilder<Query>,
) -> Result<(), embree::Error> {
    if members.of(S::LIST).len() > 0 {
        builder.attach_user(Single(SolidList::<S>::new(described, members)))?;
    }
    Ok(())
}
