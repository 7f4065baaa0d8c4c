//! Which parts of a solid's surface a ray may meet between two of its points, and with
//! which normals.
//!
//! The points are in the solid's own space, from its anchor, right within `δ` each. A
//! part can be met only if the way between them reaches it:
//!
//! - A disk or a face, whose height is linear along the way, if one end is at it or
//!   beyond.
//! - A wall or a sphere, if one end is at it or beyond: the distance from a line less a
//!   linear function, as the one from a point, is convex along the way.
//! - Of a rounded cone, the sphere at an end and the wall meet at a height that the
//!   point has by the cone's normal, `y + k ρ / c` (below). The distance `ρ` from the
//!   axis changes along the way by no more than its length, so that much is left open.
//! - A disk, if its plane is between the ends.
//!
//! *Normals.* On a disk or face there is one. On a cylinder's wall and on spheres the
//! normal at a point is the vector from the axis or the center. Along the way it stays in
//! one plane and turns monotonically; so it does in the world, and the angle
//! between those at the ends bounds the angle to either. A cone's is `c e - k c x` with the
//! unit vectors `e` from the axis, `x` along it, the slope `k` of the radius and `c = 1
//! / √(1 + k²)`; for the wall that touches two balls, `k` is `s / c` with the sine `s =
//! (r1 - r0) / L`. Between unit vectors `e1` and `e2` at the angle φ, `e = a e1 + b e2`
//! with `1 <= a + b <= 1 / cos(φ/2)`, so that the normal is within
//!
//! ```text
//! |k| c (1 / cos(φ/2) - 1)
//! ```
//!
//! of the plane of those at the ends. From `φ` of [`MOST_TURNED`] on nothing is said.

use glam::DVec3;
use smallvec::SmallVec;

use super::surface::angle;
use cyltrace::math::UNIT_ROUNDOFF;
use cyltrace::solid::{AnySolid, Caps, Part};

/// The angle `φ` up to which a cone's normal is bounded, in radians.
const MOST_TURNED: f64 = 1.5;

/// Part of a ray in a solid's own space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Between {
    /// Where it starts, from the anchor.
    pub low: DVec3,
    /// Where it ends.
    pub high: DVec3,
    /// `δ` of both.
    pub rounding: [f64; 2],
}

/// The normals of a part along the way.
#[derive(Clone, Copy, Debug)]
pub(super) struct PartNormals {
    /// At both ends, outward, of any length.
    pub ends: [DVec3; 2],
    /// By what angle they may be off, and the way between may be out of their plane.
    pub turned: f64,
    /// Whether the part is curved.
    pub is_curved: bool,
}

impl PartNormals {
    fn flat(normal: DVec3) -> Self {
        Self {
            ends: [normal; 2],
            turned: 0.0,
            is_curved: false,
        }
    }
}

/// The parts that may be met.
type Parts = SmallVec<[(Part, PartNormals); 6]>;

impl Between {
    /// The parts that may be met on the way, with their normals.
    pub fn parts(&self, solid: &AnySolid) -> Parts {
        let mut parts = Parts::new();
        match solid {
            AnySolid::Cylinder(one) => {
                let radius = one.radius();
                self.of_cone(one.p1() - one.p0(), [radius; 2], one.caps(), &mut parts);
            }
            AnySolid::Cone(one) => {
                let radii = [one.radius0(), one.radius1()];
                self.of_cone(one.p1() - one.p0(), radii, one.caps(), &mut parts);
            }
            AnySolid::RoundedCone(one) => {
                let radii = [one.radius0(), one.radius1()];
                self.of_rounded_cone(one.p1() - one.p0(), radii, &mut parts);
            }
            AnySolid::Sphere(one) => {
                parts.extend(self.sphere(Part::Side, DVec3::ZERO, one.radius()));
            }
            AnySolid::Cuboid(one) => {
                const FACES: [[Part; 2]; 3] = [
                    [Part::XMin, Part::XMax],
                    [Part::YMin, Part::YMax],
                    [Part::ZMin, Part::ZMax],
                ];
                let frame = one.orientation().world_from_object();
                for (axis, faces) in FACES.into_iter().enumerate() {
                    for (face, side) in faces.into_iter().zip([-1.0, 1.0]) {
                        let normal = frame.col(axis) * side;
                        if self.reaches(normal, one.half_widths()[axis]) {
                            parts.push((face, PartNormals::flat(normal)));
                        }
                    }
                }
            }
            AnySolid::Disk(one) => {
                let normal = one.normal();
                if self.reaches(normal, 0.0) && self.reaches(-normal, 0.0) {
                    parts.push((Part::Side, PartNormals::flat(normal)));
                }
            }
        }
        parts
    }

