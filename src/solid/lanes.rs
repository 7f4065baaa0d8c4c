//! Eight rays against a cylinder, or a ray against eight cylinders.
//!
//! A lane runs the same code as `triple_product` and `slab`, so it has the bits of
//! [`triple_product::first`](super::triple_product::first). This file has only the order: a
//! loop over the lanes for the lines, one for the ends at which they enter if any reaches its
//! wall, one for the ends at which they leave if any is inside and undecided. The loop bodies
//! are inlined calls without an early exit and without an `Option`, so the compiler can compute
//! both sides of each branch and vectorize the loops. What it could not inline is left to the
//! scalar solver, lane by lane: exact products, lines along or across the axis, lines that
//! graze the wall, and open ends.
//!
//! # Avoiding exact products
//!
//! If the sine of the angle between ray and axis is below 1/4, the products of `n = a × d` have
//! to be exact, which takes longer than everything else. In 22 of 100 cases one of eight random
//! directions is such a ray. But most of those rays miss the cylinder by far more than the
//! roundings in question, and exact products would confirm it. Let `n'` and `w'` be from
//! rounded products and `n` and `w` from exact ones, u = 2^-53, and `X = |a| |d|`. A component
//! of `n'` is off by at most 2u of the sum of the sizes of its two products, so that
//! `|n' - n| <= 4u X`; and `x·n` is rounded with `3u |x| |n|`. Hence
//!
//! ```text
//! |w' - w| <= 12u |x| X,    r |n| <= r |n'| + 4u r X
//! ```
//!
//! and the computed `D` is negative if `|w| > r |n| (1 + 8u)`, certainly if
//!
//! ```text
//! |w'| > 2 r |n'| + 2^-48 (|x| + r) X                                      (1)
//! ```
//!
//! with 2^-48 = 32u, more than the required 16u. No line that counts as parallel is among them:
//! its `|n'|` is below `5u X`, so `|w'|` is below `6u |x| X`. Squared, by
//! `(p + q)² <= 2 p² + 2 q²`, without a root:
//!
//! ```text
//! w'² > 8 r² |n'|² + 2^-93 (|x|² + r²) |a|² |d|²                           (2)
//! ```
//!
//! `(|x| + r)²` is at most `2 (|x|² + r²)`, which makes the last factor
//! `2 · 2 · 2^-96` = 2^-94, doubled for the roundings of (2) itself.

use std::cell::Cell;

use glam::DVec3;

use super::slab::{Disks, FirstIntersection, Overlap, RoundedEnd};
use super::triple_product::{Axis, Line, Roots, StatedAxis, answer, slab};
use super::{Caps, ChordEnd, ties};
use crate::math::{LANES, LaneMask, LaneVectors, Lanes, power_of_two};

/// The factor of the second term of (2).
const ROUNDINGS: f64 = power_of_two(-93);

/// Eight cylinders, or the same one eight times.
#[derive(Clone, Copy, Debug)]
pub struct CylinderLanes<C> {
    /// `p1 - p0`, rounded as f64 rounds it.
    pub axis: LaneVectors,
    /// The radii.
    pub radius: Lanes,
    /// Which ends are closed.
    pub caps: C,
}

/// The closed ends of eight cylinders. One type per case, so that cylinders with equal caps
/// need no test.
pub trait LaneCaps: Copy {
    /// The caps of a lane.
    fn lane(&self, lane: usize) -> Caps;
}

/// Tubes, open at both ends.
#[derive(Clone, Copy, Debug)]
pub struct AllOpen;

/// Disks at both ends.
#[derive(Clone, Copy, Debug)]
pub struct AllCapped;

/// Caps that differ.
#[derive(Clone, Copy, Debug)]
pub struct MixedCaps(pub [Caps; LANES]);

impl LaneCaps for AllOpen {
    #[inline(always)]
    fn lane(&self, _lane: usize) -> Caps {
        Caps::None
    }
}

impl LaneCaps for AllCapped {
    #[inline(always)]
    fn lane(&self, _lane: usize) -> Caps {
        Caps::Both
    }
}

impl LaneCaps for MixedCaps {
    #[inline(always)]
    fn lane(&self, lane: usize) -> Caps {
        self.0[lane]
    }
}

