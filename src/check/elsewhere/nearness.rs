//! How near points and rays come to the surface of placed solids, with bounds.
//!
//! A solid's surface is taken in its own space. With `M` the linear part of
//! `world_from_object`, a length `δ` in the world is at most `|M⁻¹| δ` there, and a
//! length there at most `|M|` times as much in the world. The spectral norms are
//! bounded from above by `|A|² ≤ max row sum of |AᵀA|`, which is equality for a
//! uniformly scaled rotation, and at most √3 too much otherwise.
//!
//! The *depth* of a point in the capped solid is its distance from the surface,
//! negative outside. As the solid is convex, the depth is concave along a ray: its
//! greatest value in a range is found by sections, its least one is at an end.
//!
//! What f64 rounds on the way there is below `64 ε |M| |M⁻¹|` of the lengths that
//! are added; it is added to `δ`.

use glam::{DAffine3, DMat3, DVec3};

use crate::math::{Bounds, Ray};
use crate::scene::{PrototypeIndex, Scene};
use crate::solid::{Caps, Cylinder};

/// Sections of a range, each to 2/3 of it.
const SECTIONS: u32 = 64;

/// See the head of this file.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A solid's own space.
pub(in crate::check) struct Frame {
    object_from_world: DAffine3,
    /// The bound of `|M|`.
    stretch: f64,
    /// The bound of `|M⁻¹|`.
    squeeze: f64,
    translation: f64,
}

/// A cylinder there.
pub(in crate::check) struct PlacedCylinder<'a> {
    pub cylinder: Cylinder,
    pub frame: &'a Frame,
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

    /// At least the length there of `length` around a point of the world, with what is
    /// rounded there.
    fn local_length(&self, length: f64, point: DVec3, cylinder: &Cylinder) -> f64 {
        let size = self.squeeze * (point.length() + self.translation)
            + cylinder.p0().length()
            + cylinder.p1().length()
            + cylinder.radius();
        self.squeeze * length + ROUNDING * self.squeeze * self.stretch * size
    }
}

fn norm_bound(matrix: &DMat3) -> f64 {
    let square = matrix.transpose() * *matrix;
    let sums = square.x_axis.abs() + square.y_axis.abs() + square.z_axis.abs();
    libm::sqrt(sums.max_element())
}

impl PlacedCylinder<'_> {
    /// Whether a point of the world is proven to be farther than `distance` from
    /// the surface.
    pub fn is_far(&self, point: DVec3, distance: f64) -> bool {
        let local = self.frame.object_from_world.transform_point3(point);
        surface_distance(&self.cylinder, local)
            > self.frame.local_length(distance, point, &self.cylinder)
    }

    /// Whether a point of the world is proven to be within `distance` of the
    /// surface.
    pub fn is_near(&self, point: DVec3, distance: f64) -> bool {
        let local = self.frame.object_from_world.transform_point3(point);
        surface_distance(&self.cylinder, local) * self.frame.stretch <= distance
    }

    /// Whether a ray is proven to pass, between `start` and `end`, from more than
    /// `distance` on one side of the surface to more than that on its other side, all
    /// the way more than that from an open end.
    pub fn is_crossed(&self, ray: &Ray, start: f64, end: f64, distance: f64) -> bool {
        let cylinder = &self.cylinder;
        let deep = self.frame.local_length(distance, ray.origin, cylinder);
        let origin = self.frame.object_from_world.transform_point3(ray.origin);
        let direction = self
            .frame
            .object_from_world
            .transform_vector3(ray.direction);
        let (p0, axis) = (cylinder.p0(), cylinder.p1() - cylinder.p0());
        let length = axis.length();
        // Twice as far from the middle as the solid reaches, a ray is outside.
        let reach = 0.5 * length + cylinder.radius() + 4.0 * deep;
        let speed = direction.length();
        let middle = (p0 + 0.5 * axis - origin).dot(direction) / (speed * speed);
        let mut low = start.max(middle - 2.0 * reach / speed);
        let mut high = end.min(middle + 2.0 * reach / speed);
        let (z, dz) = (
            (origin - p0).dot(axis) / length,
            direction.dot(axis) / length,
        );
        let caps = cylinder.caps();
        for (is_open, room, slope) in [
            (!caps.at_p0(), z - deep, dz),
            (!caps.at_p1(), length - deep - z, -dz),
        ] {
            // Where room + slope t > 0 the end is far enough.
            let border = -room / slope;
            match () {
                () if !is_open => {}
                () if slope > 0.0 => low = low.max(border),
                () if slope < 0.0 => high = high.min(border),
                () if room <= 0.0 => return false,
                () => {}
            }
        }
        let depth = |t: f64| depth(cylinder, origin + direction * t);
        let is_ordered = low < high;
        if !is_ordered || !(depth(low).min(depth(high)) < -deep) {
            return false;
        }
        for _ in 0..SECTIONS {
            let third = (high - low) / 3.0;
            let (left, right) = (low + third, high - third);
            let (at_left, at_right) = (depth(left), depth(right));
            if at_left.max(at_right) > deep {
                return true;
            }
            if at_left < at_right {
                low = left;
            } else {
                high = right;
            }
        }
        false
    }
}

