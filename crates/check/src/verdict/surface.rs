//! The parts and the normals that an answer may name.
//!
//! The solid's first hit is between two parameters. In the
//! solid's own space the ray is `q + t d` from its anchor. `solids::between` bounds the parts
//! that the ray may hit between two of its points, and their normals, which the inverse
//! transpose takes to the world. With `n1`, `n2` those at the
//! ends and `A` the angle between them, the true one is within `A` of both, and the bound of
//! `between` for the normals in between.
//!
//! *Rounding.* A point at distance `D = |o - T| + |t d|` from the placement's
//! origin is displaced by at most `inverse_error D` in the world
//! (`math::placement`), and by one rounding of the composed placement's
//! entries, `u κ D` more; the placement shrinks no vector by more than `shrink`.
//! Subtracting the anchor `p` rounds by `2 u` of its size and of the difference. So a point of
//! the solid's space is right within
//! `δ = (inverse_error + u κ) D / shrink + 2 u (|p| + |q|)`, doubled here, and the
//! direction of a vector `v` from the axis within `2 δ / |v|`, which the
//! placement turns into at most `κ` times that.
//!
//! *Compositions.* A ray may hit any leaf, with the leaf's own parts. The normals of a
//! subtracted leaf point into it, those of others out of it, unless faces of several leaves
//! coincide: then the composition may be on the other side of a leaf, and
//! the normal is another leaf's. So the part and the normal of an answer may be those of
//! two leaves, if the ray may hit both.

use glam::DVec3;

use cyltrace::math::{ChildFromParent, PlacementErrors, Ray, UNIT_ROUNDOFF};
use cyltrace::solid::tessellation::{Fit, deviation_of};
use cyltrace::solid::{AnySolid, Part};

use crate::bounding_meshes::window::{PlacedSolid, Window};
use crate::solids::between::{Between, PartNormals, Parts, angle};
use crate::solids::shape;

/// The allowed error of a normal beyond the derived bound, so that f32 normals are right.
const NORMAL_SLACK: f64 = 1e-3;

/// A ray in the space of one solid.
pub(crate) struct LocalRay<'a> {
    solid: &'a AnySolid,
    back: ChildFromParent,
    /// From the anchor to the ray's origin.
    origin: DVec3,
    direction: DVec3,
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

/// What is wrong with the part and the normal that an answer names for a solid of a
/// window, given by its first leaf, whose first hit is between `low` and `high`.
pub(crate) fn wrong_surface(
    window: &Window,
    solid: u32,
    ray: &Ray,
    (low, high): (f64, f64),
    part: Option<Part>,
    normal: Option<DVec3>,
) -> Option<WrongSurface> {
    let composition = window.composition_of(solid);
    let operands = composition.map(|found| found.composition.operands());
    let leaves: Vec<_> = window.leaves_with(solid).zip(0..).collect();
    // The first leaf that allows both, or leaves that allow them together.
    let judge = |part: Option<Part>, normal: Option<DVec3>| {
        let mut wrong = Some(WrongSurface::Part);
        for &(leaf, position) in &leaves {
            let is_subtracted = operands
                .as_ref()
                .is_some_and(|operands| operands[position].is_subtracted);
            let normal = normal.map(|normal| if is_subtracted { -normal } else { normal });
            let local = LocalRay::new(&window.solids[leaf as usize], ray);
            match local.wrong_surface(low, high, part, normal) {
                None => return None,
                Some(WrongSurface::Part) => {}
                found => wrong = found,
            }
        }
        wrong
    };
    let wrong = judge(part, normal)?;
    let is_shared =
        leaves.len() > 1 && judge(part, None).is_none() && judge(None, normal).is_none();
    (!is_shared).then_some(wrong)
}

impl<'a> LocalRay<'a> {
    /// The ray in the solid's space.
    pub fn new(placed: &'a PlacedSolid, ray: &Ray) -> Self {
        let placement = &placed.frame.world_from_object;
        let back = ChildFromParent::new(placement);
        let errors = PlacementErrors::new(placement, &back);
        let anchor = placed.solid.anchor();
        let from_placement = ray.origin - back.translation();
        let origin = back.vector(from_placement) - anchor;
        let direction = back.vector(ray.direction);
        let relative = (errors.inverse_error + UNIT_ROUNDOFF * errors.condition) / errors.shrink;
        let rounding = [
            relative * from_placement.length()
                + 2.0 * UNIT_ROUNDOFF * (anchor.length() + origin.length()),
            relative * ray.direction.length() + 2.0 * UNIT_ROUNDOFF * direction.length(),
        ];
        Self {
            solid: &placed.solid,
            back,
            origin,
            direction,
            condition: errors.condition,
            rounding: rounding.map(|x| 2.0 * x),
        }
    }

    fn rounding(&self, t: f64) -> f64 {
        self.rounding[0] + self.rounding[1] * t.abs()
    }

    /// `δ` at the point of the solid that is farthest from the ray's origin.
    pub fn rounding_at_solid(&self) -> f64 {
        let distance = self.origin.length() + self.solid.size();
        self.rounding(distance / self.direction.length())
    }

    /// The point at a parameter, from the anchor.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    fn wrong_surface(
        &self,
        low: f64,
        high: f64,
        part: Option<Part>,
        normal: Option<DVec3>,
    ) -> Option<WrongSurface> {
        let between = Between {
            low: self.at(low),
            high: self.at(high),
            rounding: [self.rounding(low), self.rounding(high)],
        };
        let mut least_angle = f64::INFINITY;
        let mut is_possible = false;
        for (one, normals) in self.parts(&between) {
            if part.is_some_and(|part| part != one) {
                continue;
            }
            is_possible = true;
            let excess = normal.map_or(0.0, |normal| self.excess_angle(&normals, normal));
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

    fn parts(&self, between: &Between) -> Parts {
        let mut parts = Parts::new();
        shape(self.solid).get().add_parts(between, &mut parts);
        parts
    }

    /// By how much a normal is off beyond what is allowed; 0 or less if it is right.
    fn excess_angle(&self, normals: &PartNormals, normal: DVec3) -> f64 {
        if !((normal.length() - 1.0).abs() <= NORMAL_SLACK) {
            return f64::INFINITY;
        }
        let [one, other] = normals.ends.map(|object| self.back.parent_normal(object));
        let rounding = 16.0 * UNIT_ROUNDOFF * self.condition + self.condition * normals.turned;
        let allowed = angle(one, other) + rounding + NORMAL_SLACK;
        let excess = angle(normal, one).max(angle(normal, other)) - allowed;
        if excess.is_nan() { 0.0 } else { excess }
    }

    /// The length of `dt` of the ray in radii, or half widths.
    pub fn radii(&self, dt: f64) -> f64 {
        dt * self.direction.length() / shape(self.solid).get().unit_length()
    }

    /// The depth of `dt` below the tangent plane at the point of `part` at `t`, in units of the
    /// deviation of an inscribed mesh; `None` on a flat part.
    pub fn sagittas(&self, t: f64, dt: f64, part: Part, segments: u32) -> Option<f64> {
        let here = self.at(t);
        // The part is known, so the point may be anywhere beside it.
        let between = Between {
            low: here,
            high: here,
            rounding: [self.solid.size(); 2],
        };
        let parts = self.parts(&between).into_iter();
        let mut curved = parts.filter(|(one, normals)| *one == part && normals.is_curved);
        let normal = curved.next()?.1.ends[0];
        let depth = dt * (self.direction.dot(normal) / normal.length()).abs();
        Some(depth / deviation_of(self.solid, segments, Fit::Inscribed))
    }
}