/// Eight rays relative to the `p0` of their cylinders, with their ranges.
#[derive(Clone, Copy, Debug)]
pub struct RayLanes {
    /// The origins, relative to `p0`.
    pub from_p0: LaneVectors,
    /// The directions.
    pub direction: LaneVectors,
    /// The positions of the origins on the whole rays.
    pub shift: Lanes,
    /// The least parameter of the whole ray.
    pub t_min: Lanes,
    /// The greatest.
    pub t_max: Lanes,
}

/// [`triple_product::first`](super::triple_product::first) in every `active` lane: whether
/// there is a first intersection, and its parameter on the whole ray, which has no meaning
/// otherwise.
#[inline(always)]
#[must_use]
pub fn first<C: LaneCaps>(
    cylinders: &CylinderLanes<C>,
    rays: &RayLanes,
    active: &LaneMask,
) -> (LaneMask, Lanes) {
    let mut lines = LineLanes::nowhere();
    let (mut apart, mut wanted) = (LaneMask::splat(false), LaneMask::splat(false));
    for lane in 0..LANES {
        let axis = cylinders.axis(lane);
        let (x, d) = (rays.from_p0.lane(lane), rays.direction.lane(lane));
        let line = Line::rounded(&axis, x, d);
        let is_near_axis = line.is_near_axis(&axis, d);
        let is_apart = active.0[lane] & is_near_axis & !certainly_misses(&axis, x, d, &line);
        let is_wanted = active.0[lane] & !is_near_axis & (line.discriminant >= 0.0);
        lines.set(lane, &line);
        apart.0[lane] = is_apart;
        wanted.0[lane] = is_wanted;
    }
    let (mut hits, mut t) = (LaneMask::splat(false), Lanes::splat(0.0));
    if wanted.any() {
        let mut enter = Lanes::splat(0.0);
        let mut rest = LaneMask::splat(false);
        for lane in 0..LANES {
            let is_unsettled = Cell::new(false);
            let overlap = overlap(cylinders, rays, &lines, lane, &is_unsettled);
            let disks = Disks::of(overlap.slab());
            let (is_inside, RoundedEnd { end, is_open }) = overlap.enter(&disks);
            // Both ends are tested here, so that the next loop need not compute the bound
            // again.
            let is_open = is_open | overlap.is_leave_open(&disks);
            let (nn, discriminant) = (lines.nn.0[lane], lines.discriminant.0[lane]);
            let is_grazing = ties::is_grazing(&cylinders.axis(lane), nn, discriminant);
            let is_hit = cylinders.is_hit(rays, lane, &end);
            let is_inside = wanted.0[lane] & is_inside;
            enter.0[lane] = end.t;
            t.0[lane] = end.t + rays.shift.0[lane];
            hits.0[lane] = is_inside & is_hit;
            rest.0[lane] = is_inside & !is_hit;
            let is_apart = is_open | is_grazing | overlap.is_across() | is_unsettled.get();
            apart.0[lane] |= wanted.0[lane] & is_apart;
        }
        if rest.any() {
            for lane in 0..LANES {
                let is_unsettled = Cell::new(false);
                let overlap = overlap(cylinders, rays, &lines, lane, &is_unsettled);
                let end = overlap.leave(&Disks::of(overlap.slab()), enter.0[lane]);
                let is_hit = rest.0[lane] & cylinders.is_hit(rays, lane, &end);
                let exit = end.t + rays.shift.0[lane];
                t.0[lane] = if is_hit { exit } else { t.0[lane] };
                hits.0[lane] |= is_hit;
                apart.0[lane] |= rest.0[lane] & is_unsettled.get();
            }
        }
    }
    if apart.any() {
        return one_by_one(apart, *cylinders, *rays, (hits, t));
    }
    (hits, t)
}

/// The terms of eight lines.
struct LineLanes {
    n: LaneVectors,
    nn: Lanes,
    discriminant: Lanes,
}

impl LineLanes {
    #[inline(always)]
    fn nowhere() -> Self {
        Self {
            n: LaneVectors::splat(DVec3::ZERO),
            nn: Lanes::splat(0.0),
            discriminant: Lanes::splat(0.0),
        }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, line: &Line<f64>) {
        self.n.set(lane, line.n);
        self.nn.0[lane] = line.nn;
        self.discriminant.0[lane] = line.discriminant;
    }
}

