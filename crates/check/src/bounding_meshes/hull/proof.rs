//! The proof that a mesh, as its f32 vertices have it, is inside its solid or holds it.
//!
//! *Inside.* The solid is convex. If all vertices are in it, so are all triangles, and
//! whatever a ray meets of them is a point of the solid.
//!
//! *Around.* The triangles form a closed surface `S`. Let each of them have a
//! vector `m` with
//!
//! ```text
//! m·(v - p) > h(m)  for its three corners v,   h(m) = max m·(x - p) over the solid    (1)
//! ```
//!
//! so that a plane separates it from the solid, whatever its own plane does, and let the
//! solid's middle `c` be strictly behind its own plane. No triangle comes to the solid,
//! so `S` winds around all of it as often as around `c`. Seen from `c` every triangle
//! shows its inner side, at a positive solid angle, so that is at least once. It is once
//! for the mesh that is not rounded, whose corners have (1) with the same `m`, as has
//! everything between them and the rounded ones: the angles add up to 4π, and `S` is the
//! surface of a star-shaped body without folds that holds the solid. So a ray that starts outside of
//! the body meets `S` from outside first, one that starts inside from inside, and a line
//! that is in the solid from `t1` to `t2` meets `S` from outside at least once at `t <=
//! t1`, and from inside at least once at `t >= t2`. That is all that is asked of the mesh
//! around a solid; it need not be convex, which rounding would break. (A triangle that is
//! degenerate has no solid angle and is not in the way of lines nearby; only (1) is asked
//! of it.)
//!
//! *The solid's support.* A solid is the convex hull of balls, or of disks across an
//! axis, one at each end; with `e` the ends as seen from the anchor `p`, `a` the axis:
//!
//! ```text
//! h(m) = max (m·e + r |m|)   or   max (m·e + r |m × a| / |a|)                         (2)
//! ```
//!
//! A cuboid's faces are their own `m`. All is decided by squares, in exact numbers.
//! With `A` and `D` the adjugate and determinant of the placement `L x + T`, a vertex `v`
//! of the world is seen from the anchor as `x = σ (A (v - T) - D p)`, σ the sign of `D`,
//! which is `|D|` times too long; so are then `e` and `r` to be taken.
//!
//! `filter` tries the same in f64 first.

use glam::DVec3;

use super::form::{Axis, Form};
use crate::bounding_meshes::window::PlacedSolid;
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
    /// The way to the other end.
    between: ExactVector,
    /// The middle, in the world.
    middle: ExactVector,
    form: Form,
}

impl Proven {
    pub fn new(placed: &PlacedSolid, form: Form) -> Self {
        let map = &placed.frame.exact;
        let (adjugate, determinant) = map.adjugate();
        let is_mirrored = determinant < exact(0.0);
        let [start, end] = form.end_points().map(ExactVector::new);
        let between = &end - &start;
        let middle = map.point(&(&start + &between.times(&exact(0.5))));
        Self {
            adjugate,
            is_mirrored,
            scale: if is_mirrored {
                -determinant
            } else {
                determinant
            },
            translation: map.translation().clone(),
            start,
            between,
            middle,
            form,
        }
    }

    /// `x`: `|D|` times the vector from the anchor to a point of the world.
    fn seen(&self, point: &ExactVector) -> ExactVector {
        let turned = self.adjugate.times(&(point - &self.translation));
        let sign = exact(if self.is_mirrored { -1.0 } else { 1.0 });
        &turned.times(&sign) - &self.start.times(&self.scale)
    }

    fn axis(&self) -> ExactVector {
        match self.form {
            Form::Disks {
                axis: Axis::Along(axis),
                ..
            } => ExactVector::new(axis),
            _ => self.between.clone(),
        }
    }

