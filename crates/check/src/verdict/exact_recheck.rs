//! Exact crossings of suspects.
//!
//! The ray and the vertices of the meshes are f32 numbers, so signs of polynomials in them,
//! which exact arithmetic computes without rounding, decide whether the ray
//! crosses a triangle and where. With the corners `a`, `b`, `c` seen
//! from the origin and the direction `d`, the *signed volumes*
//!
//! ```text
//! d·(a × b)    d·(b × c)    d·(c × a)
//! ```
//!
//! state the side of each edge on which the line passes. It crosses the closed triangle
//! if no two have opposite signs; edges and corners count for
//! every triangle that has them, so nothing passes between neighbors. With
//! `N = (b - a) × (c - a)` the parameter is `a·N / d·N`; if `d·N` is 0 the ray
//! is in the plane and crosses the mesh at other triangles too.
//!
//! The line misses most triangles by far: in f64 the differences of the corners to
//! the origin have relative error u, a cross product 3 u of the sum of its
//! terms' sizes, and the volume as a whole at most 8 u of
//! `|d|·(|a| × |b|)` with all signs plus. Two volumes beyond 16 u of theirs, with
//! opposite signs, decide.
//!
//! The resulting bounds are rounded so that comparing them with an f64
//! decides as the exact number would: a lower bound to the least f64 that is not
//! below it, an upper one to the greatest that is not above. For a composition the
//! parameters are ends of sets (`composed`), and rounding must not decide whether two of these
//! have a point in common: the ends of surely inside are rounded inward, those of
//! perhaps inside outward.

use glam::DVec3;

use cyltrace::embree::Ray32;
use cyltrace::math::{Ray, UNIT_ROUNDOFF};
use cyltrace_oracle::{Exact, ExactVector, exact, to_f64};

use super::seen::{Seen, bounds};
use crate::bounding_meshes::crossings::{Crossings, LeafCrossings};
use crate::bounding_meshes::hull::wide;
use crate::bounding_meshes::meshes::{Meshes, may_meet};

/// Bits of the quotient from which a parameter is rounded.
const QUOTIENT_BITS: usize = 256;

/// The exact parameter of a crossing, `numerator / denominator`.
#[derive(Clone, Debug)]
struct Fraction {
    numerator: Exact,
    /// Positive.
    denominator: Exact,
}

impl Fraction {
    fn is_before(&self, other: &Self) -> bool {
        &self.numerator * &other.denominator < &other.numerator * &self.denominator
    }

    fn is_before_f64(&self, t: f64) -> bool {
        self.numerator < exact(t) * &self.denominator
    }

    /// The f64 nearest to it, or one beside it.
    fn near(&self) -> f64 {
        let long = |x: &Exact| x.clone().with_precision(QUOTIENT_BITS).value();
        to_f64(&(long(&self.numerator) / long(&self.denominator)))
    }

    /// The least f64 that is not below it.
    fn rounded_up(&self) -> f64 {
        let near = self.near();
        if exact(near) * &self.denominator < self.numerator {
            near.next_up()
        } else {
            near
        }
    }

    /// The greatest f64 that is not above it.
    fn rounded_down(&self) -> f64 {
        let near = self.near();
        if self.is_before_f64(near) {
            near.next_down()
        } else {
            near
        }
    }
}

/// The exact crossings of one mesh.
#[derive(Default)]
struct ExactCrossings {
    enter: Option<Fraction>,
    leave: Option<Fraction>,
    last_leave: Option<Fraction>,
}

impl ExactCrossings {
    fn add(&mut self, t: Fraction, enters: bool) {
        let replace = |place: &mut Option<Fraction>, is_better: &dyn Fn(&Fraction) -> bool| {
            if place.as_ref().is_none_or(is_better) {
                *place = Some(t.clone());
            }
        };
        if enters {
            replace(&mut self.enter, &|old| t.is_before(old));
        } else {
            replace(&mut self.leave, &|old| t.is_before(old));
            replace(&mut self.last_leave, &|old| old.is_before(&t));
        }
    }

