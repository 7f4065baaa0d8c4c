//! The proof that a mesh, with its f32 vertices, is inside its solid or contains it.
//!
//! *Inside.* The solid is convex. If it contains all vertices, it contains all triangles, and
//! every point at which a ray crosses them.
//!
//! *Around.* The triangles form a closed surface `S`. Let each of them have a
//! vector `m` with
//!
//! ```text
//! m·(v - p) > h(m)  for its three corners v,   h(m) = max m·(x - p) over the solid    (1)
//! ```
//!
//! so that a plane separates it from the solid, whatever its own plane does, and let the
//! solid's middle `c` be strictly behind its own plane. No triangle touches the solid,
//! so `S` winds around all of it as often as around `c`. Seen from `c` every triangle
//! shows its inner side, at a positive solid angle, so that is at least once. It is once
//! for the mesh that is not rounded, whose corners have (1) with the same `m`, as has
//! everything between them and the rounded ones: the angles add up to 4π, and `S` is the
//! surface of a star-shaped body without folds that contains the solid. So a ray that starts
//! outside of the body first enters `S`, one that starts inside first leaves it, and a line
//! that is in the solid from `t1` to `t2` enters `S` at least once at `t <=
//! t1`, and leaves it at least once at `t >= t2`. Nothing more is required of the mesh
//! around a solid; it need not be convex, which rounding would break. (A degenerate
//! triangle has no solid angle and does not stop lines nearby, so only (1) is required
//! of it.)
//!
//! The supports `h` are those of `solids`. All is decided by squares, in exact numbers.
//! With `A` and `D` the adjugate and determinant of the placement `L x + T`, a vertex `v`
//! of the world is seen from the anchor as `x = σ (A (v - T) - D p)`, σ the sign of `D`,
//! which is `|D|` times too long; lengths of the solid are scaled accordingly.
//!
//! `filter` tries the same in f64 first.

use glam::DVec3;

use crate::bounding_meshes::window::PlacedSolid;
use crate::solids::{Scaled, Shape, shape};
use cyltrace_oracle::{Exact, ExactMatrix, ExactVector, exact};

/// A placed solid in exact numbers.
pub(super) struct Proven {
    adjugate: ExactMatrix,
    /// Whether the placement mirrors.
    is_mirrored: bool,
    /// `|D|`.
    scale: Exact,
    translation: ExactVector,
    /// `p`, in the solid's own space.
    start: ExactVector,
    /// The middle, in the world.
    middle: ExactVector,
    shape: Shape,
}

impl Proven {
    pub fn new(placed: &PlacedSolid) -> Self {
        let map = &placed.frame.exact;
        let shape = shape(&placed.solid);
        let (adjugate, determinant) = map.adjugate();
        let is_mirrored = determinant < exact(0.0);
        let [start, end] = shape.get().end_points().map(ExactVector::new);
        let half = (&end - &start).times(&exact(0.5));
        Self {
            adjugate,
            is_mirrored,
            scale: if is_mirrored {
                -determinant
            } else {
                determinant
            },
            translation: map.translation().clone(),
            middle: map.point(&(&start + &half)),
            start,
            shape,
        }
    }

    /// `x`: `|D|` times the vector from the anchor to a point of the world.
    fn seen(&self, point: &ExactVector) -> Scaled {
        let turned = self.adjugate.times(&(point - &self.translation));
        let sign = exact(if self.is_mirrored { -1.0 } else { 1.0 });
        Scaled {
            x: &turned.times(&sign) - &self.start.times(&self.scale),
            scale: self.scale.clone(),
        }
    }

    /// Whether the solid contains a point of the world.
    pub fn contains(&self, point: &ExactVector) -> bool {
        self.shape.get().contains(&self.seen(point))
    }

    /// Whether (1) is true for a point of the world and `m`.
    pub fn is_beyond(&self, point: &ExactVector, m: DVec3) -> bool {
        self.shape.get().is_beyond(&self.seen(point), m)
    }

    /// Whether the solid's middle is strictly behind the plane of a triangle of the
    /// world; `None` if the triangle is degenerate.
    pub fn is_around_middle(&self, [v0, v1, v2]: &[ExactVector; 3]) -> Option<bool> {
        let normal = (v1 - v0).cross(&(v2 - v0));
        let zero = exact(0.0);
        if normal.0.iter().all(|x| *x == zero) {
            return None;
        }
        Some(normal.dot(&(v0 - &self.middle)) > zero)
    }

    /// Whether a point of the world is above or below a disk, and on which side: positive on
    /// that of its normal.
    pub fn side_of_disk(&self, point: &ExactVector) -> Option<f64> {
        let (radius, _) = self.shape.flat()?;
        let Scaled { x, scale } = self.seen(point);
        let axis = ExactVector::new(self.shape.get().axis());
        let across = x.cross(&axis);
        let reach = exact(radius) * &scale;
        let height = x.dot(&axis);
        let zero = exact(0.0);
        if across.dot(&across) > &reach * &reach * axis.dot(&axis) || height == zero {
            return None;
        }
        Some(if height > zero { 1.0 } else { -1.0 })
    }
}
