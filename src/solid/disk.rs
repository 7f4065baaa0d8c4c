//! The flat disk as users define it, and ray against disk.
//!
//! With the normal `n` as stated and the ray `center + x + t d`, the line intersects the plane
//! at `t = -n·x / n·d`. The point times `n·d` is
//!
//! ```text
//! P = x (n·d) - d (n·x) = n × (x × d)                                      (1)
//! ```
//!
//! and it is within the disk if `|P| <= radius |n·d|`. `x × d` does not change when the origin
//! slides along the ray, so no term is as large as the distance of the origin and cancels
//! later. Rounded products leave an error of at most `13 u |n| |x| |d|` in `|P|` (3 u for each
//! vector product, the error of the first within the second, 4 u for the length, and u for `x`,
//! which may be rounded) and `6 u |n| |d| radius` on the other side. If the two sides are
//! nearer to each other, the squares are compared in exact numbers.
//!
//! `n·x` and `n·d` come from `linear.rs`: `t` is within 2^-40 of itself, and whether the line
//! is parallel to the plane, or within it, is decided exactly. A line within the plane
//! intersects the disk as it does the ball of the same radius.

use std::cmp::Ordering;

use glam::DVec3;

use super::cylinder::disk_reach;
use super::exact::{Expression, Number, cross, difference, dot, sign, vector};
use super::offset::Offset;
use super::quick::{End, Quick, Range};
use super::reject::Line;
use super::surface::Around;
use super::{
    Chord, ChordEnd, ConvexSolid, Cylinder, Location, Part, RayOrigin, SolidKind, SurfacePoint,
    ball, linear,
};
use crate::math::{Bounds, UNIT_ROUNDOFF};

/// A flat disk: its center, a normal of any length and its radius, all taken as exact numbers.
///
/// It is the closed set `{x : normal · (x - center) = 0, |x - center| <= radius}`, a solid
/// without an inside. A ray that passes through it intersects it in one point, an entry and an
/// exit at the same `t`. All of it is [`Part::Side`](super::Part::Side).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    center: DVec3,
    normal: DVec3,
    radius: f64,
}

/// Why numbers do not define a disk.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum DiskError {
    /// A coordinate of the center is NaN, infinite or beyond [`Cylinder::GREATEST`].
    #[error("the center is ({:?}, {:?}, {:?}): every coordinate must be finite and at most {:.1e} in size", center.x, center.y, center.z, Cylinder::GREATEST)]
    Center {
        /// The center as given.
        center: DVec3,
    },
    /// The normal is zero or not finite, or its greatest coordinate is out of
    /// [`Cylinder::LEAST`, `Cylinder::GREATEST`].
    #[error(
        "the normal is ({:?}, {:?}, {:?}): its greatest coordinate must be between {:.1e} and {:.1e} in size", normal.x, normal.y, normal.z,
        Cylinder::LEAST,
        Cylinder::GREATEST
    )]
    Normal {
        /// The normal as given.
        normal: DVec3,
    },
    /// The radius is not in [`Cylinder::LEAST`, `Cylinder::GREATEST`].
    #[error(
        "radius is {radius:?}: it must be a positive number between {:.1e} and {:.1e}",
        Cylinder::LEAST,
        Cylinder::GREATEST
    )]
    Radius {
        /// The radius as given.
        radius: f64,
    },
}

impl Disk {
    /// The disk around `center` across `normal`.
    ///
    /// # Errors
    /// When a number is not finite or out of range.
    pub fn new(center: DVec3, normal: DVec3, radius: f64) -> Result<Self, DiskError> {
        let range = Cylinder::LEAST..=Cylinder::GREATEST;
        if !Cylinder::is_in_range(center) {
            return Err(DiskError::Center { center });
        }
        if !normal.is_finite() || !range.contains(&normal.abs().max_element()) {
            return Err(DiskError::Normal { normal });
        }
        if !range.contains(&radius) {
            return Err(DiskError::Radius { radius });
        }
        Ok(Self::from_valid(center, normal, radius))
    }

    /// The disk of numbers that [`Disk::new`] has accepted before.
    #[inline]
    pub(crate) fn from_valid(center: DVec3, normal: DVec3, radius: f64) -> Self {
        Self {
            center,
            normal,
            radius,
        }
    }

    /// The center.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The normal as stated, of any length.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The radius, positive.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl ConvexSolid for Disk {
    const KIND: SolidKind = SolidKind::Disk;

    fn bounds(&self) -> Bounds {
        let reach = disk_reach(self.normal, self.radius);
        Bounds {
            lower: self.center - reach,
            upper: self.center + reach,
        }
        .rounded_outward()
    }

    fn anchor(&self) -> DVec3 {
        self.center
    }

    fn center(&self) -> DVec3 {
        self.center
    }

    fn radius(&self) -> f64 {
        self.radius
    }

    fn is_closed(&self) -> bool {
        false
    }

    #[inline]
    fn chord(&self, from_anchor: DVec3, direction: DVec3) -> Option<Chord> {
        self.chord_of(from_anchor, direction)
    }

