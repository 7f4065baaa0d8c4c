//! The decisions of the triple-product solver that its rounded numbers settle.
//!
//! The solver decides by signs: of the discriminant, of heights over the planes of the disks,
//! and of a `t` near zero. This file bounds the difference between the computed numbers and
//! those of exact arithmetic on the cylinder and the ray as stated. A number that is farther
//! from zero than its bound has the exact sign. If all have, the solver's result is the exact
//! one; if not, `exact` decides. The bounds cover the roundings of `a = p1 - p0` and
//! `x = o - p0` too, so this is true for any f64 numbers.
//!
//! The check is separate from the solver and computes the same numbers again. Bounds within the
//! solver cost its other users 3 to 20 % of the time of a traversal, even if they were compiled
//! away: its numbers had to stay in registers for them.
//!
//! Let u = 2^-53, `A = |a|`, `X = |x|`, `K = |a| |d|`, `N = |n|`, `k = K / N`, the reciprocal
//! of the sine of the angle between ray and axis, and r the radius.
//!
//! # Hit or miss of the infinite wall
//!
//! `n` is off by at most `5 u K`: `4 u K` from rounded products, u from `a`. So `w = x·n` is
//! off by `5 u X K + u X K + 3 u X K`, and the line passes at more than the radius if
//! `|w| > r N + u (9 X + 5 r) K`. Squared, since `(p + q)² <= (1 + η) p² + (1 + 1/η) q²` for
//! any `η > 0` and `(9 X + 5 r)² <= 162 (X² + r²)`, a line certainly misses the wall if
//!
//! ```text
//! w² > (1 + η) r² N² + ρ (X² + r²) K²                                      (1)
//! ```
//!
//! and certainly enters it if the same inequality is true with `w²` and `r² N²` exchanged. That
//! needs `ρ >= 162 u² (1 + 1/η)`, 2^-80.6 for the `η` of `WIDER`. The following needs more:
//! `ROUNDINGS` is 2^-54. Then a line that certainly enters has `r² N² > 2^-54 X² K²`, so that
//!
//! ```text
//! X < 2^27 r,   k < 2^27,   g = D / (r² N²) > 2^-18.1                      (2)
//! ```
//!
//! # Heights
//!
//! For such a line, by (2) and with y the height at a root of the wall,
//!
//! - the origin is within `3 r + (X + |y|/A) / k` of the axis: the distance from the axis
//!   changes by no more than the line moves sideways;
//! - `m` is off by `6 u A X`, and `m·n` by `u N (14 A X + 24 k A r + 8 |y|)`;
//! - `p0` is within `2 r + |y| / (A k)` of the line, so that the rounding of `a` moves `w` by
//!   that times `u K`, and `w` is off by `u N (24 X + 2 k r + |y|/A)` in all: for `k > 4` the
//!   products of `n` are exact;
//! - `D` is then off by `u r N² (48 X + 24 k r + 2 |y|/A)`, and `|a| √D` by that times `A / √D`
//!   and by 6 u of itself;
//! - a root `(-(m·n) ∓ |a| √D) / N²` displaces the height by `4/3 u k / √g (63 A X + 57 k A r +
//!   11 |y|)`, and the rounding of `N²`, at most `13 u k N²`, by
//!   `4/3 · 13 u k (A X + A r + |y|)`. A root `C / q` displaces it by less: its C is within
//!   `u A² r (31 X + 40 r)`;
//! - `x·a`, `d·a`, `|a|²` and the sum add `14 A X + 8 A r + 8 |y| + 6 A²` u.
//!
//! The sum is below `u k / √g (116 A X + 102 k A r + 40 |y|) + 6 u A²`. With `√g > 2^-9.1` a
//! height that is farther from both planes than
//!
//! ```text
//! 2^-36 k A (X + A + k r)                                                  (3)
//! ```
//!
//! is on the computed side: half of (3) covers all terms except those of `|y|`, which are below
//! a hundredth of the distance from the plane and a fifth of (3).
//!
//! # The sign of a root
//!
//! A root whose terms do not cancel is at least a third of `|a| √D / N²` in size. By (1) and
//! (2) `|a| √D` is above `A K 2^-27.6 (X + r)` and above `A r N 2^-9.1`, and the sum, with
//! `|y| <= A X` at the origin, is off by less than 2^-8 of it. So its sign is right.
//!
//! A root `C / q` has the sign of `C`. There `|C|` is at most `5 r² A²`. A rounded `C` of at
//! least `2^-20 r² A²` is off by less than `40 u A² r (X + r)`, which is less by (2). A smaller
//! one is computed from exact products of the rounded `a` and `x`, and off by at most
//! `5 u A² r (X + r)`.
//!
//! The `t` at a disk's plane has the sign of `x·a` or `x·a - |a|²` and that of `d·a`. The first
//! two are off by at most `6 u A (X + A)`. If the sign of `d·a` is uncertain, the heights at
//! both roots differ by less than (3), so the line does not pass through a disk.
//!
//! # Near the axis, in lanes
//!
//! Lanes have no exact products. A line at a sine below 1/4 is either a certain miss by (1) of
//! `lanes.rs`, or left open. The 32 u of `|x| |a| |d|` there also cover the 3 u that the
//! roundings of `a` and `x` add to 12 u.
//!
//! # Lines along the axis
//!
//! A line that counts as parallel to the axis is at an angle below 2^-100 to it. It enters the
//! solid if its origin is within the wall. The comparison of `|m|²` with `r² A²` is certain if
//! they differ by more than η and `ρ A² X²`, which covers the line's sideways movement and `m`,
//! off by `6 u A X`.