    /// As numbers, with flags for whether entries and exits are rounded up.
    fn rounded(&self, [is_in_up, is_out_up]: [bool; 2]) -> Crossings {
        let round = |t: &Fraction, up: bool| {
            if up { t.rounded_up() } else { t.rounded_down() }
        };
        let mut crossings = Crossings::NONE;
        if let Some(t) = &self.enter {
            crossings.enter = round(t, is_in_up);
        }
        if let (Some(leave), Some(last)) = (&self.leave, &self.last_leave) {
            crossings.leave = round(leave, is_out_up);
            crossings.last_leave = round(last, is_out_up);
            // Rounding keeps which one is first, or that neither is. An exit that
            // comes second may round to the first entry, which claims less.
            match &self.enter {
                Some(enter) if enter.is_before(leave) => {
                    crossings.leave = crossings.leave.max(crossings.enter);
                }
                Some(enter) if !leave.is_before(enter) => crossings.leave = crossings.enter,
                _ => crossings.leave = crossings.leave.min(crossings.enter.next_down()),
            }
        }
        crossings
    }
}

/// The crossings of a leaf of a composition.
fn as_sets(outer: &ExactCrossings, inner: &ExactCrossings) -> LeafCrossings {
    LeafCrossings {
        outer: outer.rounded([false, true]),
        inner: inner.rounded([true, false]),
    }
}

/// The exact bounds of every solid that the ray may hit.
pub(crate) fn exact_seen(meshes: &Meshes, ray32: &Ray32, ray: &Ray) -> Vec<Seen> {
    let line = Line::new(ray32);
    let mut seen = Vec::new();
    for leaves in meshes.leaves() {
        let mut boxes = meshes.boxes[leaves.start as usize..leaves.end as usize].iter();
        if !boxes.any(|bounds| may_meet(bounds, ray)) {
            continue;
        }
        let is_composed = meshes.is_composed(leaves.start);
        let crossings: Vec<LeafCrossings> = leaves
            .clone()
            .map(|leaf| {
                let [outer, inner] = meshes.triangles(leaf);
                let outer = line.crossings(outer);
                if meshes.is_disk(leaf) {
                    LeafCrossings {
                        outer: outer.rounded([true, false]),
                        inner: line.sheet_crossings(inner).rounded([false, false]),
                    }
                } else if is_composed {
                    as_sets(&outer, &line.crossings(inner))
                } else {
                    LeafCrossings {
                        outer: outer.rounded([true, false]),
                        inner: line.crossings(inner).rounded([false, true]),
                    }
                }
            })
            .collect();
        let is_crossed = |leaf: &LeafCrossings| [leaf.outer, leaf.inner] != [Crossings::NONE; 2];
        if crossings.iter().any(is_crossed) {
            let solid = leaves.start;
            let bounds = bounds(meshes, solid, ray32, &crossings);
            seen.push(Seen { solid, bounds });
        }
    }
    seen
}

struct Line {
    origin: DVec3,
    direction: DVec3,
    t_min: f64,
    exact_origin: ExactVector,
    exact_direction: ExactVector,
}

impl Line {
    fn new(ray: &Ray32) -> Self {
        let (origin, direction) = (wide(ray.origin), wide(ray.direction));
        Self {
            origin,
            direction,
            t_min: f64::from(ray.t_near),
            exact_origin: ExactVector::new(origin),
            exact_direction: ExactVector::new(direction),
        }
    }

    fn crossings(&self, triangles: impl Iterator<Item = [DVec3; 3]>) -> ExactCrossings {
        let mut crossings = ExactCrossings::default();
        for corners in triangles {
            if let Some((t, enters)) = self.crossing(corners) {
                crossings.add(t, enters);
            }
        }
        crossings
    }

    /// The crossings of the upper sheet of a disk, as entries, and of the lower one, as exits.
    fn sheet_crossings(&self, triangles: impl Iterator<Item = [DVec3; 3]>) -> ExactCrossings {
        let triangles: Vec<_> = triangles.collect();
        let (over, under) = triangles.split_at(triangles.len() / 2);
        let mut crossings = ExactCrossings::default();
        for (sheet, is_over) in [(over, true), (under, false)] {
            for (t, _) in sheet.iter().filter_map(|&corners| self.crossing(corners)) {
                crossings.add(t, is_over);
            }
        }
        crossings
    }

