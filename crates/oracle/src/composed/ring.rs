//! Numbers `p + q √s` of one `s`, and vectors of them.
//!
//! Where a line crosses a quadric, `t = (p + q √s) / r`. Everything about the
//! neighbourhood of that point is a sum of products of such numbers, and these have
//! the same form: `(p + q √s) (p' + q' √s) = p p' + q q' s + (p q' + q p') √s`. The
//! denominator is a factor of the coordinates instead, so that nothing is divided.

use std::cmp::Ordering;
use std::rc::Rc;

use crate::number::{Exact, ExactVector, long, sign, sign_with_root, to_f64, zero};

/// `s` and its root to many bits, for approximations.
#[derive(Debug)]
pub(super) struct Root {
    s: Exact,
    root: Exact,
}

impl Root {
    pub fn of(s: &Exact) -> Rc<Self> {
        Rc::new(Self {
            s: s.clone(),
            root: long(s).sqrt(),
        })
    }
}

/// `p + q √s`, or `p` where there is no root.
#[derive(Clone, Debug)]
pub(super) struct Number {
    p: Exact,
    root: Option<(Exact, Rc<Root>)>,
}

impl Number {
    pub fn rational(p: Exact) -> Self {
        Self { p, root: None }
    }

    pub fn new(p: Exact, q: Exact, root: &Rc<Root>) -> Self {
        let root = (sign(&q) != Ordering::Equal).then(|| (q, Rc::clone(root)));
        Self { p, root }
    }

    /// The number if it has no root.
    pub fn as_rational(&self) -> Option<&Exact> {
        self.root.is_none().then_some(&self.p)
    }

    pub fn sign(&self) -> Ordering {
        match &self.root {
            None => sign(&self.p),
            Some((q, root)) => sign_with_root(&self.p, q, &root.s),
        }
    }

    pub fn is_zero(&self) -> bool {
        self.sign() == Ordering::Equal
    }

    /// The nearest f64, but for what 700 bits leave out.
    pub fn approximation(&self) -> f64 {
        match &self.root {
            None => to_f64(&self.p),
            Some((q, root)) => to_f64(&(long(&self.p) + long(q) * &root.root)),
        }
    }

    pub fn times(&self, factor: &Exact) -> Self {
        let root = self.root.as_ref();
        Self {
            p: &self.p * factor,
            root: root.map(|(q, root)| (q * factor, Rc::clone(root))),
        }
    }

    pub fn plus(&self, other: &Self) -> Self {
        let p = &self.p + &other.p;
        match (&self.root, &other.root) {
            (None, None) => Self::rational(p),
            (Some(some), None) | (None, Some(some)) => Self {
                p,
                root: Some(some.clone()),
            },
            (Some((q, root)), Some((other, _))) => Self::new(p, q + other, root),
        }
    }

    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negated())
    }

    pub fn negated(&self) -> Self {
        let root = self.root.as_ref();
        Self {
            p: -&self.p,
            root: root.map(|(q, root)| (-q, Rc::clone(root))),
        }
    }

    pub fn by(&self, other: &Self) -> Self {
        match (&self.root, &other.root) {
            (_, None) => self.times(&other.p),
            (None, _) => other.times(&self.p),
            (Some((q, root)), Some((r, _))) => {
                let p = &self.p * &other.p + q * r * &root.s;
                Self::new(p, &self.p * r + q * &other.p, root)
            }
        }
    }
}

/// A vector of such numbers.
#[derive(Clone, Debug)]
pub(super) struct Vector(pub [Number; 3]);

impl Vector {
    pub fn rational(vector: &ExactVector) -> Self {
        Self(vector.0.clone().map(Number::rational))
    }

    pub fn dot(&self, other: &Self) -> Number {
        let [x, y, z] = [0, 1, 2].map(|i| self.0[i].by(&other.0[i]));
        x.plus(&y).plus(&z)
    }

    pub fn cross(&self, other: &Self) -> Self {
        Self([(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
            let one = self.0[i].by(&other.0[j]);
            one.minus(&self.0[j].by(&other.0[i]))
        }))
    }

    pub fn plus(&self, other: &Self) -> Self {
        Self([0, 1, 2].map(|i| self.0[i].plus(&other.0[i])))
    }

    pub fn times(&self, factor: &Exact) -> Self {
        Self([0, 1, 2].map(|i| self.0[i].times(factor)))
    }

    pub fn is_zero(&self) -> bool {
        self.0.iter().all(Number::is_zero)
    }

    pub fn approximation(&self) -> glam::DVec3 {
        glam::DVec3::from_array([0, 1, 2].map(|i| self.0[i].approximation()))
    }
}

/// A symmetric matrix of exact numbers, by its rows.
#[derive(Clone, Debug)]
pub(super) struct Form(pub [ExactVector; 3]);

impl Form {
    pub fn zero() -> Self {
        Self([0, 1, 2].map(|_| ExactVector([zero(), zero(), zero()])))
    }

    /// `one · identity + other · a aᵀ`.
    pub fn of_axis(one: &Exact, other: &Exact, a: &ExactVector) -> Self {
        Self([0, 1, 2].map(|i| {
            ExactVector([0, 1, 2].map(|j| {
                let along = other * &a.0[i] * &a.0[j];
                if i == j { along + one } else { along }
            }))
        }))
    }

    pub fn times(&self, factor: &Exact) -> Self {
        Self([0, 1, 2].map(|i| self.0[i].times(factor)))
    }

    pub fn image(&self, vector: &ExactVector) -> ExactVector {
        ExactVector([0, 1, 2].map(|i| self.0[i].dot(vector)))
    }

    pub fn image_of(&self, vector: &Vector) -> Vector {
        Vector([0, 1, 2].map(|i| {
            let row = &self.0[i].0;
            let [x, y, z] = [0, 1, 2].map(|j| vector.0[j].times(&row[j]));
            x.plus(&y).plus(&z)
        }))
    }

    /// `one · M other`.
    pub fn of(&self, one: &Vector, other: &Vector) -> Number {
        one.dot(&self.image_of(other))
    }
}
