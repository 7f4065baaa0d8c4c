//! The wall of a cone, and the terms of its equation as exact numbers.
//!
//! Equation numbers are those of `wall.rs`.

use glam::DVec3;

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
