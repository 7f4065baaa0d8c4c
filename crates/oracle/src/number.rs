//! Exact numbers: binary floats without a limit on their length, and numbers
//! of the form `(p + q √s) / r` over them.

use std::cmp::Ordering;
use std::ops::{Add, Sub};

use dashu_base::Sign;
use dashu_float::{FBig, round::mode::HalfEven};

/// A binary float whose sums, differences and products are exact.
pub type Exact = FBig<HalfEven, 2>;

/// Bits of a number that had to be rounded (a root or a quotient).
const LONG: usize = 700;

/// The exact value of a finite f64.
///
/// # Panics
/// When `x` is not finite.
#[must_use]
pub fn exact(x: f64) -> Exact {
    let x = Exact::try_from(x).expect("only finite numbers have an exact value");
    x.with_precision(0).value()
}

/// The f64 nearest to a number.
#[must_use]
pub fn to_f64(x: &Exact) -> f64 {
    x.to_f64().value()
}

/// A number as long as [`LONG`] allows.
pub(super) fn long(x: &Exact) -> Exact {
    x.clone().with_precision(LONG).value()
}

pub(super) fn zero() -> Exact {
    exact(0.0)
}

/// The sign as a comparison with zero.
pub(super) fn sign(x: &Exact) -> Ordering {
    if *x == zero() {
        Ordering::Equal
    } else if x.sign() == Sign::Negative {
        Ordering::Less
    } else {
        Ordering::Greater
    }
}

/// Compares `p + q √s` with zero, for `s >= 0`, without rounding.
pub(super) fn sign_with_root(p: &Exact, q: &Exact, s: &Exact) -> Ordering {
    let root_sign = if sign(s) == Ordering::Equal {
        Ordering::Equal
    } else {
        sign(q)
    };
    match (sign(p), root_sign) {
        (Ordering::Equal, other) | (other, Ordering::Equal) => other,
        (p_sign, q_sign) if p_sign == q_sign => p_sign,
        // Of opposite signs: the greater square wins.
        (p_sign, q_sign) => match (p * p).cmp(&(q * q * s)) {
            Ordering::Greater => p_sign,
            Ordering::Less => q_sign,
            Ordering::Equal => Ordering::Equal,
        },
    }
}

/// The number `(p + q √s) / r` with `r > 0` and `s >= 0`.
#[derive(Clone, Debug)]
pub(super) struct Surd {
    pub p: Exact,
    pub q: Exact,
    pub s: Exact,
    pub r: Exact,
}

impl Surd {
    /// The quotient `p / r`, for `r` not zero.
    pub fn quotient(p: Exact, r: Exact) -> Self {
        let (p, r) = if sign(&r) == Ordering::Less {
            (-p, -r)
        } else {
            (p, r)
        };
        Self {
            p,
            q: zero(),
            s: zero(),
            r,
        }
    }

    /// The number `x`.
    pub fn whole(x: Exact) -> Self {
        Self::quotient(x, exact(1.0))
    }

    /// `constant + factor * self`, compared with zero.
    pub fn sign_of_line(&self, constant: &Exact, factor: &Exact) -> Ordering {
        sign_with_root(
            &(constant * &self.r + factor * &self.p),
            &(factor * &self.q),
            &self.s,
        )
    }

    /// Compares with an f64, which may be infinite.
    pub fn cmp_f64(&self, x: f64) -> Ordering {
        if x.is_infinite() {
            return if x > 0.0 {
                Ordering::Less
            } else {
                Ordering::Greater
            };
        }
        self.sign_of_line(&-exact(x), &exact(1.0))
    }

    /// Compares with another number: the sign of `p + q √s - q' √s'`, where the
    /// greater square wins if there are two roots.
    pub fn cmp_exact(&self, other: &Self) -> Ordering {
        let p = &self.p * &other.r - &other.p * &self.r;
        let (q, taken) = (&self.q * &other.r, &other.q * &self.r);
        if sign(&taken) == Ordering::Equal {
            return sign_with_root(&p, &q, &self.s);
        }
        if sign(&q) == Ordering::Equal {
            return sign_with_root(&p, &-taken, &other.s);
        }
        if self.s == other.s {
            return sign_with_root(&p, &(q - taken), &self.s);
        }
        let root_sign = |q: &Exact, s: &Exact| sign_with_root(&zero(), q, s);
        let left = sign_with_root(&p, &q, &self.s);
        let right = root_sign(&taken, &other.s);
        if left != right {
            return left.cmp(&right);
        }
        let squares = &p * &p + &q * &q * &self.s - &taken * &taken * &other.s;
        let by_square = sign_with_root(&squares, &(exact(2.0) * &p * &q), &self.s);
        match left {
            Ordering::Less => by_square.reverse(),
            _ => by_square,
        }
    }

    /// The number to [`LONG`] bits less what cancels.
    pub fn value(&self) -> Exact {
        let numerator = if sign(&self.q) == Ordering::Equal {
            long(&self.p)
        } else {
            long(&self.p) + long(&self.q) * long(&self.s).sqrt()
        };
        numerator / long(&self.r)
    }
}

/// A vector of exact numbers.
#[derive(Clone, Debug)]
pub struct ExactVector(pub [Exact; 3]);

