//! The hull of two disks across an axis, or a flat disk.
//!
//! *Displaced.* In the half plane of the axis the solid is the polygon between the
//! axis, its ends and its wall, and its lines move by δ along their normals. With the
//! slope `k = (r1 - r0) / L` of the wall, the radius grows by `δ √(1 + k²)` at
//! every height. The ends are then at `-δ` and `L + δ`, with the radii
//!
//! ```text
//! r0 + δ (√(1 + k²) - k),   r1 + δ (√(1 + k²) + k)
//! ```
//!
//! If one of a shrunk cone's is negative, its wall reaches the axis before the
//! end, at the new apex.
//!
//! *Depth.* A point is seen in that half plane as its height y and its distance ρ from
//! the axis. There the wall and the disks are segments.
//!
//! *Support.* With the ends `e` as seen from the anchor and the axis `a`:
//! `h(m) = max (m·e + r |m × a| / |a|)`.

use glam::{DVec2, DVec3};

use super::between::{Between, PartNormals, Parts};
use super::outline::Outline;
use super::taper::{Taper, is_beyond_ends, is_surely_beyond_ends};
use super::{ConvexShape, Scaled, Shape};
use cyltrace::math::UNIT_ROUNDOFF;
use cyltrace::solid::{Caps, Part};
use cyltrace_oracle::ExactVector;

/// Disks about one or two points, across an axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disks {
    pub ends: [(DVec3, f64); 2],
    /// The vector between the ends; of a flat disk a normal of any length.
    pub axis: DVec3,
    pub caps: Caps,
}

impl Disks {
    pub fn between(ends: [(DVec3, f64); 2], caps: Caps) -> Self {
        let axis = ends[1].0 - ends[0].0;
        Self { ends, axis, caps }
    }

    pub fn flat(center: DVec3, radius: f64, normal: DVec3) -> Self {
        Self {
            ends: [(center, radius); 2],
            axis: normal,
            caps: Caps::Both,
        }
    }

    pub fn is_flat(&self) -> bool {
        self.ends[0].0 == self.ends[1].0
    }

    pub fn radii(&self) -> [f64; 2] {
        self.ends.map(|(_, radius)| radius)
    }

    pub fn unit(&self) -> DVec3 {
        self.axis.normalize()
    }

    pub fn with_radii_scaled(&self, scale: f64) -> Self {
        let ends = self.ends.map(|(end, radius)| (end, scale * radius));
        Self { ends, ..*self }
    }

    pub fn open_ends(&self) -> [(DVec3, bool); 2] {
        let [(p0, radius0), (p1, radius1)] = self.ends;
        [
            (p0, !self.caps.at_p0() && radius0 > 0.0),
            (p1, !self.caps.at_p1() && radius1 > 0.0),
        ]
    }

    pub fn surface_distance(&self, point: DVec3) -> f64 {
        if self.is_flat() {
            return self.depth(point).abs();
        }
        self.section(point).distance(self.caps)
    }

    fn taper(&self) -> Taper {
        Taper {
            ends: self.ends,
            touches_balls: false,
        }
    }

    /// All points within a distance of a flat disk, and a few more.
    fn coin(&self, reach: f64) -> Self {
        let up = self.unit() * reach;
        let (center, radius) = self.ends[0];
        let ends = [center - up, center + up].map(|end| (end, radius + reach));
        Self::between(ends, Caps::Both)
    }

    fn section(&self, point: DVec3) -> Section {
        let [(p0, radius0), (p1, radius1)] = self.ends;
        let length = (p1 - p0).length();
        let point = seen((p1 - p0) / length, point - p0);
        let rims = [DVec2::new(0.0, radius0), DVec2::new(length, radius1)];
        Section { point, rims }
    }

    /// The length of the axis and the slope of the wall.
    fn slope(&self) -> (f64, f64) {
        let [radius0, radius1] = self.radii();
        let length = self.axis.length();
        (length, (radius1 - radius0) / length)
    }
}

impl ConvexShape for Disks {
    fn end_points(&self) -> [DVec3; 2] {
        self.ends.map(|(end, _)| end)
    }

    fn axis(&self) -> DVec3 {
        self.axis
    }

    fn at_origin(&self) -> Shape {
        let start = self.ends[0].0;
        Shape::Disks(Self {
            ends: self.ends.map(|(end, radius)| (end - start, radius)),
            caps: Caps::Both,
            ..*self
        })
    }

    fn displaced(&self, outward: f64) -> Option<Shape> {
        if self.is_flat() {
            return (outward > 0.0).then(|| Shape::Disks(self.coin(outward)));
        }
        let [(mut p0, mut radius0), (mut p1, mut radius1)] = self.ends;
        let unit = self.unit();
        let (_, slope) = self.slope();
        let root = libm::hypot(1.0, slope);
        // One of the two differs from the other's reciprocal by its sign alone.
        let [at_p0, at_p1] = if slope > 0.0 {
            [1.0 / (root + slope), root + slope]
        } else {
            [root - slope, 1.0 / (root - slope)]
        };
        radius0 += outward * at_p0;
        radius1 += outward * at_p1;
        p0 -= unit * outward;
        p1 += unit * outward;
        if radius0 < 0.0 {
            p0 -= unit * (radius0 / slope);
            radius0 = 0.0;
        } else if radius1 < 0.0 {
            p1 -= unit * (radius1 / slope);
            radius1 = 0.0;
        }
        let ends = [(p0, radius0), (p1, radius1)];
        let is_left = (p1 - p0).dot(self.axis) > 0.0;
        is_left.then(|| Shape::Disks(Self::between(ends, Caps::Both)))
    }

