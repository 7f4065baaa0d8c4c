//! How near points and rays come to the surface of placed solids, with bounds.
//!
//! Distances and depths are those of the solid's own space (`solids`). With `M` the linear part
//! of `world_from_object`, a length `δ` in the world is at most `|M⁻¹| δ` there, and a
//! length there at most `|M|` times as much in the world. The spectral norms are
//! bounded from above by `|A|² ≤ max row sum of |AᵀA|`, which is equality for a
//! uniformly scaled rotation, and at most √3 too much otherwise.
//!
//! A ray is deeper than `δ` in a solid where it is in the solid shrunk by `δ`. Outside, the
//! distance counts, because a grown solid has sharp rims. It is greatest at an end, since the
//! depth is concave along a ray. A disk has no inside: a ray crosses
//! it if it goes from one side of the slab of half thickness `δ` about its plane
//! to the other, and is nearer to the axis than the rim by `δ` all the way in between.
//!
//! The mesh of a solid lies between an inner and an outer one (`deviation`). A ray crosses it if
//! it goes from outside of the outer one to inside of the inner one, by `δ` each. It crosses a
//! disk within the rim of the inner one.
//!
//! The rounding of f64 is below `64 ε |M| |M⁻¹|` of the lengths that
//! are added; it is added to `δ`.

use glam::{DAffine3, DMat3, DVec3};

use super::depth::depth_in_composed;
use super::tolerance::Margin;
use crate::solids::{Shape, checked, shape};
use cyltrace::math::{Ray, power_of_two_below};
use cyltrace::solid::{AnySolid, Composition};

/// See the head of this file.
pub(super) const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A solid's own space.
pub(super) struct Frame {
    object_from_world: DAffine3,
    /// The bound of `|M|`.
    stretch: f64,
    /// The bound of `|M⁻¹|`.
    squeeze: f64,
    translation: f64,
}

impl Frame {
    pub fn new(world_from_object: &DAffine3) -> Self {
        let object_from_world = world_from_object.inverse();
        Self {
            object_from_world,
            stretch: norm_bound(&world_from_object.matrix3),
            squeeze: norm_bound(&object_from_world.matrix3),
            translation: world_from_object.translation.length(),
        }
    }

    /// At least the length there of `length` around a point of the world, with the rounding.
    /// The solid's own numbers are at most of the size of `extent`.
    fn local_length(&self, length: f64, point: DVec3, extent: f64) -> f64 {
        let size = self.squeeze * (point.length() + self.translation) + extent;
        self.squeeze * length + ROUNDING * self.squeeze * self.stretch * size
    }

    /// At least what a margin is in the world.
    pub fn in_world(&self, margin: Margin) -> f64 {
        margin.length + self.stretch * margin.slack.greatest
    }

    /// At least what a length there is in the world.
    pub fn greatest_length(&self, length: f64) -> f64 {
        self.stretch * length
    }

    /// At most what a length there is in the world.
    pub fn least_length(&self, length: f64) -> f64 {
        length / self.squeeze
    }

    /// The ray there, between `start` and `end` and not farther from the
    /// middle of a solid than twice its `reach`, beyond which the ray is outside.
    fn way(&self, ray: &Ray, (start, end): (f64, f64), (middle, reach): (DVec3, f64)) -> Way {
        let origin = self.local(ray.origin);
        let direction = self.object_from_world.transform_vector3(ray.direction);
        let speed = direction.length();
        let nearest = (middle - origin).dot(direction) / (speed * speed);
        Way {
            origin,
            direction,
            low: start.max(nearest - 2.0 * reach / speed),
            high: end.min(nearest + 2.0 * reach / speed),
        }
    }

    fn local(&self, point: DVec3) -> DVec3 {
        self.object_from_world.transform_point3(point)
    }
}

/// A part of a ray in a solid's own space.
struct Way {
    origin: DVec3,
    direction: DVec3,
    low: f64,
    high: f64,
}