use std::cell::Cell;

use glam::DVec3;

use super::lanes::{self, CylinderLanes, LaneCaps, RayLanes};
use super::linear::sum_of_sizes;
use super::offset::Offset;
use super::quick::QuickLanes;
use super::slab::Slab;
use super::triple_product::{self, Axis, Line, Root, Roots, StatedAxis};
use super::{Chord, Cylinder, Intersection, RayOrigin, exact};
use crate::math::{LANES, LaneMask, Lanes, power_of_two};

/// `1 + η`. It trades long numbers for lines that graze the wall, 1 in 2^18, for the constant
/// of (3).
const WIDER: f64 = 1.0 + power_of_two(-18);

/// `ρ`. It trades long numbers for lines from afar, `2^-54 (X/r)²` of them, for (2).
const ROUNDINGS: f64 = power_of_two(-54);

/// The factor of (3). It trades long numbers for lines that come within 2^-34 of the size of a
/// rim for room in the bound: less than half of it is used.
const HEIGHT: f64 = power_of_two(-36);

/// The greatest `k` of lines whose `n` has rounded products; see `triple_product`.
const GREATEST_ROUNDED: f64 = 4.0;

/// The error bound of `C` from exact products, relative to `A² r (X + r)`, and of heights at
/// `t = 0`, relative to `A (X + A)`: 8 u. Spawned rays start at least four times as far from
/// the surface that they leave.
const AT_ORIGIN: f64 = power_of_two(-50);

/// The interval in which the line `origin + t direction` is inside the closed cylinder, decided
/// as by exact arithmetic on the stated numbers.
pub(super) fn chord(cylinder: &Cylinder, origin: &RayOrigin, direction: DVec3) -> Option<Chord> {
    let solve = |x| triple_product::chord(cylinder, x, direction);
    decide(cylinder, origin, direction, solve, Some)
}

/// The first intersection of that line with the surface in a range, as
/// [`triple_product::first`].
pub(super) fn first(
    cylinder: &Cylinder,
    origin: &RayOrigin,
    direction: DVec3,
    shift: f64,
    [t_min, t_max]: [f64; 2],
) -> Option<Intersection> {
    let solve = |x| triple_product::first(cylinder, x, direction, shift, t_min, t_max);
    let of_chord = |chord: Chord| chord.first(cylinder.caps(), shift, t_min, t_max);
    decide(cylinder, origin, direction, solve, of_chord)
}

/// The result of the solver, for the rounded offset of the origin, if its decisions are
/// certain, and otherwise that of the exact chord.
#[inline(always)]
fn decide<T>(
    cylinder: &Cylinder,
    origin: &RayOrigin,
    direction: DVec3,
    solve: impl FnOnce(DVec3) -> Option<T>,
    of_chord: impl FnOnce(Chord) -> Option<T>,
) -> Option<T> {
    let offset = origin.offset_from(cylinder.p0());
    let settled = Settled::of_ray(cylinder, offset.rounded(), direction);
    if settled.is_miss {
        None
    } else if settled.is_certain {
        solve(offset.rounded())
    } else {
        of_chord(exact::chord(cylinder, &offset, direction)?)
    }
}

