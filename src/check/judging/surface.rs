//! Which part of a solid and which normal an answer may name.
//!
//! The bounds say that the solid's first hit is between two parameters. In the
//! solid's own space the ray is `q + t d` from `p0`, its height along the
//! axis is linear in `t` and so is its vector from the axis:
//!
//! - A disc can be what is hit only if the heights over the range reach it.
//! - The wall can be only if the distance from the axis, which is convex in `t`,
//!   reaches the radius at one of the ends.
//! - The wall's normal at `t` is the vector from the axis, taken to the world
//!   by the inverse transposed. As `t` runs through the range it stays in one
//!   plane and turns monotonically. With `n1`, `n2` those at the ends and `A`
//!   the angle between them, the true one is within `A` of both.
//!
//! *Rounding.* A point at distance `D = |o - T| + |t d|` from the placement's
//! origin is displaced by at most `inverse_error D` in the world
//! (`math::placement`), and by one rounding of the composed placement's
//! entries, `u κ D` more; the placement shrinks no vector by more than `shrink`.
//! Taking `p0` away costs `2 u` of its size and of the difference. So a point of
//! the solid's space is right within
//! `δ = (inverse_error + u κ) D / shrink + 2 u (|p0| + |q|)`, doubled here, and the
//! direction of a vector `v` from the axis within `2 δ / |v|`, which the
//! placement turns into at most `κ` times that.

use glam::DVec3;

use crate::math::{ChildFromParent, PlacementErrors, Ray, UNIT_ROUNDOFF};
use crate::solid::{Part, tessellation};

use crate::check::prisms::placed::PlacedSolid;

/// What a normal may be off by beyond what is derived: intersectors that shade
/// with f32 normals are welcome.
const NORMAL_SLACK: f64 = 1e-3;

/// A ray in the space of one solid.
pub(crate) struct LocalRay<'a> {
    solid: &'a PlacedSolid,
    back: ChildFromParent,
    /// From `p0` to the ray's origin.
    origin: DVec3,
    direction: DVec3,
    /// Unit vector from `p0` to `p1`.
    axis: DVec3,
    length: f64,
    condition: f64,
    /// `δ` at a parameter: a constant and what each unit of `|t|` adds.
    rounding: [f64; 2],
}

/// A wrong part or normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum WrongSurface {
    /// The part cannot be what is hit.
    Part,
    /// The normal is off by this angle from what it can be, or is no unit vector.
    Normal(f64),
}

impl<'a> LocalRay<'a> {
    /// The ray as the solid sees it.
    pub fn new(solid: &'a PlacedSolid, ray: &Ray) -> Self {
        let placement = &solid.frame.world_from_object;
        let back = ChildFromParent::new(placement);
        let errors = PlacementErrors::new(placement, &back);
        let (p0, p1) = (solid.cylinder.p0(), solid.cylinder.p1());
        let from_placement = ray.origin - back.translation();
        let origin = back.vector(from_placement) - p0;
        let direction = back.vector(ray.direction);
        let relative = (errors.inverse_error + UNIT_ROUNDOFF * errors.condition) / errors.shrink;
        let rounding = [
            relative * from_placement.length()
                + 2.0 * UNIT_ROUNDOFF * (p0.length() + origin.length()),
            relative * ray.direction.length() + 2.0 * UNIT_ROUNDOFF * direction.length(),
        ];
        Self {
            solid,
            back,
            origin,
            direction,
            axis: (p1 - p0).normalize(),
            length: (p1 - p0).length(),
            condition: errors.condition,
            rounding: rounding.map(|x| 2.0 * x),
        }
    }

    fn rounding(&self, t: f64) -> f64 {
        self.rounding[0] + self.rounding[1] * t.abs()
    }

    /// `δ` at the point of the solid that is farthest from the ray's origin.
    pub fn rounding_at_solid(&self) -> f64 {
        let distance = self.origin.length() + self.length + self.solid.cylinder.radius();
        self.rounding(distance / self.direction.length())
    }

    /// The height above `p0` and the vector from the axis at a parameter.
    fn at(&self, t: f64) -> (f64, DVec3) {
        let point = self.origin + self.direction * t;
        let height = point.dot(self.axis);
        (height, point - self.axis * height)
    }

