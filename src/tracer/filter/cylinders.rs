//! The filter of cylinders, and of solids with a tight bounding cylinder: the [`Sheath`] of
//! each.
//!
//! The copy of a cylinder has the ends `c ± b` and the radius `r`, in units of the cell. `c`
//! and `b` have components of eight bits, and `r` is a multiple of a power of two.
//!
//! # Margins
//!
//! Let the cylinder, in units, have the ends `p0`, `p1` and the radius ρ, let `s` be the slack
//! and σ the sine of the angle between its axis and `b`. A point within `s` of it is a point
//! `a` of the axis, plus at most ρ across the axis and `s` from there. So it is within
//!
//! ```text
//! r0 = off + ρ + s,        off = max over the ends of |(p - c) × b| / |b|            (1)
//! h0 = max over the ends of |(p - c)·b| / |b| + ρ σ + s                             (2)
//! ```
//!
//! of the line `c + y b`, and of the plane through `c` across it: both distances are greatest
//! at an end. Anything in the cylinder is within the same bounds. `b` is made long enough that
//! `|b| >= h0`. It may be longer than the cylinder: a short thick one gets a longer `b`, whose
//! direction is more exact, so that ρ σ is less.
//!
//! # The test
//!
//! For the line `x + T d` relative to `c`, with `n = b × d`, `w = x·n`, `B = |b|`, the roots of
//! the distance from the axis, and the position along the axis, are
//!
//! ```text
//! T |n|² = t ± B √D,   D = r² |n|² - w²,   t = (x·b)(d·b) - (x·d) B²               (3)
//! y B = x·b + T d·b                                                                 (4)
//! ```
//!
//! The part of the line inside the wall, the part between the ends and the ray are intervals.
//! Three intervals of a line have a common point if every two have (Helly), so the test is
//!
//! ```text
//! D >= 0
//! t + B √D >= start |n|²,   t - B √D <= end |n|²                     wall and ray   (5)
//! |(x·b) |n|² + t (d·b)| <= B² |n|² + |d·b| B √D                     wall and ends  (6)
//! the range of y B from start to end intersects [-B², B²]             ray and ends  (7)
//! ```
//!
//! without a division. A lane whose `b` is zero passes.
//!
//! # Roundings
//!
//! Products and sums of f32 have a relative error of v = 2^-24. Every length is below `Y` =
//! 512, and so are `start` and `end`; `b` and `B²` are exact, `|d|` is 1. For terms with
//! several roundings the bounds are added:
//!
//! ```text
//! x: v Y    n: 3 v B    w: 7 v Y B    |n|²: 9 v B²    x·b, (x·d) B: 4 v Y B    d·b: 3 v B
//! t: 15 v Y B²    T |n|²: 10 v Y B²    √D B, given D: 3 v Y B²    left of (6): 35 v Y B³
//! right of (6): 15 v Y B³    (4): 8 v Y B
//! ```
//!
//! `|w| <= r0 |n|` implies `|w| <= r0 |n| + 10 v Y B` for the computed `w` and `n`, and
//! squared, as `(p + q)² <= (1 + ε) p² + (1 + 1/ε) q²` with ε = 2^-7 and 2 (10 v Y B)² more for
//! `D`:
//!
//! ```text
//! D <= (1 + 2^-7) r0² |n|² - w² + 131 (10 v Y)² B²,   131 (10 v Y)² = 2^-16.3       (8)
//! ```
//!
//! So the stored `r` is at least `r0 (1 + 2^-7)`, whose square has 2^-7 to spare for the
//! roundings of (8) itself, and `D` gets [`MARGIN`]² B² with a margin of 2^-7: twice the root
//! of 2^-16.3. The computed `D` is then not below that of a cylinder of radius r0. The sides of
//! (5) are off by up to (15 + 10 + 3 + 2) v Y B² = 2^-10 B², and (5) gets `MARGIN` B². Those of
//! (6) are off by up to 50 v Y B³ = 2^-9.3 B³, and (6) gets 2^-10 (B² + 1) B², which is at
//! least 2^-9 B³. Those of (7) are off by up to 2^-12 B, and (7) gets `MARGIN` B². These
//! margins move a surface by less than a unit.
//!
//! A ray that represents others up to 256 away passes the axis within r0 plus their distance.
//! `Y` is 768 for it: 131 (10 v Y)² = 2^-15.1 is still below the square of the margin.