    fn slack(&self) -> f64 {
        self.rounding[0].max(self.rounding[1])
    }

    /// Whether an end is as high above the anchor, along a vector of any length, or
    /// higher.
    fn reaches(&self, along: DVec3, height: f64) -> bool {
        let along = along.normalize();
        let slack = self.slack() + 4.0 * UNIT_ROUNDOFF * height.abs();
        self.low.dot(along).max(self.high.dot(along)) >= height - slack
    }

    /// The wall of a cylinder or cone and its disks.
    fn of_cone(&self, axis: DVec3, [radius0, radius1]: [f64; 2], caps: Caps, parts: &mut Parts) {
        let length = axis.length();
        let unit = axis / length;
        if caps.at_p0() && self.reaches(-unit, 0.0) {
            parts.push((Part::Cap0, PartNormals::flat(-unit)));
        }
        if caps.at_p1() && self.reaches(unit, length) {
            parts.push((Part::Cap1, PartNormals::flat(unit)));
        }
        let slope = (radius1 - radius0) / length;
        let ends = [self.low, self.high].map(|point| Off::new(point, unit));
        let slack = self.slack() * (1.0 + slope.abs())
            + 4.0 * UNIT_ROUNDOFF * (radius0 + radius1 + slope.abs() * length);
        let reaches = ends
            .iter()
            .any(|end| end.distance >= radius0 + slope * end.height - slack);
        if reaches {
            parts.push((Part::Side, self.wall(&ends, unit, slope)));
        }
    }

    /// The normals of a wall whose radius grows by `slope` along the axis.
    fn wall(&self, ends: &[Off; 2], axis: DVec3, slope: f64) -> PartNormals {
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

    /// A sphere about a point, if it may be met.
    fn sphere(&self, part: Part, center: DVec3, radius: f64) -> Option<(Part, PartNormals)> {
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

    fn of_rounded_cone(&self, axis: DVec3, [radius0, radius1]: [f64; 2], parts: &mut Parts) {
        let length = axis.length();
        let sine = (radius1 - radius0) / length;
        let first = self.sphere(Part::Cap0, DVec3::ZERO, radius0);
        let second = self.sphere(Part::Cap1, axis, radius1);
        if !(sine.abs() < 1.0) {
            // One ball holds the other.
            parts.extend(first.filter(|_| radius0 >= radius1));
            parts.extend(second.filter(|_| radius1 >= radius0));
            return;
        }
        let unit = axis / length;
        let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
        let slope = sine / cosine;
        let ends = [self.low, self.high].map(|point| Off::new(point, unit));
        let heights = ends.each_ref().map(|end| end.height + slope * end.distance);
        let way = (self.high - self.low).length();
        let slack =
            (self.slack() + way + 8.0 * UNIT_ROUNDOFF * (length + way)) * (1.0 + slope.abs());
        let lowest = heights[0].min(heights[1]) - slack;
        let highest = heights[0].max(heights[1]) + slack;
        parts.extend(first.filter(|_| lowest <= 0.0));
        parts.extend(second.filter(|_| highest >= length));
        let beyond = |end: &Off| {
            let slack =
                self.slack() * (1.0 + slope.abs()) + 8.0 * UNIT_ROUNDOFF * (radius0 + length);
            end.distance * cosine - sine * end.height >= radius0 - slack
        };
        if lowest <= length && highest >= 0.0 && ends.iter().any(beyond) {
            parts.push((Part::Side, self.wall(&ends, unit, slope)));
        }
    }
}

/// A point as an axis sees it.
struct Off {
    height: f64,
    distance: f64,
    /// Unit vector from the axis; not a number on it.
    outward: DVec3,
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
