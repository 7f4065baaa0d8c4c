//! Solids composed of others by set operations, regularised.
//!
//! **The set.** A leaf is a closed solid with an open interior. The operations are a
//! formula over the interiors: a point that is on no leaf's boundary satisfies it or not. The
//! composition is the closure of the points that do (Requicha's regularised
//! operations): a point belongs to it if every neighbourhood has an open piece in which the
//! formula is true. So a solid without itself is empty, solids that only touch have nothing
//! in common, solids that touch in a face are one without a face between them, and what
//! ends in the plane of another face leaves no film there.
//!
//! A point is *inside* if the formula is true in all open pieces around it, *outside* if
//! in none, and otherwise on the *boundary*. All queries follow from that:
//!
//! - `neighbourhood.rs`, with `across.rs`, decides what is around a point that is on the
//!   surfaces of several leaves; `piece.rs` and `bend.rs` describe these there, and `operand/`
//!   has those of each kind of solid;
//! - `first_order.rs` is what it takes from normals: `turned.rs` compares them in f64, for
//!   points of lines, `planes.rs` exactly, for stated points;
//! - `locate` below uses it for points as stated;
//! - `line.rs` orders the points where a line changes and classifies what is between them, and
//!   `crossings.rs` turns that into hits.

mod across;
mod bend;
mod circle;
mod crossings;
mod disjoint;
mod first_order;
mod leaf;
mod line;
mod neighbourhood;
mod operand;
mod piece;
mod planes;
mod turned;

use glam::DVec3;
use smallvec::SmallVec;

use super::spawn::{SOLVER_DISPLACEMENT, SpawnMargin};
use super::{AnySolid, Location, SolidKind, SurfacePoint};
use crate::math::Bounds;
pub use crossings::ComposedIntersection;
use neighbourhood::Neighbourhood;
use piece::{Nearness, Pieces, Viewed};
use planes::Planes;
use turned::Turned;

/// A solid that is composed of others by set operations: the closure of the result of
/// the operations on the operands' interiors. Its surface is the boundary of that.
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
    /// surface, where no other leaf has one too. What is taken away from something that
    /// is taken away is not.
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
    /// [`ComposedIntersection::leaf`].
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

    /// The solids that it is composed of, in the order of [`Composition::operands`].
    fn leaves(&self) -> SmallVec<[&AnySolid; 8]> {
        let mut leaves = SmallVec::new();
        self.for_each_leaf(false, &mut |solid, _| leaves.push(solid));
        leaves
    }

    /// The memory that it takes beside itself.
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

    /// A box that contains it: of a union the box of all boxes, of an intersection what
    /// is in all of them, of a difference the first. [`Bounds::EMPTY`] where that
    /// shows that nothing is left.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Solid(solid) => solid.bounds(),
            Self::Union(parts) => {
                let boxes = parts.iter().map(Self::bounds);
                boxes.fold(Bounds::EMPTY, |sum, bounds| sum.union(&bounds))
            }
            Self::Intersection(parts) => common_box(parts),
            Self::Difference(parts) => parts.first().map_or(Bounds::EMPTY, Self::bounds),
        }
    }

    /// Evaluates the formula at a place; `is_within` returns whether a leaf contains it in
    /// its interior.
    fn holds(&self, is_within: &[bool]) -> bool {
        self.holds_for(&mut is_within.iter().copied())
    }

    /// The same; takes one of `leaves` for each leaf of this formula and leaves the rest.
    fn holds_for(&self, leaves: &mut impl Iterator<Item = bool>) -> bool {
        match self {
            Self::Solid(_) => leaves.next().unwrap_or(false),
            Self::Union(parts) => parts
                .iter()
                .fold(false, |any, part| any | part.holds_for(leaves)),
            Self::Intersection(parts) => {
                let all = parts
                    .iter()
                    .fold(true, |all, part| all & part.holds_for(leaves));
                all && !parts.is_empty()
            }
            Self::Difference(parts) => {
                let mut parts = parts.iter();
                let first = parts.next().is_some_and(|part| part.holds_for(leaves));
                parts.fold(first, |rest, part| rest & !part.holds_for(leaves))
            }
        }
    }

    /// Where a point is, as stated.
    #[must_use]
    pub fn locate(&self, point: DVec3) -> Location {
        let solids = self.leaves();
        let located: SmallVec<[Location; 8]> =
            solids.iter().map(|solid| solid.locate(point)).collect();
        let mut is_within: SmallVec<[bool; 8]> = located
            .iter()
            .map(|location| *location == Location::Inside)
            .collect();
        let touched: SmallVec<[u32; 8]> = (0..)
            .zip(&located)
            .filter_map(|(leaf, location)| (*location == Location::Boundary).then_some(leaf))
            .collect();
        let holds = |is_within: &[bool]| self.holds(is_within);
        match touched.as_slice() {
            [] if holds(&is_within) => Location::Inside,
            [] => Location::Outside,
            &[leaf] => Neighbourhood::of_one_leaf(leaf, [], &mut is_within, holds).location(),
            several => {
                let mut pieces = Pieces::new();
                for &leaf in several {
                    let solid = solids[leaf as usize];
                    let from_anchor = point - solid.anchor();
                    let sizes = point.length() + solid.anchor().length() + solid.size();
                    Viewed {
                        leaf,
                        solid,
                        from_anchor,
                        displacement: SOLVER_DISPLACEMENT * sizes,
                        nearness: Nearness::Exactly(point),
                    }
                    .add_pieces(&mut pieces);
                }
                let found = match Planes::at(point, &pieces, &solids) {
                    Some(planes) => {
                        Neighbourhood::of_pieces(&pieces, &planes, &mut is_within, holds)
                    }
                    None => {
                        let turned = Turned(&pieces);
                        Neighbourhood::of_pieces(&pieces, &turned, &mut is_within, holds)
                    }
                };
                found.location()
            }
        }
    }

    /// Whether it contains a point. The boundary belongs to it.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.locate(point).is_held()
    }

    /// The point of a part of a leaf's surface that is nearest to a point that is
    /// seen from the leaf's anchor, with the normal that points out of the
    /// composition.
    ///
    /// # Panics
    /// When there is no such leaf.
    #[must_use]
    pub fn surface(
        &self,
        met: &ComposedIntersection,
        from_anchor: impl FnOnce(DVec3) -> DVec3,
    ) -> SurfacePoint {
        let solid = self.leaves()[met.leaf as usize];
        let part = met.intersection.part;
        let mut surface = solid.surface_point(part, from_anchor(solid.anchor()));
        if met.is_reversed {
            surface.normal = -surface.normal;
        }
        surface
    }

    /// As [`SpawnMargin::of_solid`], of a point that [`Composition::surface`] returned.
    ///
    /// # Panics
    /// When there is no such leaf.
    #[must_use]
    pub fn spawn_margin(&self, met: &ComposedIntersection, surface: &SurfacePoint) -> SpawnMargin {
        self.leaves()[met.leaf as usize].spawn_margin(surface)
    }
}

/// What is in the boxes of all operands of an intersection; [`Bounds::EMPTY`] if nothing is.
fn common_box(operands: &[Composition]) -> Bounds {
    let boxes = operands.iter().map(Composition::bounds);
    let common = boxes.reduce(|one, other| Bounds {
        lower: one.lower.max(other.lower),
        upper: one.upper.min(other.upper),
    });
    common
        .filter(|bounds| bounds.lower.cmple(bounds.upper).all())
        .unwrap_or(Bounds::EMPTY)
}