use glam::DVec3;

use super::cell::{dot, greater, less};
use super::{Cell, Filter, Filtered, NearRay, Sheath, Sheathed};
use crate::math::LANES;
use crate::tracer::frame::Frame;

/// The margin of the tests for their roundings, as derived at the head of this file: it makes a
/// wall thicker by less than 1 % of its radius or of a unit.
const MARGIN: f32 = 1.0 / (1 << 7) as f32;

/// The margin of (6): it makes a cylinder longer by 1/1024.
const END_MARGIN: f32 = 1.0 / (1 << 10) as f32;

/// The stored radius over r0 of (1).
const THICKER: f64 = 1.0 + 1.0 / (1 << 7) as f64;

/// A factor that covers the f64 roundings of the stored numbers.
const OUTWARD: f64 = 1.0 + 1.0 / (1_u64 << 40) as f64;

/// A block's cylinders, or the sheaths of its solids.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub(crate) struct CylinderFilter {
    cell: Cell,
    /// Middles.
    c: [[u8; LANES]; 3],
    /// Half axes.
    b: [[i8; LANES]; 3],
    /// Radii, `2^exponent` to a unit; 0 for an empty lane.
    r: [u8; LANES],
}

const _: () = assert!(size_of::<CylinderFilter>() == 64);

impl<S: Sheathed> Filtered for S {
    type Filter = CylinderFilter;

    fn filter(solids: &[S], frame: &Frame, share: f64) -> CylinderFilter {
        let cell = Cell::around(solids.iter().map(S::bounds), frame);
        let mut filter = CylinderFilter {
            cell,
            c: [[0; LANES]; 3],
            b: [[0; LANES]; 3],
            r: [0; LANES],
        };
        let mut radii = [0.0; LANES];
        for (lane, solid) in solids.iter().enumerate() {
            let one = InCell::new(&solid.sheath(), &cell, frame, share);
            let (c, b, radius) = one.copy();
            for axis in 0..3 {
                filter.c[axis][lane] = c[axis] as u8;
                filter.b[axis][lane] = b[axis] as i8;
            }
            radii[lane] = radius;
        }
        filter.r = filter.cell.keep_radii(radii, share);
        filter
    }
}

impl CylinderFilter {
    #[inline(always)]
    fn lane(&self, lane: usize, ray: &NearRay, apart: f32) -> Lane {
        let b = [
            f32::from(self.b[0][lane]),
            f32::from(self.b[1][lane]),
            f32::from(self.b[2][lane]),
        ];
        let (o, d) = (ray.origin, ray.direction);
        let x = [
            o[0] - f32::from(self.c[0][lane]),
            o[1] - f32::from(self.c[1][lane]),
            o[2] - f32::from(self.c[2][lane]),
        ];
        let n = [
            b[1] * d[2] - b[2] * d[1],
            b[2] * d[0] - b[0] * d[2],
            b[0] * d[1] - b[1] * d[0],
        ];
        let (nn, w, bb) = (dot(n, n), dot(x, n), dot(b, b));
        let r = self.cell.radius(self.r[lane]) + apart;
        Lane {
            x,
            b,
            nn,
            bb,
            discriminant: r * r * nn + MARGIN * MARGIN * bb - w * w,
            is_there: self.r[lane] > 0,
        }
    }
}

/// The terms of a line and a lane; see the head of this file.
struct Lane {
    x: [f32; 3],
    b: [f32; 3],
    nn: f32,
    bb: f32,
    discriminant: f32,
    is_there: bool,
}

impl Filter for CylinderFilter {
    #[inline(always)]
    fn cell(&self) -> &Cell {
        &self.cell
    }