/// Wall and slab of a lane.
#[inline(always)]
fn overlap<'a, C: LaneCaps>(
    cylinders: &CylinderLanes<C>,
    rays: &RayLanes,
    lines: &LineLanes,
    lane: usize,
    is_unsettled: &'a Cell<bool>,
) -> Overlap<f64, Roots<f64, LaneAxis<'a>>> {
    let axis = cylinders.rounded_axis(lane, is_unsettled);
    let (x, d) = (rays.from_p0.lane(lane), rays.direction.lane(lane));
    let (nn, discriminant) = (lines.nn.0[lane], lines.discriminant.0[lane]);
    let roots = Roots::of_ordinary(&axis, x, d, lines.n.lane(lane), nn, discriminant);
    slab(&axis, x, d).overlap(roots)
}

impl<C: LaneCaps> CylinderLanes<C> {
    #[inline(always)]
    fn is_hit(&self, rays: &RayLanes, lane: usize, end: &ChordEnd) -> bool {
        end.is_hit(
            self.caps.lane(lane),
            rays.shift.0[lane],
            rays.t_min.0[lane],
            rays.t_max.0[lane],
        )
    }

    /// The axis of a lane, without exact products.
    #[inline(always)]
    pub(super) fn rounded_axis<'a>(
        &self,
        lane: usize,
        is_unsettled: &'a Cell<bool>,
    ) -> LaneAxis<'a> {
        LaneAxis {
            stated: self.axis(lane),
            is_unsettled,
        }
    }

    #[inline(always)]
    fn axis(&self, lane: usize) -> StatedAxis<f64> {
        StatedAxis {
            a: self.axis.lane(lane),
            radius: self.radius.0[lane],
        }
    }
}

/// An axis that records whether exact products were requested.
#[derive(Clone, Copy)]
pub(super) struct LaneAxis<'a> {
    stated: StatedAxis<f64>,
    is_unsettled: &'a Cell<bool>,
}

impl Axis<f64> for LaneAxis<'_> {
    #[inline(always)]
    fn a(&self) -> DVec3 {
        self.stated.a
    }

    #[inline(always)]
    fn radius(&self) -> f64 {
        self.stated.radius
    }

    #[inline(always)]
    fn aa(&self) -> f64 {
        self.stated.aa()
    }

    #[inline(always)]
    fn length(&self) -> f64 {
        self.stated.length()
    }

    #[inline(always)]
    fn rr_aa(&self) -> f64 {
        self.stated.rr_aa()
    }

    #[inline(always)]
    fn exact_constant_term(&self, _x: DVec3) -> f64 {
        self.is_unsettled.set(true);
        f64::NAN
    }
}

/// Whether a line certainly misses, by (2).
#[inline(always)]
pub(super) fn certainly_misses(
    axis: &impl Axis<f64>,
    x: DVec3,
    d: DVec3,
    line: &Line<f64>,
) -> bool {
    let rr = axis.radius() * axis.radius();
    let roundings = ROUNDINGS * (x.dot(x) + rr) * (axis.aa() * d.dot(d));
    line.w * line.w > 8.0 * rr * line.nn + roundings
}

/// `answers`, with those of the scalar solver in the lanes of `mask`.
#[cold]
#[inline(never)]
fn one_by_one<C: LaneCaps>(
    mask: LaneMask,
    cylinders: CylinderLanes<C>,
    rays: RayLanes,
    answers: (LaneMask, Lanes),
) -> (LaneMask, Lanes) {
    let (mut hits, mut ts) = answers;
    for lane in (0..LANES).filter(|&lane| mask.0[lane]) {
        let question = FirstIntersection {
            caps: cylinders.caps.lane(lane),
            shift: rays.shift.0[lane],
            t_min: rays.t_min.0[lane],
            t_max: rays.t_max.0[lane],
        };
        let (x, d) = (rays.from_p0.lane(lane), rays.direction.lane(lane));
        let intersection = answer(&cylinders.axis(lane), x, d, question);
        hits.0[lane] = intersection.is_some();
        if let Some(intersection) = intersection {
            ts.0[lane] = intersection.t;
        }
    }
    (hits, ts)
}
