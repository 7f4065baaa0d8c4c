//! The infinite wall of a cone, and the interval of a line inside it.
//!
//! With the axis `a = p1 - p0`, the radii `r0` and `r1`, `Δ = r1 - r0`, the ray
//! `o + t d` and `x = o - p0`, let `n = a × d`, `m = a × x`, and count heights as
//! `y = x·a + t s` with `s = d·a`. For a `β > 0`, a cone is where
//!
//! ```text
//! β |m + t n|² <= (g + t h)²,   g = r0 |a|² + Δ (x·a),   h = Δ s           (1)
//! ```
//!
//! and `g + t h >= 0`, which selects the nappe. `β = |a|²` is the cone through the rims of the
//! disks of radius `r0` and `r1` (its radius at height `y` is `r0 + Δ y / |a|²`);
//! `β = |a|² - Δ²` is the cone that touches the balls of these radii. Divided by `β`, (1) is
//! `A t² + 2 B t + C <= 0` with
//!
//! ```text
//! A = |n|² - h²/β,   B = m·n - g h/β,   C = |m|² - g²/β                    (2)
//! ```
//!
//! Since `m × n = a w` with `w = x·n`, Lagrange's identity makes the quarter
//! discriminant `B² - A C = (|g n - h m|² - β |a|² w²) / β`. Further `g n - h m =
//! r0 |a|² n + Δ a × (a × (d × x))`, which is `|a|²` times the part of
//!
//! ```text
//! k = r0 n + Δ (x × d)                                                     (3)
//! ```
//!
//! that is perpendicular to `a`, and `k·a = -Δ w`. So `B² - A C = |a|⁴ E / β` with
//!
//! ```text
//! E = |k|² - w² (β + Δ²) / |a|²,   t = (-B ∓ |a|² √(E/β)) / A              (4)
//! ```
//!
//! Why this form: `n`, `w` and `k` (the moment of the line about the apex, times `Δ`) do not
//! change when the origin slides along the ray, so no square of the distance enters `E` and
//! cancels later. For `Δ = 0`, `E` is the triple product's `r0² |n|² - w²`.
//!
//! `A` is positive for a line that is steeper to the axis than the wall: it is inside of one
//! nappe between the roots. `A` is negative for a less steep line, which is inside of each
//! nappe from a root on, and zero for a line parallel to a ruling of the wall. `h` decides
//! which of the half-lines is on the solid's nappe.
//!
//! Each of `A`, `B`, `C` and `E` is a difference. `rounded.rs` decides whether rounded products
//! are accurate enough for it. If they are not, it is computed from exact numbers: then its
//! sign is exact, and its relative error at most some ten u, u = 2^-53. One of the two roots
//! has no cancellation in its sum `q`; if the terms of the other cancel, that root is `C / q`.

use glam::DVec3;

use super::roots::{Inside, Roots};
use super::rounded::{Bounds, Rounded};
use super::taper::{Exactly, Taper, Term};
use crate::solid::exact::quotient;
use crate::solid::offset::Offset;

/// The intersection of a line with the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::solid) enum WallIntersection {
    /// The line is inside over an interval.
    Inside(Inside),
    /// The line is a ruling of the wall.
    Along,
}

impl<A: Offset> Taper<A> {
    /// The intersection of the line `x + t d` with the wall, on the solid's nappe if the line
    /// is less steep than the wall. `None` if it misses, and for NaN.
    pub fn intersect(&self, x: impl Offset, d: DVec3) -> Option<WallIntersection> {
        if !(x.rounded().is_finite() && d.is_finite()) {
            return None;
        }
        let rounded = Rounded::new(self, x.rounded(), d, self.beta());
        let (roots, h) = if rounded.is_plain() {
            (rounded.roots, rounded.h)
        } else {
            self.roots_of_hard_line(&rounded, x, d)?
        };
        let rises = h > 0.0;
        if roots.a == 0.0 {
            if roots.noncancelling() == 0.0 {
                // In a plane that touches the wall: along a ruling, or beside it.
                let is_along = self.constant_term(&rounded, x, d) == 0.0;
                return is_along.then_some(WallIntersection::Along);
            }
            if (roots.b < 0.0) != rises {
                // Parallel to the wall, the line is inside of one nappe only: the other one.
                return None;
            }
        }
        Some(WallIntersection::Inside(
            roots.inside(rises, || self.constant_term(&rounded, x, d)),
        ))
    }

    /// The roots and `h` of a line that is not plain; `None` if it misses the wall.
    #[inline(never)]
    fn roots_of_hard_line<X: Offset>(
        &self,
        rounded: &Rounded,
        x: X,
        d: DVec3,
    ) -> Option<(Roots, f64)> {
        let bounds = Bounds::new(rounded);
        if bounds.rejects() {
            return None;
        }
        if bounds.is_good() {
            return (rounded.e >= 0.0).then_some((rounded.roots, rounded.h));
        }
        let exactly = |term| self.exactly(term, x, d, rounded.beta);
        let [a, b, e, h] = [Term::A, Term::B, Term::E, Term::H].map(exactly);
        (e >= 0.0).then(|| (Roots::new([a, b, e], rounded.aa, rounded.beta), h))
    }

    /// `C` of (2).
    fn constant_term(&self, rounded: &Rounded, x: impl Offset, d: DVec3) -> f64 {
        let c = rounded.good_constant_term();
        c.unwrap_or_else(|| self.exactly(Term::C, x, d, rounded.beta))
    }

    fn exactly(&self, term: Term, x: impl Offset, d: DVec3, beta: f64) -> f64 {
        let divisor = match term {
            Term::E => self.axis().length_squared(),
            Term::H => 1.0,
            Term::A | Term::B | Term::C => beta,
        };
        let taper = self;
        quotient(&Exactly { taper, x, d, term }, divisor)
    }
}
