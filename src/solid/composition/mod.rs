//! Solids composed of others by regularized set operations.
//!
//! **The set.** A leaf is a closed solid with an open interior. The operations are a formula
//! over the interiors: a point on no leaf's boundary satisfies it or not. The composition is
//! the closure of the points that do (Requicha's regularized operations): a point belongs to it
//! if every neighbourhood contains an open set in which the formula is true. So a solid minus
//! itself is empty, solids that only touch have nothing in common, solids that touch in a face
//! unite without a face between them, and a cut that ends in the plane of another face leaves
//! no film there.
//!
//! A point is *inside* if the formula is true in all open cells around it, *outside* if in
//! none, and otherwise on the *boundary*. All queries follow from that:
//!
//! - `neighbourhood.rs`, with `across.rs`, classifies the cells around a point on the surfaces
//!   of several leaves; `piece.rs` and `bend.rs` describe these surfaces there, and `operand/`
//!   has those of each kind of solid;
//! - `first_order.rs` is the interface for decisions from normals: `turned.rs` compares them in
//!   f64, for points of lines, `planes.rs` exactly, for stated points;
//! - `locate` below uses it for stated points;
//! - `line.rs` orders the points where a line crosses leaves and classifies the stretches
//!   between them, and `crossings.rs` turns that into hits.

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

/// A solid that is composed of others by set operations: the closure of the result of the
/// operations on the operands' interiors. Its surface is the boundary of that closure.
///
/// Scene files reject open ends, disks and operations without an operand. Here, an operation
/// without an operand is empty, and a solid with open ends counts as closed.
#[derive(Clone, Debug, PartialEq)]
pub enum Composition {
    /// A single solid.
    Solid(AnySolid),
    /// The points in any of the operands.
    Union(Vec<Composition>),
    /// The points in all operands.
    Intersection(Vec<Composition>),
    /// The points in the first operand and in none of the others.
    Difference(Vec<Composition>),
}

/// A solid that a [`Composition`] is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Operand {
    /// The solid.
    pub solid: AnySolid,
    /// Whether it is subtracted. Then the composition is on the outer side of its surface,
    /// unless another leaf has a surface there too. An operand that is subtracted twice is not
    /// subtracted.
    pub is_subtracted: bool,
}

impl Composition {
    /// The kind of the outermost operation. A single solid is a union of one.
    #[must_use]
    pub fn kind(&self) -> SolidKind {
        match self {
            Self::Solid(_) | Self::Union(_) => SolidKind::Union,
            Self::Intersection(_) => SolidKind::Intersection,
            Self::Difference(_) => SolidKind::Difference,
        }
    }

    /// The solids of all operands, from the first to the last.
    #[must_use]
    pub fn solids(&self) -> Vec<AnySolid> {
        self.operands()
            .into_iter()
            .map(|operand| operand.solid)
            .collect()
    }

    /// The operands; a position in the list is the [`ComposedIntersection::leaf`].
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

    /// The solids of all operands, in the order of [`Composition::operands`].
    fn leaves(&self) -> SmallVec<[&AnySolid; 8]> {
        let mut leaves = SmallVec::new();
        self.for_each_leaf(false, &mut |solid, _| leaves.push(solid));
        leaves
    }

    /// The heap memory that it uses.
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

    /// A box that contains it: for a union the box of all boxes, for an intersection the common
    /// box, for a difference the first box. [`Bounds::EMPTY`] if the boxes show that nothing is
    /// left.
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

    /// Evaluates the formula at a point; `is_within` has for each leaf whether the point is in
    /// its interior.
    fn evaluate(&self, is_within: &[bool]) -> bool {
        self.evaluate_next(&mut is_within.iter().copied())
    }

    /// Evaluates the formula; takes one item of `leaves` for each leaf and leaves the rest.
    fn evaluate_next(&self, leaves: &mut impl Iterator<Item = bool>) -> bool {
        match self {
            Self::Solid(_) => leaves.next().unwrap_or(false),
            Self::Union(parts) => parts
                .iter()
                .fold(false, |any, part| any | part.evaluate_next(leaves)),
            Self::Intersection(parts) => {
                let all = parts
                    .iter()
                    .fold(true, |all, part| all & part.evaluate_next(leaves));
                all && !parts.is_empty()
            }
            Self::Difference(parts) => {
                let mut parts = parts.iter();
                let first = parts.next().is_some_and(|part| part.evaluate_next(leaves));
                parts.fold(first, |rest, part| rest & !part.evaluate_next(leaves))
            }
        }
    }

    /// The location of a stated point.
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
        let is_inside = |is_within: &[bool]| self.evaluate(is_within);
        match touched.as_slice() {
            [] if is_inside(&is_within) => Location::Inside,
            [] => Location::Outside,
            &[leaf] => Neighbourhood::of_one_leaf(leaf, [], &mut is_within, is_inside).location(),
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
                        Neighbourhood::of_pieces(&pieces, &planes, &mut is_within, is_inside)
                    }
                    None => {
                        let turned = Turned(&pieces);
                        Neighbourhood::of_pieces(&pieces, &turned, &mut is_within, is_inside)
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

    /// The point of a hit, from the point relative to the leaf's anchor: the nearest point of
    /// the part of the leaf's surface, with the normal that points out of the composition.
    ///
    /// # Panics
    /// When there is no such leaf.
    #[must_use]
    pub fn surface(
        &self,
        hit: &ComposedIntersection,
        from_anchor: impl FnOnce(DVec3) -> DVec3,
    ) -> SurfacePoint {
        let solid = self.leaves()[hit.leaf as usize];
        let part = hit.intersection.part;
        let mut surface = solid.surface_point(part, from_anchor(solid.anchor()));
        if hit.is_reversed {
            surface.normal = -surface.normal;
        }
        surface
    }

    /// As [`SpawnMargin::of_solid`], for a point that [`Composition::surface`] returned.
    ///
    /// # Panics
    /// When there is no such leaf.
    #[must_use]
    pub fn spawn_margin(&self, hit: &ComposedIntersection, surface: &SurfacePoint) -> SpawnMargin {
        self.leaves()[hit.leaf as usize].spawn_margin(surface)
    }
}

/// The common part of the boxes of all operands of an intersection; [`Bounds::EMPTY`] if there
/// is none.
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