    /// Whether the solid holds a point of the world.
    pub fn holds(&self, point: &ExactVector) -> bool {
        let x = self.seen(point);
        match &self.form {
            Form::Balls { ends } => {
                let radii = ends.map(|(_, radius)| exact(radius));
                let in_ball = |from: &ExactVector, radius: &Exact| {
                    let reach = radius * &self.scale;
                    from.dot(from) <= &reach * &reach
                };
                let from_end = &x - &self.between.times(&self.scale);
                in_ball(&x, &radii[0])
                    || in_ball(&from_end, &radii[1])
                    || self.is_between(&x, &radii, true)
            }
            Form::Disks { ends, .. } => {
                self.is_between(&x, &ends.map(|(_, radius)| exact(radius)), false)
            }
            Form::Box {
                axes, half_widths, ..
            } => axes.iter().zip(half_widths).all(|(axis, half_width)| {
                let along = ExactVector::new(*axis).dot(&x);
                let reach = exact(*half_width) * &self.scale;
                -&reach <= along && along <= reach
            }),
        }
    }

    /// Whether a point is within the wall and between the heights at which it starts
    /// and ends, as `cyltrace_oracle::taper` has them.
    fn is_between(&self, x: &ExactVector, radii: &[Exact; 2], touches_balls: bool) -> bool {
        let axis = &self.between;
        let (squared, growth) = (axis.dot(axis), &radii[1] - &radii[0]);
        let along = x.dot(axis);
        let zero = exact(0.0);
        let (narrowed, start) = if touches_balls {
            (&squared - &growth * &growth, &radii[0] * &growth)
        } else {
            (squared.clone(), zero.clone())
        };
        if narrowed <= zero {
            return false;
        }
        let height = &along + start * &self.scale;
        if height < zero || height > &narrowed * &self.scale {
            return false;
        }
        let across = x.cross(axis);
        let width = &radii[0] * &squared * &self.scale + growth * along;
        width >= zero && across.dot(&across) * narrowed <= &width * &width
    }

    /// Whether (1) holds for a point of the world and `m`.
    pub fn is_beyond(&self, point: &ExactVector, m: DVec3) -> bool {
        let x = self.seen(point);
        let zero = exact(0.0);
        match &self.form {
            Form::Balls { ends } | Form::Disks { ends, .. } => {
                let m = ExactVector::new(m);
                let (width_squared, unit_squared) = match self.form {
                    Form::Disks { .. } => {
                        let axis = self.axis();
                        let across = m.cross(&axis);
                        (across.dot(&across), axis.dot(&axis))
                    }
                    _ => (m.dot(&m), exact(1.0)),
                };
                let offsets = [ExactVector::new(DVec3::ZERO), self.between.clone()];
                ends.iter().zip(offsets).all(|((_, radius), offset)| {
                    let gap = m.dot(&(&x - &offset.times(&self.scale)));
                    let reach = exact(*radius) * &self.scale;
                    gap > zero && &gap * &gap * &unit_squared > &reach * &reach * &width_squared
                })
            }
            Form::Box {
                axes, half_widths, ..
            } => {
                let (axis, side) = Form::face(axes, m);
                let along = ExactVector::new(axes[axis] * side).dot(&x);
                along > exact(half_widths[axis]) * &self.scale
            }
        }
    }

    /// Whether the solid's middle is strictly behind the plane of a triangle of the
    /// world; `None` if that is degenerate.
    pub fn is_around_middle(&self, [v0, v1, v2]: &[ExactVector; 3]) -> Option<bool> {
        let normal = (v1 - v0).cross(&(v2 - v0));
        let zero = exact(0.0);
        if normal.0.iter().all(|x| *x == zero) {
            return None;
        }
        Some(normal.dot(&(v0 - &self.middle)) > zero)
    }

    /// Whether a point of the world is over or under a disk, and on which side:
    /// positive is where its normal points.
    pub fn side_of_disk(&self, point: &ExactVector) -> Option<f64> {
        let x = self.seen(point);
        let Form::Disks { ends, .. } = &self.form else {
            return None;
        };
        let axis = self.axis();
        let across = x.cross(&axis);
        let reach = exact(ends[0].1) * &self.scale;
        let height = x.dot(&axis);
        let zero = exact(0.0);
        if across.dot(&across) > &reach * &reach * axis.dot(&axis) || height == zero {
            return None;
        }
        Some(if height > zero { 1.0 } else { -1.0 })
    }
}
