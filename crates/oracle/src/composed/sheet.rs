//! The surfaces that bound a solid, as polynomials.
//!
//! A sheet is the set where `F(x) = x·M x + 2 b·x + c` is zero; `F < 0` is its inner
//! side. At the point `x = X / r`, and on a curve from there, `r²F` is
//!
//! ```text
//! r²F((X + v) / r) = r²F(x) + 2 g·v + v·M v,   g = M X + r b
//! ```

use crate::number::{Exact, ExactVector, exact, to_f64, zero};
use crate::taper::Quadratic;
use cyltrace::math::power_of_two;
use cyltrace::solid::Part;

use super::place::Place;
use super::ring::{Form, Number, Vector};

/// A plane or a quadric.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub(super) form: Form,
    pub linear: ExactVector,
    pub constant: Exact,
    /// The part of the solid that it is, unless it only divides others.
    pub part: Option<Part>,
    /// The axis of a wall and the tangent of its half opening angle.
    pub axis: Option<(ExactVector, f64)>,
}

impl Sheet {
    /// The plane `normal·x = offset`; the normal points to the outer side.
    pub fn plane(normal: &ExactVector, offset: &Exact, part: Option<Part>) -> Self {
        Self {
            form: Form::zero(),
            linear: normal.times(&exact(0.5)),
            constant: -offset,
            part,
            axis: None,
        }
        .of_usual_size()
    }

    pub fn sphere(center: &ExactVector, radius: &Exact, part: Part) -> Self {
        Self {
            form: Form::of_axis(&exact(1.0), &zero(), center),
            linear: center.times(&exact(-1.0)),
            constant: center.dot(center) - radius * radius,
            part: Some(part),
            axis: None,
        }
        .of_usual_size()
    }

    /// The wall with the axis `a` through `p0`, as in `taper.rs`: with `q = x - p0`
    ///
    /// `F = β (a·a q·q - (a·q)²) - (r0 a·a + Δ a·q)²`.
    pub fn wall(p0: &ExactVector, a: &ExactVector, [r0, delta, beta]: [&Exact; 3]) -> Self {
        let aa = a.dot(a);
        let along = -(beta + delta * delta);
        let form = Form::of_axis(&(beta * &aa), &along, a);
        // In q: 2 b·q = -2 r0 a·a Δ a·q.
        let from_p0 = a.times(&-(r0 * &aa * delta));
        let shifted = form.image(p0);
        let linear = &from_p0 - &shifted;
        let constant = -(r0 * r0 * &aa * &aa) - exact(2.0) * from_p0.dot(p0) + p0.dot(&shifted);
        let slope = (to_f64(delta) / to_f64(beta).sqrt()).abs();
        Self {
            form,
            linear,
            constant,
            part: Some(Part::Side),
            axis: Some((a.clone(), slope)),
        }
        .of_usual_size()
    }

    /// The same surface with coefficients near 1, for approximations in f64.
    fn of_usual_size(self) -> Self {
        let rows = self.form.0.iter().map(ExactVector::rounded);
        let greatest = rows
            .chain([self.linear.rounded()])
            .map(|row| row.abs().max_element())
            .fold(0.0, f64::max);
        let exponent = (greatest.to_bits() >> 52) as i32 - 1023;
        let factor = exact(power_of_two(-exponent));
        Self {
            form: self.form.times(&factor),
            linear: self.linear.times(&factor),
            constant: self.constant * &factor,
            ..self
        }
    }

    /// `F` along a line.
    pub fn on_line(&self, origin: &ExactVector, direction: &ExactVector) -> Quadratic {
        let toward = self.form.image(direction);
        let shifted = self.form.image(origin);
        Quadratic {
            a: toward.dot(direction),
            b: toward.dot(origin) + self.linear.dot(direction),
            c: shifted.dot(origin) + exact(2.0) * self.linear.dot(origin) + &self.constant,
        }
    }

    /// `g`, half the gradient of `r²F`.
    pub(super) fn gradient(&self, place: &Place) -> Vector {
        let linear = Vector::rational(&self.linear.times(&place.unit));
        self.form.image_of(&place.coordinates).plus(&linear)
    }

    /// `r²F`.
    pub(super) fn value(&self, place: &Place) -> Number {
        let linear = Vector::rational(&self.linear.times(&place.unit));
        let rest = Number::rational(&self.constant * &place.unit * &place.unit);
        let inner = self.gradient(place).plus(&linear);
        inner.dot(&place.coordinates).plus(&rest)
    }
}