impl ExactVector {
    /// The exact value of a finite vector.
    ///
    /// # Panics
    /// When a component is not finite.
    #[must_use]
    pub fn new(vector: glam::DVec3) -> Self {
        Self(vector.to_array().map(exact))
    }

    /// The vector with every component rounded to the nearest f64.
    #[must_use]
    pub fn rounded(&self) -> glam::DVec3 {
        glam::DVec3::from_array(self.0.each_ref().map(to_f64))
    }

    /// The scalar product.
    #[must_use]
    pub fn dot(&self, other: &Self) -> Exact {
        let [a, b] = [&self.0, &other.0];
        &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
    }

    /// The vector times a number.
    #[must_use]
    pub fn times(&self, factor: &Exact) -> Self {
        Self(self.0.clone().map(|x| x * factor))
    }
}

/// The vector of the first three numbers.
pub(super) fn vector_of(numbers: &[Exact]) -> ExactVector {
    ExactVector(std::array::from_fn(|i| numbers[i].clone()))
}

impl ExactVector {
    /// The vector product.
    #[must_use]
    pub fn cross(&self, other: &Self) -> Self {
        let [a, b] = [&self.0, &other.0];
        Self([
            &a[1] * &b[2] - &a[2] * &b[1],
            &a[2] * &b[0] - &a[0] * &b[2],
            &a[0] * &b[1] - &a[1] * &b[0],
        ])
    }

    /// The length, rounded to f64 in the last step only.
    #[must_use]
    pub fn length(&self) -> f64 {
        to_f64(&long(&self.dot(self)).sqrt())
    }
}

impl Add for &ExactVector {
    type Output = ExactVector;

    fn add(self, other: Self) -> ExactVector {
        ExactVector(std::array::from_fn(|i| &self.0[i] + &other.0[i]))
    }
}

impl Sub for &ExactVector {
    type Output = ExactVector;

    fn sub(self, other: Self) -> ExactVector {
        ExactVector(std::array::from_fn(|i| &self.0[i] - &other.0[i]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_very_different_sizes_stay_exact() {
        let sum = exact(1e300) + exact(1e-300) - exact(1e300);
        assert_eq!(sum, exact(1e-300));
        let product = exact(1.0 + f64::EPSILON) * exact(1.0 - f64::EPSILON);
        assert_eq!(exact(1.0) - product, exact(f64::EPSILON * f64::EPSILON));
    }

    #[test]
    fn signs_with_roots_are_decided_without_rounding() {
        let tiny = exact(f64::MIN_POSITIVE);
        let (one, two) = (exact(1.0), exact(2.0));
        assert_eq!(sign_with_root(&-&two, &one, &exact(4.0)), Ordering::Equal);
        assert_eq!(
            sign_with_root(&-&two, &one, &(exact(4.0) + &tiny)),
            Ordering::Greater
        );
        assert_eq!(
            sign_with_root(&two, &-&one, &(exact(4.0) + &tiny)),
            Ordering::Less
        );
        assert_eq!(sign_with_root(&two, &-&one, &zero()), Ordering::Greater);
        assert_eq!(sign_with_root(&zero(), &-&one, &zero()), Ordering::Equal);
    }

    #[test]
    fn surds_compare_with_floats_and_each_other() {
        let root_two = Surd {
            p: zero(),
            q: exact(1.0),
            s: exact(2.0),
            r: exact(1.0),
        };
        assert_eq!(root_two.cmp_f64(std::f64::consts::SQRT_2), Ordering::Less);
        assert_eq!(
            root_two.cmp_f64(std::f64::consts::SQRT_2.next_down()),
            Ordering::Greater
        );
        assert_eq!(root_two.cmp_f64(f64::NEG_INFINITY), Ordering::Greater);
        assert_eq!(
            root_two.cmp_exact(&Surd::quotient(exact(-3.0), exact(-2.0))),
            Ordering::Less
        );
        assert_eq!(to_f64(&root_two.value()), std::f64::consts::SQRT_2);
    }

    /// `1 + √2 < √6`, and `1 + √2 = √(3 + √8)` where that is stated with whole numbers:
    /// `√18 - √8 = √2`.
    #[test]
    fn surds_of_different_roots_compare() {
        let surd = |p: f64, q: f64, s: f64| Surd {
            p: exact(p),
            q: exact(q),
            s: exact(s),
            r: exact(1.0),
        };
        let cases = [
            (surd(1.0, 1.0, 2.0), surd(0.0, 1.0, 6.0), Ordering::Less),
            (surd(1.0, 1.0, 2.0), surd(0.0, 1.0, 5.0), Ordering::Greater),
            (surd(0.0, 2.0, 2.0), surd(0.0, 1.0, 8.0), Ordering::Equal),
            (surd(3.0, -2.0, 2.0), surd(3.0, -1.0, 8.0), Ordering::Equal),
            (
                surd(0.0, -1.0, 3.0),
                surd(1.0, -2.0, 2.0),
                Ordering::Greater,
            ),
            (surd(0.0, -1.0, 3.0), surd(1.0, 2.0, 2.0), Ordering::Less),
        ];
        for (one, other, order) in cases {
            assert_eq!(one.cmp_exact(&other), order, "{one:?} {other:?}");
            assert_eq!(other.cmp_exact(&one), order.reverse());
        }
    }
}