impl Way {
    fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// Whether it has a point in a closed solid.
    fn enters(&self, solid: &AnySolid) -> bool {
        let size = power_of_two_below(self.direction.abs().max_element());
        let from_anchor = self.origin - solid.anchor();
        let chord = solid.chord(from_anchor, self.direction / size);
        chord.is_some_and(|chord| {
            self.low <= chord.leave.t / size && chord.enter.t / size <= self.high
        })
    }

    /// Whether nothing is left of it; also if an end is NaN.
    fn is_empty(&self) -> bool {
        let is_ordered = self.low < self.high;
        !is_ordered
    }
}

/// A bound of the size of a solid's own numbers.
fn extent(solid: &AnySolid) -> f64 {
    2.0 * solid.anchor().length() + solid.size()
}

fn norm_bound(matrix: &DMat3) -> f64 {
    let square = matrix.transpose() * *matrix;
    let sums = square.x_axis.abs() + square.y_axis.abs() + square.z_axis.abs();
    libm::sqrt(sums.max_element())
}

impl Frame {
    /// Whether a point of the world is proven to be farther than a margin from
    /// the surface of a solid.
    pub fn is_far(&self, solid: &AnySolid, point: DVec3, margin: Margin) -> bool {
        let (shape, Margin { length, slack }) = (shape(solid), margin);
        let place = self.local(point);
        let length = self.local_length(length, point, extent(solid));
        shape.surface_distance(place) > length + slack.greatest
            || slack.inner(&shape).get().depth(place) > length + slack.inward
            || slack.outer(&shape).get().depth(place) < -(length + slack.outward)
    }

    /// As [`Frame::is_far`], with disks at open ends.
    pub fn is_far_from_closed(&self, solid: &AnySolid, point: DVec3, margin: Margin) -> bool {
        let length = self.local_length(margin.length, point, extent(solid));
        let depth = shape(solid).get().depth(self.local(point));
        depth.abs() > length + margin.slack.greatest
    }

    /// Whether a point of the world is proven to be within a margin of the surface.
    pub fn is_near(&self, solid: &AnySolid, point: DVec3, margin: Margin) -> bool {
        let distance = shape(solid).surface_distance(self.local(point));
        (distance - margin.slack.greatest) * self.stretch <= margin.length
    }

    /// Whether a ray is proven to pass through the surface in a range: from farther outside
    /// than a margin to farther inside than that, or the other way, and all the way
    /// farther than that from an open end.
    pub fn is_crossed(
        &self,
        solid: &AnySolid,
        ray: &Ray,
        range: (f64, f64),
        margin: Margin,
    ) -> bool {
        let length = self.local_length(margin.length, ray.origin, extent(solid));
        let slack = margin.slack;
        let own = shape(solid);
        let (inner, outer) = (slack.inner(&own), slack.outer(&own));
        let (inside, outside) = (length + slack.inward, length + slack.outward);
        let deep = inside.max(outside);
        let reach = slack.outer_scale * solid.size() + 4.0 * deep;
        let mut way = self.way(ray, range, (solid.center(), reach));
        for (end, inward) in own.open_ends() {
            // The end is far enough while room + slope t > 0.
            let room = (way.origin - end).dot(inward) - deep;
            let slope = way.direction.dot(inward);
            let border = -room / slope;
            match () {
                () if slope > 0.0 => way.low = way.low.max(border),
                () if slope < 0.0 => way.high = way.high.min(border),
                () if room <= 0.0 => return false,
                () => {}
            }
        }
        if way.is_empty() {
            return false;
        }
        if inner.flat().is_some() {
            return is_disk_crossed(&inner, &way, inside);
        }
        let outer_depth = |t: f64| outer.get().depth(way.at(t));
        if !(outer_depth(way.low).min(outer_depth(way.high)) < -outside) {
            return false;
        }
        let core = inner.get().displaced(-inside);
        let core = core.and_then(|core| checked(solid).with_shape(&core));
        core.is_some_and(|core| way.enters(&core))
    }

