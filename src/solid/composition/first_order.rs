//! The decisions of first order about the neighbourhood of a point.
//!
//! `neighbourhood.rs` divides the circle of every group of pieces at the crossings with other
//! groups. The decisions come from one of two sources:
//!
//! - `turned.rs` compares normals in f64, each turned by up to its θ. It serves points of
//!   lines, which are known only up to a displacement, and apexes.
//! - `planes.rs` compares exact normals. It serves stated points.

use glam::DVec3;

use super::bend::Angles;
use super::circle::Circle;

/// A direction on the circle of a group: one in each arc, and one for each end of an arc.
pub(super) struct Place<'a, E> {
    pub direction: DVec3,
    /// The error bound of the direction.
    pub error: f64,
    /// The groups whose circles contain the direction.
    pub groups: &'a [usize],
    /// The exact direction, if the source of the decisions has it.
    pub exact: E,
}

/// A source of decisions about pieces, which are given by their positions. A group is the
/// position of its first member.
pub(super) trait FirstOrder {
    /// An exact direction.
    type Exact;

    /// Whether pieces are exact. Then sides must not be computed in f64.
    const IS_EXACT: bool;

    /// Whether two pieces are the same circle.
    fn are_one(&self, one: usize, other: usize) -> bool;

    /// Passes the places of the circle of the group `own` to `look`. `others` are the other
    /// groups. `changes` are the angles at which members of the group change their order.
    fn for_each_place(
        &self,
        circle: &Circle,
        own: usize,
        others: &[usize],
        changes: &Angles,
        look: impl FnMut(&Place<Self::Exact>),
    );

    /// Whether a direction is inside of a piece. The circle of the piece does not contain the
    /// direction.
    fn is_within(&self, place: &Place<Self::Exact>, piece: usize) -> bool;

    /// The sine of the angle about the direction from the normal of a piece to that of another.
    /// Both their planes contain the direction, and the planes differ. It is exact up to some
    /// units of 2^-53 of itself. `None` if the normals in f64 are as good.
    fn sine(&self, place: &Place<Self::Exact>, one: usize, other: usize) -> Option<f64>;
}
