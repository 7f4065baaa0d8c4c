//! The parts of a solid's surface that a ray may hit between two of its points, and their
//! normals.
//!
//! The points are in the solid's own space, from its anchor, right within `δ` each. The ray
//! may hit a part only if the segment between them reaches it:
//!
//! - a disk or a face, whose height is linear along the segment, if one end is at it or
//!   beyond;
//! - a wall or a sphere, if one end is at it or beyond: the distance from a line less a
//!   linear function is convex along the segment, as is the distance from a point;
//! - for a rounded cone, the sphere at an end and the wall join at a height that the
//!   point has by the cone's normal, `y + k ρ / c` (below). The distance `ρ` from the
//!   axis changes along the segment by at most its length, so the heights are uncertain by
//!   that much;
//! - a flat disk, if its plane is between the ends.
//!
//! *Normals.* A disk or face has one. On a cylinder's wall and on spheres the
//! normal at a point is the vector from the axis or the center. Along the segment it stays in
//! one plane and turns monotonically. The same is true in the world, so the angle
//! between those at the ends bounds the angle to either. A cone's is `c e - k c x` with the
//! unit vectors `e` from the axis, `x` along it, the slope `k` of the radius and `c = 1
//! / √(1 + k²)`; for the wall that touches two balls, `k` is `s / c` with the sine `s =
//! (r1 - r0) / L`. Between unit vectors `e1` and `e2` at the angle φ, `e = a e1 + b e2`
//! with `1 <= a + b <= 1 / cos(φ/2)`, so the normal is within
//!
//! ```text
//! |k| c (1 / cos(φ/2) - 1)
//! ```
//!
//! of the plane of those at the ends. From `φ` of [`MOST_TURNED`] on there is no bound.

use glam::DVec3;
use smallvec::SmallVec;

use cyltrace::math::UNIT_ROUNDOFF;
use cyltrace::solid::Part;

/// The angle `φ` up to which a cone's normal is bounded, in radians.
const MOST_TURNED: f64 = 1.5;

/// Part of a ray in a solid's own space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Between {
    /// The start, from the anchor.
    pub low: DVec3,
    /// The end.
    pub high: DVec3,
    /// `δ` of both.
    pub rounding: [f64; 2],
}

/// The normals of a part along the segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartNormals {
    /// At both ends, outward, of any length.
    pub ends: [DVec3; 2],
    /// The angle by which they may be off, and those between may be out of their plane.
    pub turned: f64,
    /// Whether the part is curved.
    pub is_curved: bool,
}

impl PartNormals {
    pub fn flat(normal: DVec3) -> Self {
        Self {
            ends: [normal; 2],
            turned: 0.0,
            is_curved: false,
        }
    }
}

/// The parts that the ray may hit.
pub(crate) type Parts = SmallVec<[(Part, PartNormals); 6]>;

impl Between {
    /// The greater `δ`.
    pub fn slack(&self) -> f64 {
        self.rounding[0].max(self.rounding[1])
    }

    /// Whether an end is at a height above the anchor or beyond, along a vector of any length.
    pub fn reaches(&self, along: DVec3, height: f64) -> bool {
        let along = along.normalize();
        let slack = self.slack() + 4.0 * UNIT_ROUNDOFF * height.abs();
        self.low.dot(along).max(self.high.dot(along)) >= height - slack
    }

    /// Both ends as a unit axis through the anchor sees them.
    pub fn off(&self, unit: DVec3) -> [Off; 2] {
        [self.low, self.high].map(|point| Off::new(point, unit))
    }

    /// The normals of a wall whose radius grows by `slope` along the axis.
    pub fn wall(&self, ends: &[Off; 2], axis: DVec3, slope: f64) -> PartNormals {
        let share = slope.abs() / libm::hypot(1.0, slope);
        let half_turn = 0.5 * angle(ends[0].outward, ends[1].outward);
        // Doubled: it is a length across the normal, not the angle.
        let bent = 2.0 * share * (1.0 / libm::cos(half_turn) - 1.0);
        let turned = if share == 0.0 {
            0.0
        } else if half_turn < 0.5 * MOST_TURNED {
            bent
        } else {
            f64::NAN
        };
        let off = ends.iter().zip(self.rounding);
        let off = off.map(|(end, rounding)| 2.0 * rounding / end.distance);
        PartNormals {
            ends: ends.each_ref().map(|end| end.outward - axis * slope),
            turned: turned + off.sum::<f64>(),
            is_curved: true,
        }
    }

    /// The sphere about a point, if the ray may hit it.
    pub fn sphere(&self, part: Part, center: DVec3, radius: f64) -> Option<(Part, PartNormals)> {
        let ends = [self.low - center, self.high - center];
        let slack = self.slack() + 4.0 * UNIT_ROUNDOFF * (radius + center.length());
        let reaches = ends.iter().any(|end| end.length() >= radius - slack);
        let off = ends.iter().zip(self.rounding);
        let off = off.map(|(end, rounding)| 2.0 * rounding / end.length());
        let normals = PartNormals {
            ends,
            turned: off.sum(),
            is_curved: true,
        };
        reaches.then_some((part, normals))
    }
}

/// A point as an axis sees it.
pub(crate) struct Off {
    pub height: f64,
    pub distance: f64,
    /// Unit vector from the axis; NaN on it.
    pub outward: DVec3,
}

impl Off {
    fn new(point: DVec3, unit: DVec3) -> Self {
        let height = point.dot(unit);
        let off = point - unit * height;
        let distance = off.length();
        Self {
            height,
            distance,
            outward: off / distance,
        }
    }
}

/// The angle between two vectors, without loss if it is small.
pub(crate) fn angle(one: DVec3, other: DVec3) -> f64 {
    libm::atan2(one.cross(other).length(), one.dot(other))
}