    fn exact_chord(&self, origin: &RayOrigin, direction: DVec3) -> Option<Chord> {
        self.chord_of(origin.offset_from(self.center), direction)
    }

    #[inline(always)]
    fn rejects(&self, from_anchor: DVec3, direction: DVec3) -> bool {
        Line::new(from_anchor, direction).misses_disk(self.normal, self.radius)
    }

    #[inline(always)]
    fn quick_first(&self, from_anchor: DVec3, direction: DVec3, range: &Range) -> Quick {
        let (n, x, d) = (self.normal, from_anchor, direction);
        let (height, slope) = (linear::rounded_product(n, x), linear::rounded_product(n, d));
        let is_within = Line::new(x, d).hits_disk(n, self.radius);
        let end = End {
            t: plane_at(height.value, slope.value),
            slack: height.slack() / slope.value.abs(),
        };
        Quick::of_ends(!is_within | slope.is_poor(), [end; 2], range)
    }

    /// `u` is the angle about the normal in turns, counted as on a cylinder whose axis is the
    /// normal, and `v` the distance from the center in radii.
    ///
    /// The offset from the center, made perpendicular to the normal twice, is off the plane by
    /// 6 u of its length, which is at most the radius within 5 u; the product and the sum with
    /// the center round by u of theirs.
    fn surface_point(&self, _: Part, from_anchor: DVec3) -> SurfacePoint {
        let around = Around::new(self.normal, from_anchor);
        let point = self.center + around.outward * around.distance.min(self.radius);
        SurfacePoint {
            point,
            error: UNIT_ROUNDOFF * (point.length() + 16.0 * self.radius),
            normal: around.axis,
            v: (around.distance / self.radius).min(1.0),
            first: around.angle(),
        }
    }

    fn locate(&self, point: DVec3) -> Location {
        let is_of_it = point.is_finite()
            && sign(&Height { disk: self, point }) == Ordering::Equal
            && ball::locate(self.center, self.radius, point).is_held();
        if is_of_it {
            Location::Boundary
        } else {
            Location::Outside
        }
    }

    fn is_on(&self, part: Part, _: DVec3) -> bool {
        part == Part::Side
    }

    fn size(&self) -> f64 {
        2.0 * self.radius
    }
}

/// The parameter at which a line intersects the plane.
#[inline(always)]
fn plane_at(height: f64, slope: f64) -> f64 {
    (0.0 - height) / slope
}

impl Disk {
    /// The chord of the line `center + x + t d`.
    #[inline(always)]
    fn chord_of(&self, x: impl Offset, d: DVec3) -> Option<Chord> {
        let n = self.normal;
        // Zero times infinity or NaN is NaN.
        if (x.rounded() + d).dot(DVec3::ZERO) != 0.0 {
            return None;
        }
        let (height, slope) = (linear::product(n, x), linear::product(n, d));
        if slope == 0.0 {
            return self.chord_in_plane(height, x, d);
        }
        self.is_hit(slope, x, d).then(|| {
            let end = ChordEnd {
                t: plane_at(height, slope),
                part: Part::Side,
                on_rim: false,
            };
            Chord {
                enter: end,
                leave: end,
                lies_on: None,
            }
        })
    }

    #[cold]
    fn chord_in_plane<W: Offset>(&self, height: f64, x: W, d: DVec3) -> Option<Chord> {
        if height != 0.0 {
            return None;
        }
        let chord = ball::chord(x, d, self.radius, Part::Side)?;
        Some(Chord {
            lies_on: Some(Part::Side),
            ..chord
        })
    }

    /// Whether the line intersects the plane within the disk.
    #[inline]
    fn is_hit<W: Offset>(&self, slope: f64, offset: W, d: DVec3) -> bool {
        let x = offset.rounded();
        let point = self.normal.cross(x.cross(d)).length();
        let reach = self.radius * slope.abs();
        let error =
            16.0 * UNIT_ROUNDOFF * (self.normal.length() * d.length() * (x.length() + self.radius));
        if (point - reach).abs() > error {
            return point < reach;
        }
        let within = Within {
            disk: *self,
            x: offset,
            d,
        };
        sign(&within) != Ordering::Less
    }
}

/// `radius² (n·d)² - |P|²`.
struct Within<W> {
    disk: Disk,
    x: W,
    d: DVec3,
}

impl<W: Offset> Expression for Within<W> {
    fn value<N: Number>(&self) -> N {
        let (n, x, d) = (
            vector::<N>(self.disk.normal),
            self.x.exactly(),
            vector(self.d),
        );
        let point = cross(&n, &cross(&x, &d));
        let reach = N::of(self.disk.radius).times(&dot(&n, &d));
        reach.times(&reach).minus(&dot(&point, &point))
    }
}

/// `n·(point - center)`.
struct Height<'a> {
    disk: &'a Disk,
    point: DVec3,
}

impl Expression for Height<'_> {
    fn value<N: Number>(&self) -> N {
        let x = difference::<N>(self.point, self.disk.center);
        dot(&vector(self.disk.normal), &x)
    }
}
