//! A line and the infinite wall of a cone, in exact numbers.
//!
//! With `a = p1 - p0`, `x = o - p0`, a point of the line is `q = x + t d`. The
//! square of its distance to the axis times `a·a` is `a·a q·q - (a·q)²`; the radius
//! at its height, times `√β`, is `r0 a·a + (r1 - r0) a·q`, where `β` is `a·a` for a
//! cone through two disks and `a·a - (r1 - r0)²` for one that touches two balls.
//! Expanded in dot products, both sides' squares are polynomials in t:
//!
//! ```text
//! A t² + 2 B t + C = β (a·a q·q - (a·q)²) - (r0 a·a + (r1 - r0) a·q)²
//! ```

use std::cmp::Ordering;

use glam::DVec3;

use super::number::{Exact, ExactVector, Surd, exact, sign, zero};
use super::ray::ExactRay;

/// What a line is examined for.
pub(super) struct Taper {
    pub a: ExactVector,
    pub x: ExactVector,
    pub d: ExactVector,
    pub aa: Exact,
    pub ax: Exact,
    pub ad: Exact,
    pub beta: Exact,
    pub delta: Exact,
    r0: Exact,
}

/// `A t² + 2 B t + C`.
pub(super) struct Quadratic {
    pub a: Exact,
    pub b: Exact,
    pub c: Exact,
}

impl Quadratic {
    /// `B² - A C`.
    pub fn discriminant(&self) -> Exact {
        &self.b * &self.b - &self.a * &self.c
    }

    /// The numbers where it is zero, unless that is everywhere.
    pub fn roots(&self) -> Vec<Surd> {
        let s = self.discriminant();
        if sign(&self.a) == Ordering::Equal {
            if sign(&self.b) == Ordering::Equal {
                return Vec::new();
            }
            return vec![Surd::quotient(-&self.c, exact(2.0) * &self.b)];
        }
        if sign(&s) == Ordering::Less {
            return Vec::new();
        }
        let is_negative = sign(&self.a) == Ordering::Less;
        let (p, r) = if is_negative {
            (self.b.clone(), -&self.a)
        } else {
            (-&self.b, self.a.clone())
        };
        let root = |q: f64| Surd {
            p: p.clone(),
            q: exact(q),
            s: s.clone(),
            r: r.clone(),
        };
        vec![root(-1.0), root(1.0)]
    }
}

impl Taper {
    /// The numbers are `p0`, `p1`, `r0`, `r1`, `o` and `d`, 14 in all.
    pub fn new(numbers: &[Exact], touches_balls: bool) -> Self {
        let vector = |at: usize| ExactVector(std::array::from_fn(|i| numbers[at + i].clone()));
        let (p0, r0) = (vector(0), numbers[6].clone());
        let (a, x, d) = (&vector(3) - &p0, &vector(8) - &p0, vector(11));
        let delta = &numbers[7] - &r0;
        let aa = a.dot(&a);
        let beta = if touches_balls {
            &aa - &delta * &delta
        } else {
            aa.clone()
        };
        Self {
            ax: a.dot(&x),
            ad: a.dot(&d),
            aa,
            beta,
            delta,
            r0,
            a,
            x,
            d,
        }
    }

    /// The radius at `t`, times `√β`, is `g + t h`.
    pub fn radius(&self) -> (Exact, Exact) {
        (
            &self.r0 * &self.aa + &self.delta * &self.ax,
            &self.delta * &self.ad,
        )
    }

    pub fn wall(&self) -> Quadratic {
        let (g, h) = self.radius();
        let squares = |one: &ExactVector, other: &ExactVector, along: Exact| {
            &self.beta * (&self.aa * one.dot(other) - along)
        };
        Quadratic {
            a: squares(&self.d, &self.d, &self.ad * &self.ad) - &h * &h,
            b: squares(&self.x, &self.d, &self.ax * &self.ad) - &g * &h,
            c: squares(&self.x, &self.x, &self.ax * &self.ax) - &g * &g,
        }
    }

    /// The roots of the wall at which the radius is not negative.
    pub fn wall_points(&self) -> Vec<Surd> {
        let (g, h) = self.radius();
        let mut roots = self.wall().roots();
        roots.retain(|t| t.sign_of_line(&g, &h) != Ordering::Less);
        roots
    }

    /// Half the gradient of the wall's polynomial at `p0 + q`: an outward normal on
    /// the wall of the nappe where the radius is positive, zero at the apex.
    pub fn gradient(&self, q: &ExactVector) -> ExactVector {
        let aq = self.a.dot(q);
        let radius = &self.r0 * &self.aa + &self.delta * &aq;
        let across = &q.times(&self.aa) - &self.a.times(&aq);
        &across.times(&self.beta) - &self.a.times(&(radius * &self.delta))
    }

    /// Whether the line is one of those that the wall is made of.
    pub fn is_along(&self) -> bool {
        let Quadratic { a, b, c } = self.wall();
        [a, b, c].iter().all(|one| *one == zero())
    }

    /// The ball around `p0 + share a`.
    pub fn ball(&self, share: f64, radius: &Exact) -> Quadratic {
        let x = &self.x - &self.a.times(&exact(share));
        Quadratic {
            a: self.d.dot(&self.d),
            b: x.dot(&self.d),
            c: x.dot(&x) - radius * radius,
        }
    }

    /// How the wall compares with zero where the line is at the height `y` on the
    /// axis, times `(a·d)²`.
    pub fn wall_at(&self, y: &Exact) -> Exact {
        let (up, ad) = (y - &self.ax, &self.ad);
        let Quadratic { a, b, c } = self.wall();
        a * &up * &up + exact(2.0) * b * &up * ad + c * ad * ad
    }
}

/// The numbers of a case, as [`Taper::new`] takes them.
pub(super) fn numbers_of(ends: [DVec3; 2], radii: [f64; 2], ray: &ExactRay) -> Vec<Exact> {
    let [p0, p1] = ends.map(|end| ray.point(end).0);
    let radii = radii.map(|radius| ray.length(radius));
    [&p0[..], &p1, &radii, &ray.origin.0, &ray.direction.0].concat()
}
