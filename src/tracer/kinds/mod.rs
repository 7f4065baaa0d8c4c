//! The specifics of each kind of solid in the tracer, one file per kind.

mod cone;
mod cuboid;
mod cylinder;
mod disk;
mod rounded_cone;
mod sphere;

use super::filter::Filtered;
use super::prototype::{Attaching, GroupSolids, InPrototype, Members, Numbers, Single};
use crate::embree;
use crate::solid::Composition;
use crate::with_solid_kind;

/// A convex kind of solid in the tracer.
pub(crate) trait TracedKind: Filtered {
    /// Attaches the solids with these numbers in the list of a prototype.
    ///
    /// # Errors
    /// When Embree runs out of memory.
    fn attach(numbers: &Numbers, to: &mut Attaching) -> Result<(), embree::Error> {
        to.attach(numbers, InPrototype::<Self>::new())
    }
}

/// Attaches all solids of a group: one user geometry per kind.
///
/// Set operations are a primitive each: a few bytes of a copy could represent only the box,
/// which Embree tests as well.
pub(crate) fn attach_all(members: &Members, to: &mut Attaching) -> Result<(), embree::Error> {
    for (kind, numbers) in members.solids() {
        with_solid_kind!(kind, S => S::attach(numbers, to))?;
    }
    Ok(())
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
