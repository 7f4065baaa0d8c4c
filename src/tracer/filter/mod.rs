//! Filters: the solids of a block that Embree's f32 ray may hit. Only these are solved in f64.
//!
//! A block consists of up to [`LANES`] solids that are near each other, and is one primitive of
//! Embree's. A *filter* is one cache line with a small copy of each of them, in the frame of
//! their group: numbers of eight bits in a [`Cell`] that contains them all. A copy contains its
//! solid with a margin for all errors of the ray, so a ray that misses the copy misses the
//! solid. The solver for survivors is that of single primitives, so results are the same bits.
//!
//! # What a copy must contain
//!
//! Let v = 2^-24, let `O` be the greatest distance of the origin of Embree's rays from the
//! center of the frame, at least its radius R, and let a hit be at the parameter τ of Embree's
//! ray `o + τ d`, in the frame. The solver's hit is within the solid, and Embree's ray at τ is
//! off from the solver's by no more than a part of the slack `S`: [`Frame::slack`]. For the ray
//! that enters a frame, that is 3.1 v R (`docs/derivations.md`, section 4: 1 for the origin, 2
//! for the direction, 0.01 for f64).
//!
//! [`Cell::near`] moves the ray to its point nearest to the middle of the cell, with a
//! direction of length 1, in units of the cell. Then numbers and their roundings are of the
//! cell's size, for rays from anywhere. The corner and the middle of a cell have coordinates of
//! at most 1.01 R from the center, so they are within 3 O of `o`; and a hit is within 2 O of
//! it. The displacements, in the frame, are
//!
//! | source | across the ray | along it |
//! |---|---|---|
//! | components of the direction times one over its length, each rounded: v, over a length of 2 O | 2 v O | |
//! | `o - corner`, times the unit, a rounding each, of 3 O | 6 v O | |
//! | the move: a product and a sum, over a length of 3 O; the sum is of the size of the cell, 2 O | 5 v O | |
//! | the end of the ray: its length rounded twice and a product, of 2 O | | 6 v O |
//!
//! The length by which the direction is divided need not be exact: the same number multiplies
//! the end. The sum is below 20 v O:
//!
//! ```text
//! S >= (how far Embree's ray is from the solver's) + 20 v O                        (1)
//! ```
//!
//! The growth of boxes, 32 v R, exceeds the 23.2 v R for rays that enter a frame at its sphere.
//! A cell is the union of its solids' boxes, each grown by at least S. So, if there is a hit,
//! there is a `T` in the range of the near ray such that its point is within S of the solid,
//! and in the cell.
//!
//! # Roundings in the cell
//!
//! A point of the cell is within 221 units of its middle (half the diagonal of 255), and so is
//! the ray's point nearest to the middle, if the ray has a point in the cell. That point is
//! computed to within 36 v O, below twice the slack, and the slack is at most 32 units of a
//! cell. So the near ray's origin is within 285 of the middle, at most 285 from any relevant
//! point, and ranges are clipped to [`LONGEST`], 320. It is within 506 of every point of the
//! cell. Each kind of solid derives the margin for its test from that: 2^-24 of such numbers, a
//! small part of a unit.
//!
//! [`LONGEST`]: cell::LONGEST

mod cell;
mod cylinders;
mod losses;
mod packet;
mod sheath;
mod spheres;
#[cfg(test)]
mod tests;

pub(crate) use cell::{Cell, NearRay};
pub use losses::FilterLosses;
pub(crate) use packet::NearPacket;
pub(crate) use sheath::{Sheath, Sheathed};

use crate::embree::Ray32;
use crate::math::{LANES, LaneMask};
use crate::scene::Listed;
use crate::solid::ConvexSolid;
use crate::tracer::frame::Frame;

/// The size of every filter: a cache line.
pub(crate) const FILTER_BYTES: usize = 64;

/// The copies of up to [`LANES`] solids, and the test for rays that may hit them.
pub(crate) trait Filter: Send + Sync + 'static {
    /// The cell that contains them.
    fn cell(&self) -> &Cell;

    /// Whether a ray may hit the solid of a lane; `false` for an empty lane. Loops over lanes,
    /// and over rays, become vector instructions if there is no branch in it.
    fn may_hit(&self, lane: usize, ray: &NearRay) -> bool;

    /// Whether any line within `apart` of a ray, between -[`LONGEST`] and [`LONGEST`], may hit
    /// the solid of a lane: a cheaper test that rejects most. `apart` is at most
    /// [`MOST_APART`], and greater than the distance by 1 %. `true` is inconclusive.
    ///
    /// [`LONGEST`]: cell::LONGEST
    /// [`MOST_APART`]: packet::MOST_APART
    #[inline(always)]
    fn may_hit_near(&self, _lane: usize, _ray: &NearRay, _apart: f32) -> bool {
        true
    }
}

/// A kind of solid whose blocks have a filter.
pub(crate) trait Filtered: ConvexSolid + Listed {
    /// The filter.
    type Filter: Filter;

    /// The filter of up to eight solids of a group with this frame, with a share of the
    /// required margins: less than all of them loses hits.
    fn filter(solids: &[Self], frame: &Frame, share: f64) -> Self::Filter;
}

/// The lanes whose solids a ray may hit, as bits.
#[inline(always)]
pub(crate) fn survivors(filter: &impl Filter, ray: &Ray32) -> u8 {
    let ray = filter.cell().near(ray);
    let mut may_hit = LaneMask::splat(false);
    for lane in 0..LANES {
        may_hit.0[lane] = filter.may_hit(lane, &ray);
    }
    may_hit.bits()
}