    /// The ball about the middle of the axis that touches a cone's wall has the radius
    /// there times the cosine of the slope, at least a quarter of the
    /// greater radius or of the length.
    fn half_width(&self) -> f64 {
        let [radius0, radius1] = self.radii();
        let length = (self.ends[1].0 - self.ends[0].0).length();
        if self.is_flat() {
            radius0
        } else if radius0 == radius1 {
            radius0.min(length / 2.0)
        } else {
            0.25 * radius0.max(radius1).min(length)
        }
    }

    fn unit_length(&self) -> f64 {
        let [radius0, radius1] = self.radii();
        if radius0 == radius1 {
            radius0
        } else {
            self.half_width()
        }
    }

    fn surely_contains(&self, y: DVec3, error: f64) -> bool {
        self.taper().surely_contains(y, error)
    }

    fn is_surely_beyond(&self, y: DVec3, error: f64, m: DVec3) -> bool {
        let width = m.cross(self.axis).length() / self.axis.length();
        is_surely_beyond_ends(&self.ends, (y, error), m, width)
    }

    fn contains(&self, x: &Scaled) -> bool {
        self.taper().contains(x)
    }

    fn is_beyond(&self, x: &Scaled, m: DVec3) -> bool {
        let (m, axis) = (ExactVector::new(m), ExactVector::new(self.axis));
        let axis = match self.is_flat() {
            true => axis,
            false => &ExactVector::new(self.ends[1].0) - &ExactVector::new(self.ends[0].0),
        };
        let across = m.cross(&axis);
        let width = (&across.dot(&across), &axis.dot(&axis));
        is_beyond_ends(&self.ends, x, &m, width)
    }

    fn depth(&self, point: DVec3) -> f64 {
        if self.is_flat() {
            let (center, radius) = self.ends[0];
            let seen = seen(self.unit(), point - center);
            return -libm::hypot(seen.x, (seen.y - radius).max(0.0));
        }
        self.section(point).depth()
    }

    fn add_parts(&self, between: &Between, parts: &mut Parts) {
        if self.is_flat() {
            let normal = self.axis;
            if between.reaches(normal, 0.0) && between.reaches(-normal, 0.0) {
                parts.push((Part::Side, PartNormals::flat(normal)));
            }
            return;
        }
        let [radius0, radius1] = self.radii();
        let (length, slope) = self.slope();
        let unit = self.axis / length;
        if self.caps.at_p0() && between.reaches(-unit, 0.0) {
            parts.push((Part::Cap0, PartNormals::flat(-unit)));
        }
        if self.caps.at_p1() && between.reaches(unit, length) {
            parts.push((Part::Cap1, PartNormals::flat(unit)));
        }
        let ends = between.off(unit);
        let slack = between.slack() * (1.0 + slope.abs())
            + 4.0 * UNIT_ROUNDOFF * (radius0 + radius1 + slope.abs() * length);
        let reaches = ends
            .iter()
            .any(|end| end.distance >= radius0 + slope * end.height - slack);
        if reaches {
            parts.push((Part::Side, between.wall(&ends, unit, slope)));
        }
    }

    fn outline(&self) -> Outline {
        let (bottom, radii) = (self.ends[0].0, self.radii());
        if self.is_flat() {
            return Outline::about(bottom, self.unit(), 0.0, radii);
        }
        let length = self.axis.length();
        Outline::about(bottom, self.axis / length, length, radii)
    }

    fn wall(&self, outline: &Outline, height: f64, outward: DVec3) -> (f64, DVec3) {
        let [radius0, radius1] = self.radii();
        if radius0 == radius1 {
            return (radius0, outward);
        }
        let slope = (radius1 - radius0) / outline.length;
        let normal = (outward - outline.axis * slope).normalize();
        (radius0 + slope * height, normal)
    }
}

/// A vector from a point of a unit axis as its height along the axis and its distance from it.
fn seen(axis: DVec3, from_axis: DVec3) -> DVec2 {
    let height = from_axis.dot(axis);
    DVec2::new(height, (from_axis - axis * height).length())
}

/// A point in the half plane of the axis, as `(y, ρ)`, and the rims there.
struct Section {
    point: DVec2,
    rims: [DVec2; 2],
}

impl Section {
    fn depth(&self) -> f64 {
        let [rim0, rim1] = self.rims;
        let wall = rim1 - rim0;
        let below_wall = wall.perp_dot(rim0 - self.point) / wall.length();
        let inside = below_wall.min(self.point.x).min(rim1.x - self.point.x);
        if inside >= 0.0 {
            return inside;
        }
        -self.distance(Caps::Both)
    }

    fn distance(&self, caps: Caps) -> f64 {
        let [rim0, rim1] = self.rims;
        let mut nearest = self.to_segment(rim0, rim1);
        for (is_closed, rim) in [(caps.at_p0(), rim0), (caps.at_p1(), rim1)] {
            if is_closed {
                nearest = nearest.min(self.to_segment(rim.with_y(0.0), rim));
            }
        }
        nearest
    }

    fn to_segment(&self, start: DVec2, end: DVec2) -> f64 {
        let (way, from_start) = (end - start, self.point - start);
        let squared = way.length_squared();
        // The disk of an apex is a point.
        let share = if squared > 0.0 {
            (from_start.dot(way) / squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (from_start - way * share).length()
    }
}