    /// Whether the point at a parameter is farther than `margin` from the planes
    /// of the discs that the solid does not have, on its side of them.
    pub fn is_between_ends(&self, t: f64, margin: f64) -> bool {
        let (height, _) = self.at(t);
        let caps = self.solid.cylinder.caps();
        (caps.at_p0() || height > margin) && (caps.at_p1() || height < self.length - margin)
    }

    /// What is wrong with the part and the normal that an answer names, for a
    /// first hit between `low` and `high`. Without a part, any part may be hit.
    pub fn wrong_surface(
        &self,
        low: f64,
        high: f64,
        part: Option<Part>,
        normal: Option<DVec3>,
    ) -> Option<WrongSurface> {
        let parts = [Part::Side, Part::Cap0, Part::Cap1];
        let named = parts
            .into_iter()
            .filter(|&one| part.is_none_or(|part| part == one));
        let mut least_angle = f64::INFINITY;
        let mut is_possible = false;
        for part in named.filter(|&part| self.may_be_hit(part, low, high)) {
            is_possible = true;
            let excess = normal.map_or(0.0, |normal| self.excess_angle(part, low, high, normal));
            least_angle = least_angle.min(excess);
        }
        if !is_possible {
            Some(WrongSurface::Part)
        } else if least_angle > 0.0 {
            Some(WrongSurface::Normal(least_angle))
        } else {
            None
        }
    }

    fn may_be_hit(&self, part: Part, low: f64, high: f64) -> bool {
        let rounding = self.rounding(low).max(self.rounding(high));
        let ((low_height, low_off), (high_height, high_off)) = (self.at(low), self.at(high));
        let cylinder = &self.solid.cylinder;
        match part {
            Part::Side => {
                let reach = low_off.length().max(high_off.length());
                reach >= cylinder.radius() * (1.0 - 4.0 * UNIT_ROUNDOFF) - rounding
            }
            Part::Cap0 => cylinder.caps().at_p0() && low_height.min(high_height) <= rounding,
            Part::Cap1 => {
                let rounding = rounding + 4.0 * UNIT_ROUNDOFF * self.length;
                cylinder.caps().at_p1() && low_height.max(high_height) >= self.length - rounding
            }
            part => part.not_of_a_cylinder(),
        }
    }

    /// By how much a normal is off from what it may be; 0 or less if it isn't.
    fn excess_angle(&self, part: Part, low: f64, high: f64, normal: DVec3) -> f64 {
        if !((normal.length() - 1.0).abs() <= NORMAL_SLACK) {
            return f64::INFINITY;
        }
        let world = |object| self.back.parent_normal(object);
        let rounding = 16.0 * UNIT_ROUNDOFF * self.condition;
        let (one, other, rounding) = match part {
            Part::Cap0 => (world(-self.axis), world(-self.axis), rounding),
            Part::Cap1 => (world(self.axis), world(self.axis), rounding),
            Part::Side => {
                let ((_, low_off), (_, high_off)) = (self.at(low), self.at(high));
                let turned = |off: DVec3, t| 2.0 * self.rounding(t) / off.length();
                let turned = turned(low_off, low) + turned(high_off, high);
                let rounding = rounding + self.condition * turned;
                (world(low_off), world(high_off), rounding)
            }
            part => part.not_of_a_cylinder(),
        };
        let allowed = angle(one, other) + rounding + NORMAL_SLACK;
        let excess = angle(normal, one).max(angle(normal, other)) - allowed;
        if excess.is_nan() { 0.0 } else { excess }
    }

    /// The length of `dt` of the ray in radii.
    pub fn radii(&self, dt: f64) -> f64 {
        dt * self.direction.length() / self.solid.cylinder.radius()
    }

    /// The depth below the wall's tangent plane at `t` that `dt` makes, in units
    /// of the sagitta of a prism; `None` if the wall is not what is hit at `t`.
    pub fn sagittas(&self, t: f64, dt: f64, part: Option<Part>, segments: u32) -> Option<f64> {
        let (height, off) = self.at(t);
        let is_wall = match part {
            Some(part) => part == Part::Side,
            None => height > 0.0 && height < self.length,
        };
        let depth = dt * (self.direction.dot(off) / off.length()).abs();
        is_wall.then(|| depth / tessellation::sagitta(&self.solid.cylinder, segments))
    }
}

/// The angle between two vectors, without loss when it is small.
fn angle(one: DVec3, other: DVec3) -> f64 {
    libm::atan2(one.cross(other).length(), one.dot(other))
}
