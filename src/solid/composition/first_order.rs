//! The decisions of first order about the neighbourhood of a point.
//!
//! `neighbourhood.rs` divides the circle of every group of pieces where other groups cross it.
//! It takes the decisions about that from one of two sources:
//!
//! - `turned.rs` compares normals in f64, each turned by up to its θ. It serves the points of
//!   lines, which are known up to a displacement only, and apexes.
//! - `planes.rs` compares exact normals. It serves stated points.

use glam::DVec3;

use super::bend::Angles;
use super::circle::Circle;

/// A direction on the circle of a group: one in each arc, and each that bounds arcs.
pub(super) struct Place<'a, W> {
    pub direction: DVec3,
    /// By how much the direction may be off.
    pub error: f64,
    /// The groups whose circles contain the direction.
    pub groups: &'a [usize],
    /// The direction as the source of the decisions knows it.
    pub way: W,
}

/// A source of decisions about pieces, which it knows by their positions. A group is the
/// position of its first member.
pub(super) trait FirstOrder {
    /// A direction.
    type Way;

    /// Whether pieces are known exactly, so that sides must not be taken from f64.
    const IS_EXACT: bool;

    /// Whether two pieces are one circle.
    fn are_one(&self, one: usize, other: usize) -> bool;

    /// Hands on the places of the circle of the group `own`. `others` are the other
    /// groups. `changes` are the angles where members of the group change their order.
    fn each_place(
        &self,
        circle: &Circle,
        own: usize,
        others: &[usize],
        changes: &Angles,
        look: impl FnMut(&Place<Self::Way>),
    );

    /// Whether a direction that the circle of a piece does not contain is inside of the piece.
    fn is_within(&self, place: &Place<Self::Way>, piece: usize) -> bool;

    /// The sine of the turn about the direction from the normal of a piece to that of another;
    /// the direction is in both their planes, which differ. It is exact up to some
    /// units of 2^-53 of itself. `None` if the normals in f64 are as good.
    fn sine(&self, place: &Place<Self::Way>, one: usize, other: usize) -> Option<f64>;
}