    /// As [`Frame::is_crossed`], for a composition. It is deepest at an unknown place: the
    /// depth is evaluated halfway between the `hits`, rising, of the ray with the
    /// solid. Wherever they are, a depth found there is a proof.
    pub fn is_composition_crossed(
        &self,
        solid: &Composition,
        ray: &Ray,
        range: (f64, f64),
        margin: Margin,
        hits: &[f64],
    ) -> bool {
        let bounds = solid.bounds();
        if bounds.is_empty() {
            return false;
        }
        let extents = solid.solids().iter().map(extent).fold(0.0, f64::max);
        let length = self.local_length(margin.length, ray.origin, extents);
        let deep = length + margin.slack.greatest;
        let reach = 0.5 * bounds.extent().length() + 4.0 * deep;
        let way = self.way(ray, range, (bounds.center(), reach));
        if way.is_empty() {
            return false;
        }
        let middles = hits.windows(2).map(|ends| 0.5 * (ends[0] + ends[1]));
        let middles = middles.filter(|t| (way.low..way.high).contains(t));
        let depths: Vec<f64> = middles
            .chain([way.low, way.high])
            .map(|t| depth_in_composed(solid, way.at(t)))
            .collect();
        depths.iter().any(|depth| *depth > deep) && depths.iter().any(|depth| *depth < -deep)
    }
}

/// Whether a part of a ray crosses a disk, farther than `deep` from its rim: see the head of
/// this file.
fn is_disk_crossed(disk: &Shape, way: &Way, deep: f64) -> bool {
    let Some((radius, up)) = disk.flat() else {
        return false;
    };
    let [center, _] = disk.get().end_points();
    let (start, end) = (way.at(way.low) - center, way.at(way.high) - center);
    let (from, to) = (start.dot(up), end.dot(up));
    // The ray at a height between those of its ends.
    let is_within = |at: f64| {
        let point = start + (end - start) * ((at - from) / (to - from));
        (point - up * point.dot(up)).length() - radius < -deep
    };
    // The distance from the axis is convex along the ray.
    from.abs() > deep
        && to.abs() > deep
        && (from < 0.0) != (to < 0.0)
        && is_within(deep)
        && is_within(-deep)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::external::deviation::Slack;
    use cyltrace::solid::Disk;

    #[test]
    fn disk_is_crossed_from_side_to_side_and_away_from_its_rim() {
        let disk = Disk::new(DVec3::ZERO, DVec3::Z * 2.0, 1.0).unwrap();
        let frame = Frame::new(&DAffine3::IDENTITY);
        let margin = Margin {
            length: 0.1,
            slack: Slack::NONE,
        };
        let is_crossed = |x: f64, direction: DVec3, range: (f64, f64)| {
            let ray = Ray::new(DVec3::new(x, 0.0, -5.0), direction);
            frame.is_crossed(&disk.into(), &ray, range, margin)
        };
        assert!(is_crossed(0.0, DVec3::Z, (0.0, 10.0)));
        assert!(is_crossed(0.85, DVec3::Z, (4.8, 5.2)));
        // Not to the other side, or not farther than 0.1 from it.
        for range in [(0.0, 4.0), (0.0, 5.05), (4.95, 10.0), (6.0, 10.0)] {
            assert!(!is_crossed(0.0, DVec3::Z, range), "{range:?}");
        }
        // Too near the rim, or past it; within 0.1 of the plane only.
        assert!(!is_crossed(0.95, DVec3::Z, (0.0, 10.0)));
        assert!(!is_crossed(1.5, DVec3::Z, (0.0, 10.0)));
        let slanted = DVec3::new(3.0, 0.0, 1.0);
        assert!(is_crossed(-15.0, slanted, (0.0, 10.0)));
        assert!(!is_crossed(-15.7, slanted, (0.0, 10.0)));
    }
}
