//! Solids composed of others by set operations.
//!
//! **The set.** A leaf is a closed solid. A point is inside, on the boundary or outside
//! of each leaf, exactly ([`ConvexSolid::locate`](super::ConvexSolid::locate)). With
//! outside < boundary < inside an intersection has the least of what its operands
//! have, a union the greatest, and the complement swaps inside and outside. A
//! difference is the first operand and the complement of each other one. What is not
//! outside belongs to the composition. So a difference takes away the *open* inside of
//! what is subtracted: the wall of a drilled hole belongs to the block.
//!
//! **What a line meets** is in `line.rs`.

mod change;
mod line;

use glam::DVec3;

use super::spawn::SpawnMargin;
use super::{AnySolid, Location, Part, SolidKind, SurfacePoint};
use crate::math::Bounds;
pub use line::ComposedMeeting;

/// A solid that is composed of others by set operations. Its points are those
/// that the operations say, its surface their boundary.
///
/// What a scene file states has no open ends, no disks and no operation without
/// an operand. An operation without an operand is empty, and a solid with open ends
/// counts as closed.
#[derive(Clone, Debug, PartialEq)]
pub enum Composition {
    /// A solid as it is.
    Solid(AnySolid),
    /// What is in any of them.
    Union(Vec<Composition>),
    /// What is in all of them.
    Intersection(Vec<Composition>),
    /// What is in the first and in none of the others.
    Difference(Vec<Composition>),
}

/// A solid that a [`Composition`] is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Operand {
    /// The solid.
    pub solid: AnySolid,
    /// Whether it is taken away: then the composition is on the other side of its
    /// surface. What is taken away from something that is taken away is not.
    pub is_subtracted: bool,
}

impl Composition {
    /// What it is called, by its outermost operation. A single solid is a union of one.
    #[must_use]
    pub fn kind(&self) -> SolidKind {
        match self {
            Self::Solid(_) | Self::Union(_) => SolidKind::Union,
            Self::Intersection(_) => SolidKind::Intersection,
            Self::Difference(_) => SolidKind::Difference,
        }
    }

    /// The solids that it is composed of, from the first to the last.
    #[must_use]
    pub fn solids(&self) -> Vec<AnySolid> {
        self.operands()
            .into_iter()
            .map(|operand| operand.solid)
            .collect()
    }

    /// The same with what becomes of them; a position in it is the
    /// [`ComposedMeeting::leaf`].
    #[must_use]
    pub fn operands(&self) -> Vec<Operand> {
        let mut operands = Vec::new();
        self.for_each_leaf(false, &mut |solid, is_subtracted| {
            operands.push(Operand {
                solid: *solid,
                is_subtracted,
            });
        });
        operands
    }

    fn for_each_leaf<'a>(&'a self, is_subtracted: bool, each: &mut impl FnMut(&'a AnySolid, bool)) {
        match self {
            Self::Solid(solid) => each(solid, is_subtracted),
            Self::Union(parts) | Self::Intersection(parts) => {
                for part in parts {
                    part.for_each_leaf(is_subtracted, each);
                }
            }
            Self::Difference(parts) => {
                for (position, part) in parts.iter().enumerate() {
                    part.for_each_leaf(is_subtracted ^ (position > 0), each);
                }
            }
        }
    }

    /// The memory that it holds beside itself.
    #[must_use]
    pub fn heap_bytes(&self) -> usize {
        match self {
            Self::Solid(_) => 0,
            Self::Union(parts) | Self::Intersection(parts) | Self::Difference(parts) => {
                let nested: usize = parts.iter().map(Self::heap_bytes).sum();
                size_of::<Self>() * parts.capacity() + nested
            }
        }
    }

    /// A box that holds it: of a union the box of all boxes, of an intersection what
    /// is in all of them, of a difference the first. [`Bounds::EMPTY`] where that
    /// shows that nothing is left.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let boxes = |parts: &[Self]| parts.iter().map(Self::bounds).collect::<Vec<_>>();
        match self {
            Self::Solid(solid) => solid.bounds(),
            Self::Union(parts) => {
                let boxes = boxes(parts).into_iter();
                boxes.fold(Bounds::EMPTY, |sum, bounds| sum.union(&bounds))
            }
            Self::Intersection(parts) => {
                let common = boxes(parts).into_iter().reduce(|one, other| Bounds {
                    lower: one.lower.max(other.lower),
                    upper: one.upper.min(other.upper),
                });
                common
                    .filter(|bounds| bounds.lower.cmple(bounds.upper).all())
                    .unwrap_or(Bounds::EMPTY)
            }
            Self::Difference(parts) => parts.first().map_or(Bounds::EMPTY, Self::bounds),
        }
    }

    /// Where a point is, exactly.
    #[must_use]
    pub fn locate(&self, point: DVec3) -> Location {
        let located = |parts: &[Self]| {
            let parts = parts.iter();
            parts.map(|part| part.locate(point)).collect::<Vec<_>>()
        };
        let located = match self {
            Self::Solid(solid) => return solid.locate(point),
            Self::Union(parts) => located(parts).into_iter().max(),
            Self::Intersection(parts) => located(parts).into_iter().min(),
            Self::Difference(parts) => {
                let operands = located(parts).into_iter().enumerate();
                let operands = operands.map(|(position, location)| match position {
                    0 => location,
                    _ => location.of_complement(),
                });
                operands.min()
            }
        };
        located.unwrap_or(Location::Outside)
    }

    /// Whether it holds a point. The boundary belongs to it.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.locate(point).is_held()
    }

    /// The point of a part of a leaf's surface that is nearest to a point that is
    /// seen from the leaf's anchor, with the normal that points out of the
    /// composition; and what a query that starts there may be displaced by.
    ///
    /// # Panics
    /// When there is no such leaf.
    #[must_use]
    pub fn surface(
        &self,
        leaf: u32,
        part: Part,
        from_anchor: impl FnOnce(DVec3) -> DVec3,
    ) -> (SurfacePoint, SpawnMargin) {
        let Operand {
            solid,
            is_subtracted,
        } = self.operands()[leaf as usize];
        let mut surface = solid.surface_point(part, from_anchor(solid.anchor()));
        if is_subtracted {
            surface.normal = -surface.normal;
        }
        let margin = solid.spawn_margin(&surface);
        (surface, margin)
    }
}
