//! A point in exact coordinates, on a line or by itself.

use crate::number::{Exact, ExactVector, Surd, exact, to_f64};
use cyltrace::math::power_of_two;

use super::ring::{Number, Root, Vector};

/// The point `coordinates / unit`, with `unit > 0`.
pub(super) struct Place {
    pub coordinates: Vector,
    pub unit: Exact,
}

impl Place {
    pub fn at(point: &ExactVector) -> Self {
        Self {
            coordinates: Vector::rational(point),
            unit: exact(1.0),
        }
    }

    /// `origin + t direction`. The parameter's numerator and denominator are scaled
    /// such that the unit is near 1.
    pub fn on_line(origin: &ExactVector, direction: &ExactVector, t: &Surd) -> Self {
        let exponent = (to_f64(&t.r).to_bits() >> 52) as i32 - 1023;
        let scale = exact(power_of_two(-exponent));
        let [p, q, unit] = [&t.p, &t.q, &t.r].map(|one| one * &scale);
        let root = Root::of(&t.s);
        let coordinates = [0, 1, 2].map(|i| {
            let (o, d) = (&origin.0[i], &direction.0[i]);
            Number::new(o * &unit + d * &p, d * &q, &root)
        });
        Self {
            coordinates: Vector(coordinates),
            unit,
        }
    }
}
