//! The profiles of the kinds of solids; see the head of this folder.
//!
//! **Straight profiles.** Cylinder, cone and disk have exact ends, as stated. A radius of zero
//! is a pole, the apex.
//!
//! **An arc** of radius r about c goes from a pole, where it is perpendicular to the axis,
//! through an angle θ. With steps of δ its corners are at δ, 2δ, ... from the pole: on the arc,
//! or at `r / cos(δ/2)`, where they and the pole are the corners of a polyline that touches the
//! arc at δ/2, 3δ/2, .... A ball is an arc with `θ = π` from pole to pole, of 2 m + 1 such
//! steps. Each of its halves is an arc of m rings, and the step between them crosses the
//! equator: `δ = π / (2 m + 1)`.
//!
//! **A rounded cone** has an arc of each ball, up to the circle in which the wall touches it,
//! at the angle θ with `cos θ = ±Δ / |a|`, `sin θ = √β / |a|` (Δ the difference of the radii,
//! `β = |a|² - Δ²`). Of m rings, the last of the inscribed polyline is that circle,
//! `δ = θ / m`. The circumscribed polyline touches the arc there for the last time, half a step
//! beyond its last ring, `δ = θ / (m + 1/2)`: then the last corners of both arcs are on the
//! line of the wall, and the segment between them touches both balls. A radius of zero is a
//! pole on that line. If one ball contains the other, the solid is that ball.
//!
//! m is the least number with `θ / m <= 2π/N`, so that δ <= 2π/3.
//!
//! **Roundings** (u = 2^-53; ρ = r / cos(δ/2), R the greatest of them). The computed θ is taken
//! as exact. A corner at k δ is off by 2 u of at most π; `ρ` by 4 u, as `δ/2 tan(δ/2) < 2`;
//! sine, cosine and the products by 4 u; the axis by 6 u; and the sum with c rounds by
//! `u (|c| + ρ)`: together `u (22 ρ + |c|)`. θ itself is off by
//!
//! - ten u, for the arctangent and its arguments, with the rounded axis;
//! - the effect of rounding `a` on β: at most `√u`, or 2 √u if β is below `u |a|²`
//!   (`rounded_cone/surface.rs`).
//!
//! With an angle off by ε, an inscribed polyline still has its corners on the arcs, and falls
//! short of the wall by `r (1 - cos ε) <= 4 u r` more. The two directions in which a
//! circumscribed one should touch both balls then differ by `|a·n + Δ| <= 14 u |a|`: ten for
//! the angle, the others for `a`, Δ and terms of second order. By that, one of the arcs' last
//! corners is below the line of the wall. The direction of the wall turns by that over its
//! length, at least `r tan(δ/2)`, which moves the points where it touches the balls,
//! `r sin(δ/2)` from its corners, by no more. The sum is `u (26 R + |c| + 14 |a|)`; 32, 2 and
//! 16 are counted.

use glam::DVec3;

use super::profile::{Profile, Ring};
use super::{Fit, Outline, Tessellated};
use crate::math::{UNIT_ROUNDOFF, unit};
use crate::solid::{Cone, Cylinder, Disk, RoundedCone, Sphere};

/// The wall of a cylinder with its disks.
impl Tessellated for Cylinder {
    fn outline(&self, segments: u32, fit: Fit) -> Outline {
        self.as_cone().outline(segments, fit)
    }
}

/// The wall of a cone with its disks or its apex.
impl Tessellated for Cone {
    fn outline(&self, _: u32, _: Fit) -> Outline {
        let ends = [(self.p0(), self.radius0()), (self.p1(), self.radius1())];
        let rings = ends.iter().filter(|(_, radius)| *radius > 0.0);
        let pole = |end: usize, has_disk: bool| {
            let (point, radius) = ends[end];
            (has_disk || radius == 0.0).then_some(point)
        };
        Outline::Turned(Profile {
            axis: (self.p1() - self.p0()).normalize(),
            rings: rings
                .map(|&(center, radius)| Ring { center, radius })
                .collect(),
            start: pole(0, self.caps().at_p0()),
            end: pole(1, self.caps().at_p1()),
            deviation: 0.0,
            error: 0.0,
        })
    }
}

/// A disk, from its rim to its center.
impl Tessellated for Disk {
    fn outline(&self, _: u32, _: Fit) -> Outline {
        let (center, radius) = (self.center(), self.radius());
        Outline::Turned(Profile {
            axis: self.normal().normalize(),
            rings: vec![Ring { center, radius }],
            start: None,
            end: Some(center),
            deviation: 0.0,
            error: 0.0,
        })
    }
}