/// [`lanes::first`] with exact decisions, for rays whose origins are f64 points. Rays that need
/// exact products or exact numbers are left open.
#[inline(always)]
#[must_use]
pub fn first_in_lanes<C: LaneCaps>(
    cylinders: &CylinderLanes<C>,
    rays: &RayLanes,
    active: &LaneMask,
) -> QuickLanes {
    let [mut settled, mut open] = [LaneMask::splat(false); 2];
    for lane in 0..LANES {
        // A number that needs exact products is NaN here, so nothing about it is certain.
        let is_unsettled = Cell::new(false);
        let axis = cylinders.rounded_axis(lane, &is_unsettled);
        let (x, d) = (rays.from_p0.lane(lane), rays.direction.lane(lane));
        let line = Line::rounded(&axis, x, d);
        let is_near_axis = line.is_near_axis(&axis, d);
        let Settled {
            is_miss,
            is_certain,
        } = Settled::of(&axis, x, d, &line, GREATEST_ROUNDED);
        let misses_near_axis = lanes::certainly_misses(&axis, x, d, &line);
        let is_miss = if is_near_axis {
            misses_near_axis
        } else {
            is_miss
        };
        let is_settled = is_certain & !is_near_axis;
        settled.0[lane] = active.0[lane] & !is_miss & is_settled;
        open.0[lane] = active.0[lane] & !is_miss & !is_settled;
    }
    let (hit, t) = if settled.any() {
        lanes::first(cylinders, rays, &settled)
    } else {
        (LaneMask::splat(false), Lanes::splat(0.0))
    };
    QuickLanes { open, hit, t }
}

/// What is certain of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Settled {
    /// It misses the infinite wall. NaN counts as a miss.
    is_miss: bool,
    /// The signs of all its numbers are exact.
    is_certain: bool,
}

impl Settled {
    #[inline(always)]
    fn of_ray(cylinder: &Cylinder, x: DVec3, d: DVec3) -> Self {
        let axis = StatedAxis::of(cylinder);
        let line = Line::new(&axis, x, d);
        if line.is_parallel() {
            return settled_along(&axis, x, d);
        }
        Self::of(&axis, x, d, &line, steepness(&axis, d, &line))
    }

    /// For a line that does not count as parallel to the axis. There is no branch in it, so
    /// that a row of lanes is computed at once.
    #[inline(always)]
    fn of(axis: &impl Axis<f64>, x: DVec3, d: DVec3, line: &Line<f64>, k: f64) -> Self {
        let (aa, radius) = (axis.aa(), axis.radius());
        let rr = radius * radius;
        let roundings = ROUNDINGS * ((x.dot(x) + rr) * (aa * d.dot(d)));
        let (reach, ww) = (rr * line.nn, line.w * line.w);
        let heights = Heights::new(axis, x, d);
        let at_root =
            HEIGHT * k * (heights.at_origin + axis.length() * (axis.length() + k * radius));
        let least_term = AT_ORIGIN * (aa * (radius * (sum_of_sizes(x) + radius)));
        let roots = Roots::new(axis, x, d, line);
        let is_certain = |root| {
            let quotient = roots.quotient(root);
            let t = quotient.numerator / quotient.denominator;
            let has_sign = !quotient.is_indirect | (quotient.numerator.abs() > least_term);
            has_sign & heights.are_off_planes(t, at_root)
        };
        Self {
            is_miss: !(ww <= WIDER * reach + roundings),
            is_certain: (reach > WIDER * ww + roundings)
                & heights.are_off_planes_at_origin()
                & is_certain(Root::First)
                & is_certain(Root::Second),
        }
    }
}

/// For a line that counts as parallel to the axis.
#[cold]
fn settled_along(axis: &StatedAxis<f64>, x: DVec3, d: DVec3) -> Settled {
    let m = axis.a.cross(x);
    let (mm, wall) = (m.dot(m), axis.rr_aa());
    let roundings = ROUNDINGS * (axis.aa() * x.dot(x));
    let is_apart = (mm > WIDER * wall + roundings) | (wall > WIDER * mm + roundings);
    Settled {
        is_miss: false,
        is_certain: is_apart & Heights::new(axis, x, d).are_off_planes_at_origin(),
    }
}

/// A bound of `k`.
#[inline(always)]
fn steepness(axis: &StatedAxis<f64>, d: DVec3, line: &Line<f64>) -> f64 {
    if line.is_near_axis(axis, d) {
        (axis.aa() * d.dot(d) / line.nn).sqrt()
    } else {
        GREATEST_ROUNDED
    }
}

/// The heights of a line's points over the disk at `p0`.
struct Heights {
    slab: Slab<f64>,
    /// `A X`, or up to √3 times as much.
    at_origin: f64,
}

impl Heights {
    #[inline(always)]
    fn new(axis: &impl Axis<f64>, x: DVec3, d: DVec3) -> Self {
        Self {
            slab: triple_product::slab(axis, x, d),
            at_origin: axis.length() * sum_of_sizes(x),
        }
    }

    /// Whether the height at `t` is certainly on the computed side of both disks' planes.
    #[inline(always)]
    fn are_off_planes(&self, t: f64, slack: f64) -> bool {
        let height = self.slab.position + t * self.slab.slope;
        (height.abs() > slack) & ((height - self.slab.height).abs() > slack)
    }

    #[inline(always)]
    fn are_off_planes_at_origin(&self) -> bool {
        self.are_off_planes(0.0, AT_ORIGIN * (self.at_origin + self.slab.height))
    }
}