/// The coordinates along the axis and away from it, and the length.
fn coordinates(cylinder: &Cylinder, point: DVec3) -> (f64, f64, f64) {
    let axis = cylinder.p1() - cylinder.p0();
    let length = axis.length();
    let axis = axis / length;
    let from_foot = point - cylinder.p0();
    let z = from_foot.dot(axis);
    (z, (from_foot - axis * z).length(), length)
}

/// The depth of a point in the capped solid; negative outside.
fn depth(cylinder: &Cylinder, point: DVec3) -> f64 {
    let (z, away, length) = coordinates(cylinder, point);
    let (beyond_wall, beyond_ends) = (away - cylinder.radius(), (-z).max(z - length));
    if beyond_wall <= 0.0 && beyond_ends <= 0.0 {
        return (-beyond_wall).min(-beyond_ends);
    }
    -libm::hypot(beyond_wall.max(0.0), beyond_ends.max(0.0))
}

/// The distance of a point from the wall and the caps that there are.
fn surface_distance(cylinder: &Cylinder, point: DVec3) -> f64 {
    let (z, away, length) = coordinates(cylinder, point);
    let beyond_wall = away - cylinder.radius();
    let wall = libm::hypot(beyond_wall, (-z).max(z - length).max(0.0));
    let cap = |height: f64| libm::hypot(beyond_wall.max(0.0), height);
    let caps: Caps = cylinder.caps();
    let foot = if caps.at_p0() { cap(z) } else { f64::INFINITY };
    let head = if caps.at_p1() {
        cap(z - length)
    } else {
        f64::INFINITY
    };
    wall.min(foot).min(head)
}

/// All surfaces of a scene.
pub(in crate::check) struct Surfaces<'a> {
    scene: &'a Scene,
    /// The box of each prototype, as far as the root holds it.
    boxes: Vec<Option<Bounds>>,
}

impl<'a> Surfaces<'a> {
    pub fn new(scene: &'a Scene) -> Self {
        let mut surfaces = Self {
            scene,
            boxes: vec![None; scene.prototypes.len()],
        };
        surfaces.find_box(PrototypeIndex::ROOT);
        surfaces
    }

    fn find_box(&mut self, index: PrototypeIndex) -> Bounds {
        let number = index.0 as usize;
        if let Some(known) = self.boxes[number] {
            return known;
        }
        let scene = self.scene;
        let prototype = &scene.prototypes[number];
        let own = prototype.cylinders.iter().fold(Bounds::EMPTY, |all, one| {
            all.union(&one.cylinder().bounds())
        });
        let whole = prototype.placements.iter().fold(own, |all, placement| {
            let child = self.find_box(placement.of);
            if child.is_empty() {
                return all;
            }
            all.union(&child.transformed(&placement.parent_from_child))
        });
        self.boxes[number] = Some(whole);
        whole
    }

    /// Whether some surface may be within `distance` of a point.
    pub fn may_be_near(&self, point: DVec3, distance: f64) -> bool {
        self.may_be_near_in(
            PrototypeIndex::ROOT,
            &DAffine3::IDENTITY,
            point,
            1.001 * distance,
        )
    }

    fn may_be_near_in(
        &self,
        index: PrototypeIndex,
        world_from_here: &DAffine3,
        point: DVec3,
        distance: f64,
    ) -> bool {
        let prototype = &self.scene.prototypes[index.0 as usize];
        let frame = Frame::new(world_from_here);
        let is_near = prototype.cylinders.iter().any(|record| {
            let placed = PlacedCylinder {
                cylinder: record.cylinder(),
                frame: &frame,
            };
            !placed.is_far(point, distance)
        });
        is_near
            || prototype.placements.iter().any(|placement| {
                let world_from_child = *world_from_here * placement.parent_from_child;
                let Some(bounds) = self.boxes[placement.of.0 as usize] else {
                    return false;
                };
                let reach = distance + ROUNDING * point.length();
                !bounds.is_empty()
                    && bounds
                        .transformed(&world_from_child)
                        .grown(reach)
                        .meets(&Bounds::at(point))
                    && self.may_be_near_in(placement.of, &world_from_child, point, distance)
            })
    }
}