    #[inline(always)]
    fn may_hit_near(&self, lane: usize, ray: &NearRay, apart: f32) -> bool {
        let Lane {
            discriminant,
            is_there,
            ..
        } = self.lane(lane, ray, apart);
        (discriminant >= 0.0) & is_there
    }

    #[inline(always)]
    fn may_hit(&self, lane: usize, ray: &NearRay) -> bool {
        let Lane {
            x,
            b,
            nn,
            bb,
            discriminant,
            is_there,
        } = self.lane(lane, ray, 0.0);
        let d = ray.direction;
        let (db, xb, xd) = (dot(d, b), dot(x, b), dot(x, d));
        let root = (greater(discriminant, 0.0) * bb).sqrt();
        let t = xb * db - xd * bb;
        let wall = root + MARGIN * bb;
        let (at_start, at_end) = (xb + ray.start * db, xb + ray.end * db);
        let ends = bb + MARGIN * bb;
        let middle = (xb * nn + t * db).abs();
        let reach = bb * (nn + END_MARGIN * (bb + 1.0)) + db.abs() * root;
        (discriminant >= 0.0)
            & is_there
            & (t + wall >= ray.start * nn)
            & (t - wall <= ray.end * nn)
            & (middle <= reach)
            & (less(at_start, at_end) <= ends)
            & (greater(at_start, at_end) >= -ends)
    }
}

/// A cylinder in units of its cell.
struct InCell {
    ends: [DVec3; 2],
    /// The direction of its axis, of length 1.
    axis: DVec3,
    radius: f64,
    slack: f64,
    /// The share of the margins (1) and (2) that is added; 1 except in tests.
    share: f64,
}

impl InCell {
    fn new(sheath: &Sheath, cell: &Cell, frame: &Frame, share: f64) -> Self {
        let units = f64::from(cell.units());
        let scale = frame.scale() * units;
        let anchor = cell.place(sheath.anchor, frame);
        Self {
            ends: sheath.heights.map(|h| anchor + sheath.axis * (h * scale)),
            axis: sheath.axis,
            radius: sheath.radius * scale,
            slack: frame.slack() * units,
            share,
        }
    }

    /// Its `c`, `b` and least `r`.
    fn copy(&self) -> (DVec3, DVec3, f64) {
        let [p0, p1] = self.ends;
        let c = (0.5 * (p0 + p1)).round();
        // Rounding turns `b` by about 0.6 / |b|: the least sum of |b| and ρ times that.
        let mut length = self.half().max((0.6 * self.radius).sqrt()).max(1.0);
        loop {
            let b = (self.axis * length).round();
            if b.abs().max_element() > f64::from(i8::MAX) || !b.is_finite() {
                return (c, DVec3::ZERO, self.thick(0.0));
            }
            let reach = self.reach(c, b);
            if b.length() >= reach {
                return (c, b, self.thick(self.off(c, b)));
            }
            length = reach.max(length + 0.25);
        }
    }

    /// Half of its length.
    fn half(&self) -> f64 {
        let [p0, p1] = self.ends;
        0.5 * (p1 - p0).length()
    }

    /// h0 of (2).
    fn reach(&self, c: DVec3, b: DVec3) -> f64 {
        let [p0, p1] = self.ends;
        let along = |p: DVec3| (p - c).dot(b).abs() / b.length();
        let sine = self.axis.cross(b).length() / b.length();
        let added = along(p0).max(along(p1)) - self.half() + self.radius * sine + self.slack;
        (self.half() + self.share * added) * OUTWARD
    }

    /// `off` of (1).
    fn off(&self, c: DVec3, b: DVec3) -> f64 {
        let across = |p: DVec3| (p - c).cross(b).length() / b.length();
        across(self.ends[0]).max(across(self.ends[1]))
    }

    /// The radius to store: r0 of (1) with its margin for roundings.
    fn thick(&self, off: f64) -> f64 {
        let added = (off + self.radius + self.slack) * THICKER * OUTWARD - self.radius;
        self.radius + self.share * added
    }
}
