//! Which solids of a block Embree's own f32 ray may meet: what is left is solved in f64.
//!
//! A block is up to [`LANES`] solids that are near each other, one primitive of Embree's. A
//! *filter* is one cache line with a small copy of each of them, in the frame of their group:
//! numbers of eight bits in a [`Cell`] that contains them all. A copy contains its
//! solid, and all that can be wrong with the ray, so a solid whose copy the ray misses is
//! not hit. Survivors are solved as they are where each solid is a primitive of its own, so
//! that answers are the same bits.
//!
//! # What a copy must contain
//!
//! Write v = 2^-24, `O` for the greatest distance of the origin of Embree's rays from the
//! center of the frame, which is at least its radius R, and let a hit be at the parameter τ
//! of Embree's ray `o + τ d`, in the frame. What the solver calls a hit is within the solid,
//! and Embree's ray at τ is off from the solver's, by no more than a part of the slack `S`:
//! [`Frame::slack`]. From the ray that enters a frame that is 3.1 v R (`docs/derivations.md`,
//! section 4: 1 for the origin, 2 for the direction, 0.01 for f64).
//!
//! [`Cell::near`] moves the ray to its point that is nearest to the middle of the cell, with
//! a direction of length 1, in units of the cell; numbers are then of the cell's size, as are
//! their roundings, wherever the ray comes from. The corner and the middle of a cell have
//! coordinates of at most 1.01 R from the center, so they are within 3 O of `o`; and a hit is within
//! 2 O of it. Displacements, in the frame:
//!
//! | source | across the ray | along it |
//! |---|---|---|
//! | components of the direction times one over its length, each rounded: v, on a way of 2 O | 2 v O | |
//! | `o - corner`, times the unit, a rounding each, of 3 O | 6 v O | |
//! | the move: a product and a sum, on a way of 3 O; the sum is of the size of the cell, 2 O | 5 v O | |
//! | the end of the ray: its length rounded twice and a product, of 2 O | | 6 v O |
//!
//! The length that divides need not be exact: the same number multiplies the end. In sum they
//! are below 20 v O:
//!
//! ```text
//! S >= (how far Embree's ray is from the solver's) + 20 v O                        (1)
//! ```
//!
//! The growth of boxes, 32 v R, is more than the 23.2 v R that rays need which enter a frame at its sphere.
//! A cell is the union of its solids' boxes, each grown by S or more. So, if there is a hit:
//! there is a `T` in the range of the near ray such that its point is within S of the
//! solid, and in the cell.
//!
//! # Roundings in the cell
//!
//! A point of the cell is within 221 units of its middle (half the diagonal of 255), and so
//! is the ray's point that is nearest to it, if the ray has a point in the cell. That point is
//! computed to within 36 v O, below twice the slack, and a cell has units of which the slack is at
//! most 32. So the near ray's origin is within 285 of the middle, no more than 285 away from
//! any point in question, and ranges are clipped to [`LONGEST`], 320. It is within 506 of every
//! point of the cell. A kind of solid derives from that what roundings its test needs: 2^-24 of such
//! numbers, a small part of a unit.
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
pub(crate) use cylinders::CylinderFilter;
pub use losses::FilterLosses;
pub(crate) use packet::NearPacket;
pub(crate) use sheath::{Sheath, Sheathed};
pub(crate) use spheres::SphereFilter;

use crate::embree::Ray32;
use crate::math::{LANES, LaneMask};
use crate::tracer::frame::Frame;

/// The size of every filter: a cache line.
pub(crate) const FILTER_BYTES: usize = 64;

/// The copies of up to [`LANES`] solids, and which of them a ray may meet.
pub(crate) trait Filter: Send + Sync + 'static {
    /// The cell that contains them.
    fn cell(&self) -> &Cell;

    /// Whether a ray may meet the solid of a lane; `false` for a lane without one. Loops over
    /// lanes, and over rays, become vector instructions where there is no branch in it.
    fn may_meet(&self, lane: usize, ray: &NearRay) -> bool;

    /// Whether any line within `apart` of a ray, between -[`LONGEST`] and [`LONGEST`], may meet the
    /// solid of a lane: a cheaper test that rejects most. `apart` is at most [`MOST_APART`],
    /// and greater than the distance by 1 %. `true` says nothing.
    ///
    /// [`LONGEST`]: cell::LONGEST
    /// [`MOST_APART`]: packet::MOST_APART
    #[inline(always)]
    fn may_pass(&self, _lane: usize, _ray: &NearRay, _apart: f32) -> bool {
        true
    }
}

/// The filter of a kind of solid.
pub(crate) trait FilterOf<S>: Filter {
    /// That of up to eight solids of a group with this frame, with a share of the margins that
    /// it needs: less than all of them loses hits.
    fn new(solids: &[S], frame: &Frame, share: f64) -> Self;
}

/// The lanes whose solids a ray may meet, as bits.
#[inline(always)]
pub(crate) fn survivors(filter: &impl Filter, ray: &Ray32) -> u8 {
    let ray = filter.cell().near(ray);
    let mut may_meet = LaneMask::splat(false);
    for lane in 0..LANES {
        may_meet.0[lane] = filter.may_meet(lane, &ray);
    }
    may_meet.bits()
}
