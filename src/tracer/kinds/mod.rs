//! The specifics of each kind of solid in the tracer, one file per kind.

mod cone;
mod cuboid;
mod cylinder;
mod disk;
mod rounded_cone;
mod sphere;

use super::filter::FilterOf;
use super::prototype::{Attaching, InPrototype, Numbers};
use crate::embree;
use crate::scene::Listed;
use crate::solid::ConvexSolid;

/// A convex kind of solid in the tracer.
pub(crate) trait TracedKind: ConvexSolid + Listed {
    /// The filter of its blocks.
    type Filter: FilterOf<Self>;

    /// Attaches the solids with these numbers in the list of a prototype.
    ///
    /// # Errors
    /// When Embree runs out of memory.
    fn attach(numbers: &Numbers, to: &mut Attaching) -> Result<(), embree::Error> {
        to.attach(numbers, InPrototype::<Self>::new())
    }
}
