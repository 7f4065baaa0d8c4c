//! Numbers of any length: sums, differences and products are exact.

use std::cmp::Ordering;

use dashu_base::Sign;
use dashu_float::{FBig, round::mode::HalfEven};

use super::Number;

/// A binary float without a limit on its length.
#[derive(Clone, Debug)]
pub(super) struct Big(pub FBig<HalfEven, 2>);

impl Big {
    /// The quotient, rounded to f64.
    pub fn over(&self, divisor: f64) -> f64 {
        let long = |x: &FBig<HalfEven, 2>| x.clone().with_precision(128).value();
        (long(&self.0) / long(&Self::of(divisor).0))
            .to_f64()
            .value()
    }
}

impl Number for Big {
    fn of(x: f64) -> Self {
        let x = FBig::try_from(x).expect("the inputs are finite");
        Self(x.with_precision(0).value())
    }

    fn difference(a: f64, b: f64) -> Self {
        Self::of(a).minus(&Self::of(b))
    }

    fn plus(&self, other: &Self) -> Self {
        Self(&self.0 + &other.0)
    }

    fn minus(&self, other: &Self) -> Self {
        Self(&self.0 - &other.0)
    }

    fn times(&self, other: &Self) -> Self {
        Self(&self.0 * &other.0)
    }

    fn sign(&self) -> Option<Ordering> {
        Some(if self.0.repr().significand().is_zero() {
            Ordering::Equal
        } else if self.0.sign() == Sign::Negative {
            Ordering::Less
        } else {
            Ordering::Greater
        })
    }
}
