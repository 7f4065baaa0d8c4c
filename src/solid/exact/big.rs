//! Numbers of any length, with exact sums, differences and products.

use std::cmp::Ordering;

use dashu_base::Sign;
use dashu_float::{FBig, round::mode::HalfEven};
use glam::DVec3;

use super::Number;

/// A binary float without a limit on its length.
#[derive(Clone, Debug)]
pub(in crate::solid) struct Big(pub(super) FBig<HalfEven, 2>);

impl Big {
    /// The quotient, rounded to f64.
    pub fn over(&self, divisor: f64) -> f64 {
        ratio(self, &Self::of(divisor))
    }
}

/// The quotient of two numbers, within some units of 2^-53 of itself if it does not underflow.
pub(in crate::solid) fn ratio(dividend: &Big, divisor: &Big) -> f64 {
    let long = |x: &Big| x.0.clone().with_precision(128).value();
    (long(dividend) / long(divisor)).to_f64().value()
}

/// The unit vector of a nonzero direction, within some units of 2^-53.
pub(in crate::solid) fn unit(direction: &[Big; 3]) -> DVec3 {
    let is_less = |a: &Big, b: &Big| a.minus(b).sign() == Some(Ordering::Less);
    let zero = Big::of(0.0);
    let sizes = direction.each_ref().map(|x| match is_less(x, &zero) {
        true => zero.minus(x),
        false => x.clone(),
    });
    let greatest = sizes
        .iter()
        .fold(&zero, |most, size| match is_less(most, size) {
            true => size,
            false => most,
        });
    DVec3::from_array(direction.each_ref().map(|x| ratio(x, greatest))).normalize()
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