    /// Where the line crosses a closed triangle at or after its start, and
    /// whether it enters.
    fn crossing(&self, corners: [DVec3; 3]) -> Option<(Fraction, bool)> {
        if self.is_certain_miss(corners) {
            return None;
        }
        let [a, b, c] = corners.map(|corner| &ExactVector::new(corner) - &self.exact_origin);
        let d = &self.exact_direction;
        let zero = exact(0.0);
        let volumes = [(&a, &b), (&b, &c), (&c, &a)].map(|(one, other)| d.dot(&one.cross(other)));
        if volumes.iter().any(|v| *v < zero) && volumes.iter().any(|v| *v > zero) {
            return None;
        }
        let normal = (&b - &a).cross(&(&c - &a));
        let along = d.dot(&normal);
        if along == zero {
            return None;
        }
        let enters = along < zero;
        let height = a.dot(&normal);
        let t = if enters {
            Fraction {
                numerator: -height,
                denominator: -along,
            }
        } else {
            Fraction {
                numerator: height,
                denominator: along,
            }
        };
        (!t.is_before_f64(self.t_min)).then_some((t, enters))
    }

    fn is_certain_miss(&self, corners: [DVec3; 3]) -> bool {
        let [a, b, c] = corners.map(|corner| corner - self.origin);
        let (mut is_left, mut is_right) = (false, false);
        for (one, other) in [(a, b), (b, c), (c, a)] {
            let volume = self.direction.dot(one.cross(other));
            let (one, other) = (one.abs(), other.abs());
            let size = self.direction.abs().dot(glam::DVec3::new(
                one.y * other.z + one.z * other.y,
                one.z * other.x + one.x * other.z,
                one.x * other.y + one.y * other.x,
            ));
            is_left |= volume > 16.0 * UNIT_ROUNDOFF * size;
            is_right |= volume < -16.0 * UNIT_ROUNDOFF * size;
        }
        is_left && is_right
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verdict::composed::composed_bounds;
    use cyltrace::solid::{Composition, Sphere};

    const ULP: f64 = f64::EPSILON;

    /// `1 + tenths ulp / 10`.
    fn beside_one(tenths: f64) -> Fraction {
        Fraction {
            numerator: exact(10.0) + exact(tenths * ULP),
            denominator: exact(10.0),
        }
    }

    fn from_to(enter: Fraction, leave: Fraction) -> ExactCrossings {
        let mut crossings = ExactCrossings::default();
        crossings.add(enter, true);
        crossings.add(leave, false);
        crossings
    }

    /// The line leaves one leaf and enters the other between two
    /// neighbors of f64: their intersection is empty or not, as for the exact numbers.
    #[test]
    fn rounding_makes_no_common_points_and_loses_none() {
        let solid = || Composition::Solid(Sphere::new(DVec3::ZERO, 1.0).unwrap().into());
        let common = Composition::Intersection(vec![solid(), solid()]);
        let at = |t: f64| Fraction {
            numerator: exact(t),
            denominator: exact(1.0),
        };
        let bounds = |leave: f64, enter: f64| {
            let first = [
                from_to(at(0.25), beside_one(leave)),
                from_to(at(0.5), beside_one(leave)),
            ];
            let second = [
                from_to(beside_one(enter), at(3.0)),
                from_to(beside_one(enter), at(2.0)),
            ];
            let leaves = [first, second].map(|[outer, inner]| as_sets(&outer, &inner));
            composed_bounds(&common, &leaves, 0.0).interval
        };
        assert_eq!(bounds(3.0, 6.0).high, f64::INFINITY);
        assert_eq!(bounds(6.0, 3.0).low, 1.0);
    }

    /// An entry and an exit at a parameter that is no f64.
    #[test]
    fn edge_between_neighbors_of_f64_stays_one() {
        let mut fold = from_to(beside_one(4.0), beside_one(4.0));
        fold.add(beside_one(30.0), false);
        for rounding in [[false, true], [true, false], [true, true], [false, false]] {
            let crossings = fold.rounded(rounding);
            assert!(crossings.may_start_inside(), "{crossings:?}");
            assert!(!crossings.starts_inside(), "{crossings:?}");
        }
    }
}