impl Tessellated for Sphere {
    fn outline(&self, segments: u32, fit: Fit) -> Outline {
        Outline::Turned(of_ball(self.center(), self.radius(), segments, fit))
    }
}

impl Tessellated for RoundedCone {
    fn outline(&self, segments: u32, fit: Fit) -> Outline {
        Outline::Turned(of_rounded_cone(self, segments, fit))
    }
}

/// A ball, whose axis is along z.
fn of_ball(center: DVec3, radius: f64, segments: u32, fit: Fit) -> Profile {
    let half = |towards: DVec3| {
        let rings = rings_of(std::f64::consts::FRAC_PI_2, segments);
        let step = std::f64::consts::FRAC_PI_2 / (f64::from(rings) + 0.5);
        Arc::new(center, radius, towards, (rings, step), fit)
    };
    of_arcs(DVec3::Z, [half(DVec3::NEG_Z), half(DVec3::Z)], 0.0)
}

/// Both balls of a rounded cone and the wall between them.
fn of_rounded_cone(cone: &RoundedCone, segments: u32, fit: Fit) -> Profile {
    let ends = [(cone.p0(), cone.radius0()), (cone.p1(), cone.radius1())];
    let wall = cone.taper().and_then(|taper| Some((taper, unit(taper.a)?)));
    let Some((taper, axis)) = wall else {
        let greater = usize::from(cone.radius1() > cone.radius0());
        let (center, radius) = ends[greater];
        return of_ball(center, radius, segments, fit);
    };
    let delta = cone.radius1() - cone.radius0();
    let arc = |(center, radius): (DVec3, f64), towards: DVec3, delta: f64| {
        let angle = libm::atan2(taper.beta().sqrt(), delta);
        let rings = rings_of(angle, segments);
        let step = match fit {
            Fit::Inscribed => angle / f64::from(rings),
            Fit::Circumscribed => angle / (f64::from(rings) + 0.5),
        };
        Arc::new(center, radius, towards, (rings, step), fit)
    };
    let arcs = [arc(ends[0], -axis, delta), arc(ends[1], axis, -delta)];
    of_arcs(axis, arcs, 16.0 * UNIT_ROUNDOFF * taper.a.length())
}

/// The number of rings of an arc.
fn rings_of(angle: f64, segments: u32) -> u32 {
    let steps = angle * f64::from(segments) / std::f64::consts::TAU;
    (steps.ceil() as u32).max(1)
}

/// The polyline of an arc, from its pole on.
struct Arc {
    pole: DVec3,
    rings: Vec<Ring>,
    deviation: f64,
    error: f64,
}

impl Arc {
    /// An arc of this number of rings, one step apart.
    fn new(
        center: DVec3,
        radius: f64,
        towards: DVec3,
        (rings, step): (u32, f64),
        fit: Fit,
    ) -> Self {
        let factor = libm::cos(0.5 * step);
        let (corner_radius, deviation) = match fit {
            Fit::Inscribed => (radius, radius * (1.0 - factor)),
            Fit::Circumscribed => (radius / factor, radius * (1.0 / factor - 1.0)),
        };
        let ring = |number: u32| {
            let (sin, cos) = libm::sincos(step * f64::from(number));
            Ring {
                center: center + towards * (corner_radius * cos),
                radius: corner_radius * sin,
            }
        };
        // An arc without a radius is a point.
        let rings = if radius > 0.0 { rings } else { 0 };
        Self {
            pole: center + towards * corner_radius,
            rings: (1..=rings).map(ring).collect(),
            deviation,
            error: UNIT_ROUNDOFF * (32.0 * corner_radius + 2.0 * center.length()),
        }
    }
}

/// The polyline of two arcs from the pole of the first to that of the second. `of_wall` bounds
/// the roundings of the wall.
fn of_arcs(axis: DVec3, [first, second]: [Arc; 2], of_wall: f64) -> Profile {
    Profile {
        axis,
        rings: first
            .rings
            .into_iter()
            .chain(second.rings.into_iter().rev())
            .collect(),
        start: Some(first.pole),
        end: Some(second.pole),
        deviation: first.deviation.max(second.deviation),
        error: first.error.max(second.error) + of_wall,
    }
}
