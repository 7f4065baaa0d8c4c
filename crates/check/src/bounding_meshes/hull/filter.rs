//! The proofs of `proof` in f64, which settle nearly all of them.
//!
//! Everything is in the meshes' units, with the errors of
//! `mesh_map` for the point `y` of a vertex ([`MeshAnchor::seen`]); every product below
//! rounds by a few u of the sizes of its factors, of which 8, counted twice, are taken. A
//! NaN fails.

use glam::DVec3;

use super::form::{Axis, Form};
use crate::bounding_meshes::mesh_frame::MeshFrame;
use crate::bounding_meshes::mesh_map::{MeshAnchor, MeshMap};
use crate::bounding_meshes::window::PlacedSolid;
use cyltrace::math::UNIT_ROUNDOFF;

/// u, doubled for the roundings of the bounds.
const UNIT: f64 = 2.0 * UNIT_ROUNDOFF;

/// A placed solid in the meshes' space, for the proofs in f64.
pub(super) struct Rounded<'a> {
    anchor: MeshAnchor<'a>,
    form: Form,
    /// Of the ends as seen from the anchor, which is the first.
    axis: DVec3,
    length: f64,
    /// The middle in the mesh and the bound of its error.
    middle: (DVec3, f64),
}

impl<'a> Rounded<'a> {
    pub fn new(frame: &MeshFrame, map: &'a MeshMap, placed: &PlacedSolid, form: Form) -> Self {
        let [start, end] = form.end_points();
        let anchor = MeshAnchor::new(frame, map, placed, start);
        let between = end - start;
        let axis = match form {
            Form::Disks {
                axis: Axis::Along(axis),
                ..
            } => axis,
            _ => between,
        };
        let half = map.matrix * (0.5 * between);
        let size = anchor.base.length() + map.stretch * between.length();
        Self {
            anchor,
            form,
            axis,
            length: axis.length(),
            middle: (anchor.base + half, 8.0 * UNIT * size),
        }
    }

    /// Where the anchor is.
    pub fn anchor(&self) -> &MeshAnchor<'a> {
        &self.anchor
    }

    /// True only if the point of the mesh is in the solid.
    pub fn surely_holds(&self, vertex: DVec3) -> bool {
        let Some((y, error)) = self.anchor.seen(vertex) else {
            return false;
        };
        let in_ball = |from: DVec3, radius: f64, error: f64| {
            from.length() * (1.0 + 8.0 * UNIT) + error <= radius * (1.0 - 8.0 * UNIT)
        };
        let error = error + 8.0 * UNIT * (y.length() + self.length);
        match &self.form {
            Form::Balls { ends } => {
                let [(start, radius0), (end, radius1)] = *ends;
                in_ball(y, radius0, error)
                    || in_ball(y - (end - start), radius1, error)
                    || self.surely_between(y, error, [radius0, radius1], true)
            }
            Form::Disks { ends, .. } => {
                self.surely_between(y, error, ends.map(|(_, radius)| radius), false)
            }
            Form::Box {
                axes, half_widths, ..
            } => axes.iter().zip(half_widths).all(|(axis, half_width)| {
                axis.dot(y).abs() + error <= half_width * (1.0 - 8.0 * UNIT)
            }),
        }
    }

    /// Whether a point is surely within the wall and between the heights at which it
    /// starts and ends: those of the disks, or where it touches the balls.
    fn surely_between(&self, y: DVec3, error: f64, radii: [f64; 2], touches_balls: bool) -> bool {
        let [radius0, radius1] = radii;
        let (height, off) = (
            y.dot(self.axis) / self.length,
            y.cross(self.axis).length() / self.length,
        );
        let slope = (radius1 - radius0) / self.length;
        let cos_squared = if touches_balls {
            1.0 - slope * slope
        } else {
            1.0
        };
        // So that the root of it loses no more than a factor of 1000.
        if !(cos_squared >= 1e-6) {
            return false;
        }
        let cos = cos_squared.sqrt();
        let start = if touches_balls { -radius0 * slope } else { 0.0 };
        let end = start + self.length * cos_squared;
        let size = radius0 + radius1 + self.length + y.length();
        let error = 2.0 * (1.0 + slope.abs()) * error + 1e3 * 8.0 * UNIT * size;
        start + error <= height
            && height + error <= end
            && off * cos + error <= radius0 + slope * height
    }

    /// True only if (1) holds for a vertex and `m`.
    pub fn is_surely_beyond(&self, vertex: DVec3, m: DVec3) -> bool {
        let Some((y, error)) = self.anchor.seen(vertex) else {
            return false;
        };
        let error = |size: f64| 2.0 * error + 8.0 * UNIT * (y.length() + size);
        match &self.form {
            Form::Balls { ends } | Form::Disks { ends, .. } => {
                let width = match self.form {
                    Form::Disks { .. } => m.cross(self.axis).length() / self.length,
                    _ => m.length(),
                };
                ends.iter().all(|&(end, radius)| {
                    let from_start = end - ends[0].0;
                    let size = from_start.length() + radius;
                    m.dot(y - from_start) - radius * width > error(size) * m.length()
                })
            }
            Form::Box {
                axes, half_widths, ..
            } => {
                let (axis, side) = Form::face(axes, m);
                let half_width = half_widths[axis];
                side * axes[axis].dot(y) - half_width > error(half_width)
            }
        }
    }

    /// True only if a point of the mesh is over (1) or under (-1) the disk.
    pub fn is_surely_on_side(&self, vertex: DVec3, side: f64) -> bool {
        let (Some((y, error)), Form::Disks { ends, .. }) = (self.anchor.seen(vertex), &self.form)
        else {
            return false;
        };
        let (height, off) = (
            y.dot(self.axis) / self.length,
            y.cross(self.axis).length() / self.length,
        );
        let error = error + 8.0 * UNIT * y.length();
        side * height > error && off + error <= ends[0].1 * (1.0 - 8.0 * UNIT)
    }

    /// True only if the solid's middle is strictly behind the plane of a triangle.
    pub fn is_surely_around_middle(&self, [v0, v1, v2]: [DVec3; 3]) -> bool {
        let (d1, d2) = (v1 - v0, v2 - v0);
        let n = d1.cross(d2);
        let n_error = 8.0 * UNIT * d1.length() * d2.length();
        let (middle, middle_error) = self.middle;
        let q = v0 - middle;
        let reach = q.length() + middle_error;
        n.dot(q) > n_error * reach + n.length() * (8.0 * UNIT * reach + middle_error)
    }
}
