//! A polyline turned about an axis, as triangles.
//!
//! The polyline has a *ring* for each corner off the axis, and may begin and end in a *pole*, a
//! corner on it. A ring becomes N corners at multiples of `2π/N`, two rings become a band of
//! trapezoids, and a pole with the ring next to it a fan of triangles. A flat disk is the fan
//! of a pole at its center.
//!
//! **Roundings** (u = 2^-53; R is the radius of the corners). A corner is
//! `p + (e cos φ + f sin φ) R`, p the center of the ring:
//!
//! - `φ = 2π k / N` has three roundings, together an angle of `19 u`, which turns the corner;
//! - the axis is off by `5 u` (difference, length, quotient); `e`, a difference
//!   no shorter than √(2/3), is off by `14 u` from a unit vector across the
//!   true axis, and `f = axis × e` by `22 u`;
//! - sine and cosine are off by 2 u, their products and sum by 3 u: `10 u` for
//!   the two terms together, with the product by R;
//! - R itself is within `6 u`: π/N, the cosine (relative, as π/N <= π/3) and the
//!   quotient; and the sum with p rounds by `u (|p| + R)`.
//!
//! The sum is `u (72 R + |p|)`. [`Profile::corner_error`] counts 80 and 2, and the error of the
//! polyline itself over `cos(π/N)`, as R is.

use glam::DVec3;

use super::{Fit, inner_factor};
use crate::math::UNIT_ROUNDOFF;
use crate::solid::surface::angle_frame;

/// A corner of the polyline off the axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    /// Its center, on the axis.
    pub center: DVec3,
    /// Its distance from the axis, positive.
    pub radius: f64,
}

/// A polyline that, turned about an axis, is a solid or its wall.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    /// Unit vector.
    pub axis: DVec3,
    /// In the order of their heights along the axis.
    pub rings: Vec<Ring>,
    /// The pole before the first ring.
    pub start: Option<DVec3>,
    /// The pole after the last ring.
    pub end: Option<DVec3>,
    /// The greatest distance of the polyline from the meridian.
    pub deviation: f64,
    /// The bound of the roundings of its corners.
    pub error: f64,
}

impl Profile {
    /// The vertices: those of the rings by meridian, then the poles.
    pub fn vertices(&self, segments: u32, fit: Fit) -> Vec<DVec3> {
        let factor = inner_factor(segments);
        let (reference, across) = angle_frame(self.axis);
        let mut vertices = Vec::with_capacity(self.size(segments).0 as usize);
        for meridian in 0..segments {
            let angle = std::f64::consts::TAU * f64::from(meridian) / f64::from(segments);
            let (sin, cos) = libm::sincos(angle);
            let outward = reference * cos + across * sin;
            vertices.extend(self.rings.iter().map(|ring| {
                let radius = match fit {
                    Fit::Inscribed => ring.radius,
                    Fit::Circumscribed => ring.radius / factor,
                };
                ring.center + outward * radius
            }));
        }
        vertices.extend(self.start);
        vertices.extend(self.end);
        vertices
    }

    /// The triangles of those vertices.
    pub fn triangles(&self, segments: u32) -> Vec<[u32; 3]> {
        let rings = self.rings.len() as u32;
        let sectors = (0..segments).map(|here| (rings * here, rings * ((here + 1) % segments)));
        let mut triangles = Vec::with_capacity(self.size(segments).1 as usize);
        for (here, next) in sectors.clone() {
            for (here, next) in (here..).zip(next..next + rings - 1) {
                triangles.extend([[here, next, next + 1], [here, next + 1, here + 1]]);
            }
        }
        let mut pole = rings * segments;
        if self.start.is_some() {
            triangles.extend(sectors.clone().map(|(here, next)| [pole, next, here]));
            pole += 1;
        }
        if self.end.is_some() {
            let last = rings - 1;
            triangles.extend(sectors.map(|(here, next)| [pole, here + last, next + last]));
        }
        triangles
    }

    /// The numbers of vertices and triangles.
    pub fn size(&self, segments: u32) -> (u64, u64) {
        let poles = u64::from(self.start.is_some()) + u64::from(self.end.is_some());
        turned_size(self.rings.len() as u64, poles, segments)
    }

    /// The deviation of the polyline turned with N sides from the solid of revolution.
    pub fn deviation(&self, segments: u32, fit: Fit) -> f64 {
        let factor = inner_factor(segments);
        let of_turn = match fit {
            Fit::Inscribed => 1.0 - factor,
            Fit::Circumscribed => 1.0 / factor - 1.0,
        };
        self.deviation + self.widest() * of_turn
    }

    /// The error bound of a computed corner.
    pub fn corner_error(&self, segments: u32) -> f64 {
        let factor = inner_factor(segments);
        let farthest = self.greatest(|ring| ring.center.length());
        UNIT_ROUNDOFF * (80.0 * (self.widest() / factor) + 2.0 * farthest) + self.error / factor
    }

    /// An upper bound of the distance of a corner from the origin.
    pub fn reach(&self, segments: u32) -> f64 {
        let factor = inner_factor(segments);
        let of_poles = [self.start, self.end].map(|pole| pole.map_or(0.0, DVec3::length));
        self.greatest(|ring| ring.center.length() + ring.radius / factor)
            .max(of_poles[0])
            .max(of_poles[1])
    }

    fn widest(&self) -> f64 {
        self.greatest(|ring| ring.radius)
    }

    fn greatest(&self, of: impl Fn(&Ring) -> f64) -> f64 {
        self.rings.iter().map(of).fold(0.0, f64::max)
    }
}

/// The numbers of vertices and triangles of these rings and poles.
pub(super) fn turned_size(rings: u64, poles: u64, segments: u32) -> (u64, u64) {
    let segments = u64::from(segments);
    (
        rings * segments + poles,
        (2 * (rings - 1) + poles) * segments,
    )
}
