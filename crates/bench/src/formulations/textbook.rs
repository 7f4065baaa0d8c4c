//! What the textbook formulations share: how they store a cylinder, how they
//! take the roots of a quadratic, and how they choose among the candidates.
//!
//! Their sources solve `a t² + b t + c = 0` by `t = (-b ∓ √(b² - 4 a c)) / 2a`
//! and check each root against the ends of the cylinder. `b² - 4 a c` and the
//! sum in the numerator cancel where the ray grazes the wall or starts far
//! away; that loss is theirs and is kept.

use cyltrace::math::{Real, RealVector};
use cyltrace::solid::{Caps, Cylinder, Part};

/// A cylinder as center, unit axis, radius and half of its height.
#[derive(Clone, Copy, Debug)]
pub(super) struct CenterRecord<S: Real> {
    pub center: S::Vector,
    /// From `p0` to `p1`, of length 1 but for rounding.
    pub axis: S::Vector,
    pub radius: S,
    pub half_height: S,
    pub caps: Caps,
}

impl<S: Real> CenterRecord<S> {
    pub fn of(cylinder: &Cylinder) -> Self {
        let (p0, p1) = (cylinder.p0(), cylinder.p1());
        Self {
            center: S::Vector::from_f64((p0 + p1) * 0.5),
            axis: S::Vector::from_f64((p1 - p0).normalize()),
            radius: S::from_f64(cylinder.radius()),
            half_height: S::from_f64((p1 - p0).length() * 0.5),
            caps: cylinder.caps(),
        }
    }

    /// The disks: whether the cylinder has them, and where their planes are on
    /// the axis, counted from the center.
    #[inline]
    pub fn disks(&self) -> [(bool, S, Part); 2] {
        [
            (self.caps.at_p0(), -self.half_height, Part::Cap0),
            (self.caps.at_p1(), self.half_height, Part::Cap1),
        ]
    }
}

/// The coefficients of `a t² + b t + c = 0`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quadratic<S> {
    pub a: S,
    pub b: S,
    pub c: S,
}

impl<S: Real> Quadratic<S> {
    /// Where the point `x + t d` is at distance `radius` from a line through
    /// the origin with the unit direction `axis`:
    ///
    /// ```text
    /// a = d·d - (d·axis)²
    /// b = 2 (d·x - (d·axis)(x·axis))
    /// c = x·x - (x·axis)² - radius²
    /// ```
    #[inline]
    pub fn of_distance(x: S::Vector, d: S::Vector, axis: S::Vector, radius: S) -> Self {
        let (d_axis, x_axis) = (d.dot(axis), x.dot(axis));
        Self {
            a: d.dot(d) - d_axis * d_axis,
            b: S::from_f64(2.0) * (d.dot(x) - d_axis * x_axis),
            c: x.dot(x) - x_axis * x_axis - radius * radius,
        }
    }

    /// Both roots by the textbook formula, the lesser first (`a` is positive);
    /// `None` where they are not real or there is no quadratic.
    #[inline]
    pub fn roots(&self) -> Option<[S; 2]> {
        let discriminant = self.b * self.b - S::from_f64(4.0) * self.a * self.c;
        if self.a == S::ZERO || !(discriminant >= S::ZERO) {
            return None;
        }
        let root = discriminant.sqrt();
        let twice_a = S::from_f64(2.0) * self.a;
        Some([(-self.b - root) / twice_a, (-self.b + root) / twice_a])
    }
}

/// The nearest of the candidates offered so far, within a range of `t`.
///
/// Of equal ones the last offered counts: solvers offer disks after the wall,
/// since a rim belongs to the disk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest<S> {
    t_min: S,
    t_max: S,
    found: Option<(S, Part)>,
}

impl<S: Real> Nearest<S> {
    /// No candidate yet, for `t_min <= t <= t_max`.
    #[inline]
    pub fn new(t_min: S, t_max: S) -> Self {
        Self {
            t_min,
            t_max,
            found: None,
        }
    }

    /// Whether a hit at `t` would be the nearest so far.
    #[inline]
    pub fn wants(&self, t: S) -> bool {
        self.t_min <= t && t <= self.t_max
    }

    /// Takes a candidate that is wanted.
    #[inline]
    pub fn take(&mut self, t: S, part: Part) {
        self.t_max = t;
        self.found = Some((t, part));
    }

    /// The nearest candidate.
    #[inline]
    pub fn found(self) -> Option<(S, Part)> {
        self.found
    }
}

/// The outward normal of a disk.
pub(super) fn disk_normal<S: Real>(axis: S::Vector, part: Part) -> S::Vector {
    if part == Part::Cap0 { -axis } else { axis }
}
