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

use super::rounded::{Bounds, Rounded};
use crate::solid::exact::{Expression, Number, cross, dot, quotient, vector};
use crate::solid::offset::Offset;

/// The cone for two radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::solid) enum Fit {
    /// The cone through the rims of two disks.
    Disks,
    /// The cone that touches two balls, neither of which contains the other.
    Balls,
}

/// The infinite wall, relative to `p0`.
#[derive(Clone, Copy, Debug)]
pub(in crate::solid) struct Taper<A = DVec3> {
    /// The offset from `p0` to `p1`.
    pub a: A,
    pub radius0: f64,
    pub radius1: f64,
    pub fit: Fit,
}

/// The interval of `t` in which a line is inside the wall. Either end may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::solid) struct Inside {
    /// Where the line enters.
    pub enter: f64,
    /// Where the line leaves.
    pub leave: f64,
}

/// The intersection of a line with the wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::solid) enum WallIntersection {
    /// The line is inside over an interval.
    Inside(Inside),
    /// The line is a ruling of the wall.
    Along,
}

/// The terms of the roots of (2).
#[derive(Clone, Copy, Debug)]
pub(super) struct Roots {
    /// `A`.
    pub a: f64,
    /// `B`.
    pub b: f64,
    /// `|a|² √(E/β)`.
    pub s: f64,
}

impl Roots {
    /// From `A`, `B` and `E`, and from `|a|²` and `β`.
    #[inline(always)]
    pub fn new([a, b, e]: [f64; 3], aa: f64, beta: f64) -> Self {
        let s = aa * (e / beta).sqrt();
        Self { a, b, s }
    }

    /// The numerators of (4).
    #[inline(always)]
    pub fn sums(&self) -> [f64; 2] {
        [-self.b - self.s, self.s - self.b]
    }

    /// `q`, the numerator whose terms do not cancel.
    #[inline(always)]
    pub fn noncancelling(&self) -> f64 {
        let [minus, plus] = self.sums();
        if self.b < 0.0 { plus } else { minus }
    }

    /// Whether the terms of a numerator cancel.
    #[inline(always)]
    pub fn cancels(&self, sum: f64) -> bool {
        sum.abs() < 0.5 * self.b.abs()
    }

    /// The interval between the roots, on the solid's nappe. `rises` is whether that nappe
    /// extends in the line's direction, for a line that is less steep than the wall.
    /// `constant_term` is called if terms cancel.
    #[inline(always)]
    pub fn inside(&self, rises: bool, constant_term: impl Fn() -> f64) -> Inside {
        let root = |sum: f64| {
            let (numerator, denominator) = if self.cancels(sum) {
                (constant_term(), self.noncancelling())
            } else {
                (sum, self.a)
            };
            numerator / denominator
        };
        let [minus, plus] = self.sums();
        let is_half = !(self.a > 0.0);
        Inside {
            enter: if is_half & !rises {
                f64::NEG_INFINITY
            } else {
                root(minus)
            },
            leave: if is_half & rises {
                f64::INFINITY
            } else {
                root(plus)
            },
        }
    }
}

impl<A: Offset> Taper<A> {
    /// `a`, rounded.
    #[inline(always)]
    pub fn axis(&self) -> DVec3 {
        self.a.rounded()
    }

    /// `β`.
    pub fn beta(&self) -> f64 {
        let (rounded, is_good) = self.rounded_beta();
        if is_good {
            rounded
        } else {
            quotient(&Beta(self), 1.0)
        }
    }

    /// `β` from rounded products, and whether it equals [`Taper::beta`].
    #[inline(always)]
    pub fn rounded_beta(&self) -> (f64, bool) {
        let (aa, delta) = (self.axis().length_squared(), self.radius1 - self.radius0);
        match self.fit {
            Fit::Disks => (aa, true),
            Fit::Balls => (aa - delta * delta, delta * delta < 0.5 * aa),
        }
    }

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

    /// `|a|²`, `Δ` and `β`.
    pub fn measures<N: Number>(&self, a: &[N; 3]) -> Measures<N> {
        Measures::new(a, self.radius0, self.radius1, self.fit)
    }

    /// A term as numbers `N`.
    pub fn term<N: Number>(&self, x: &[N; 3], d: &[N; 3], term: Term) -> N {
        let a = self.a.exactly::<N>();
        let measures = self.measures(&a);
        let Measures {
            aa, delta, beta, ..
        } = &measures;
        if term == Term::C {
            return measures.outside(&a, x);
        }
        let (n, h) = (cross(&a, d), delta.times(&dot(d, &a)));
        match term {
            Term::H => h,
            Term::A => beta.times(&dot(&n, &n)).minus(&h.times(&h)),
            Term::E => {
                let (l, w) = (cross(x, d), dot(x, &n));
                let k: [N; 3] = std::array::from_fn(|i| {
                    measures.radius0.times(&n[i]).plus(&delta.times(&l[i]))
                });
                let tilt = beta.plus(&delta.times(delta));
                aa.times(&dot(&k, &k)).minus(&w.times(&w).times(&tilt))
            }
            _ => {
                let (m, g) = (cross(&a, x), measures.g(&dot(x, &a)));
                beta.times(&dot(&m, &n)).minus(&g.times(&h))
            }
        }
    }
}

/// `|a|²`, `Δ` and `β` as numbers `N`.
pub(in crate::solid) struct Measures<N> {
    pub aa: N,
    pub delta: N,
    pub beta: N,
    radius0: N,
}

impl<N: Number> Measures<N> {
    pub fn new(a: &[N; 3], radius0: f64, radius1: f64, fit: Fit) -> Self {
        let aa = dot(a, a);
        let delta = N::difference(radius1, radius0);
        let beta = match fit {
            Fit::Disks => aa.clone(),
            Fit::Balls => aa.minus(&delta.times(&delta)),
        };
        Self {
            aa,
            delta,
            beta,
            radius0: N::of(radius0),
        }
    }

    /// `g` of a point at height `y`.
    pub fn g(&self, y: &N) -> N {
        self.radius0.times(&self.aa).plus(&self.delta.times(y))
    }

    /// `β C`, with `m = a × x`: positive outside of both nappes.
    pub fn outside(&self, a: &[N; 3], x: &[N; 3]) -> N {
        let (m, g) = (cross(a, x), self.g(&dot(x, a)));
        self.beta.times(&dot(&m, &m)).minus(&g.times(&g))
    }
}

struct Beta<'a, A>(&'a Taper<A>);

impl<A: Offset> Expression for Beta<'_, A> {
    fn value<N: Number>(&self) -> N {
        self.0.measures(&self.0.a.exactly()).beta
    }
}

/// A term of (2) times `β`, `E` times `|a|²`, or `h`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::solid) enum Term {
    A,
    B,
    C,
    E,
    H,
}

/// A term as an expression.
pub(in crate::solid) struct Exactly<'a, A, X> {
    pub taper: &'a Taper<A>,
    pub x: X,
    pub d: DVec3,
    pub term: Term,
}

impl<A: Offset, X: Offset> Expression for Exactly<'_, A, X> {
    fn value<N: Number>(&self) -> N {
        let x = self.x.exactly::<N>();
        self.taper.term(&x, &vector(self.d), self.term)
    }
}
