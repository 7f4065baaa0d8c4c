//! The proof that a prism, as its f32 vertices have it, is inside its solid or
//! holds it.
//!
//! *Inside.* The solid is convex. If all vertices are in it, so are all
//! triangles, and whatever a ray meets of them is a point of the solid.
//!
//! *Around.* The triangles form a closed surface `S`: every edge belongs to two
//! of them, run through in opposite directions. Let every triangle be of one of
//! two kinds:
//!
//! - its plane has the solid on its inner side, where its normal does not point;
//! - its corners are all beyond one end of the solid, so that it is, and its plane
//!   has the middle `p` of the axis strictly on its inner side. A triangle of a
//!   cap, with its corner in the middle, is as narrow as a side: its plane
//!   tilts by `ε cot(π/N)` over the disc and would have to be that far outside.
//!
//! No triangle comes into the solid's interior, so `S` winds around all of it
//! as often as around `p`: once, since it does in the prism that is not rounded,
//! and as the corners move from there to where they are, no side comes nearer
//! to the axis than the radius and no cap to the ends (`prism`). From `p` every
//! triangle that is not degenerate is seen from inside, at a positive solid
//! angle; the angles add up to 4π, so each ray from `p` meets `S` once. That
//! makes `S` the surface of a star-shaped body without folds, and the solid is
//! in it. So a ray that starts outside of the body meets `S` from outside first,
//! one that starts inside from inside, and a line that enters the solid at
//! `t1` and leaves it at `t2` meets `S` from outside at least once at `t <= t1`, and
//! from inside at least once at `t >= t2`. (A degenerate triangle has no solid
//! angle and is not in the way of lines nearby; points of the solid's surface
//! are limits of interior ones.) That is all that is asked of the outer prism;
//! neither its convexity nor that of the inner one is needed, which rounding
//! would break.
//!
//! In exact numbers, with `a = p1 - p0`, `v` a vertex in the world, `L` and `T` the
//! composed placement, `A` and `D` the adjugate and determinant of `L`:
//!
//! ```text
//! x = A (v - T) - D p0                           D times the x of the vertex
//! inside:  x·a from 0 to D a·a,   |x × a|² <= r² D² a·a
//!
//! n = (v1 - v0) × (v2 - v0),  m = Lᵀ n           the plane, seen from the solid
//! g = n·(v0 - L p0 - T) - max(0, m·a)            its distance from the axis' ends
//! around:  g >= 0,   g² a·a >= r² |m × a|²       the support of a disc: r |m × a| / |a|
//! or, for all corners:  x·a <= 0  or all  x·a >= D a·a  (D > 0, else reversed),
//!          2 n·(v0 - L p0 - T) > m·a             p is behind the plane
//! ```
//!
//! In f64 the same is tried first, in the mesh's units, with bounds of the
//! errors (u = 2^-53; b, M, G, defect: see `mesh_solid`; | | of a matrix is its
//! Frobenius norm). For `q = fl(v - b)`, off by `u |q| + u |b|`, and `y = fl(G q)`,
//! whose product adds `3 u |G| |q|`:
//!
//! ```text
//! |y - x| <= |G| (4 u |q| + u |b| + 2 defect (|q| + |b| u))       if defect <= 1/4
//! ```
//!
//! since `x = G (I + E)⁻¹ q` with `|E| <= defect`. `x·a` and `x × a` then err by `|a|`
//! times that and by `8 u |y| |a|` for `fl(a)` and the products. The normal of a
//! triangle with the sides `d1` and `d2` from `v0` errs by `8 u |d1| |d2| = e`, `m`
//! by `|M| (e + 5 u |n|) = f`, `m·a` and `m × a` by `|a| f + 8 u |m| |a|`, and
//! `n·q` by `e (|q| + u |b|) + |n| (5 u |q| + u |b|)`. All bounds are taken with twice the
//! number of u, for what rounds in the bounds themselves; a NaN fails.

use glam::DVec3;

use crate::math::UNIT_ROUNDOFF;
use crate::oracle::{Exact, ExactMatrix, ExactVector, exact};

use super::mesh_frame::MeshFrame;
use super::mesh_solid::MeshSolid;
use super::placed::PlacedSolid;

/// u, doubled for the roundings of the bounds.
const UNIT: f64 = 2.0 * UNIT_ROUNDOFF;

fn wide(vertex: [f32; 3]) -> DVec3 {
    DVec3::from_array(vertex.map(f64::from))
}

/// Whether all vertices of the mesh are in the closed capped solid.
pub(in crate::check) fn holds_all(
    solid: &MeshSolid,
    frame: &MeshFrame,
    vertices: &[[f32; 3]],
) -> bool {
    let mut exactly = None;
    vertices.iter().all(|&vertex| {
        is_surely_inside(solid, wide(vertex))
            || exactly
                .get_or_insert_with(|| ExactSolid::new(solid.placed))
                .is_inside(&frame.exact_world_from_mesh(wide(vertex)))
    })
}

/// Whether the closed surface of these triangles encloses the capped solid.
pub(in crate::check) fn is_enclosed(
    solid: &MeshSolid,
    frame: &MeshFrame,
    mut triangles: impl Iterator<Item = [[f32; 3]; 3]>,
) -> bool {
    let mut exactly = None;
    let mut is_closed = false;
    let all_outside = triangles.all(|corners| {
        let wide_corners = corners.map(wide);
        if is_surely_outside(solid, wide_corners) || is_surely_beyond_end(solid, wide_corners) {
            is_closed = true;
            return true;
        }
        let plane = Plane::new(frame, corners);
        is_closed |= !plane.is_degenerate();
        let exact = exactly.get_or_insert_with(|| ExactSolid::new(solid.placed));
        exact.is_behind(&plane) || exact.is_below(&plane)
    });
    all_outside && is_closed
}

/// In f64: true only if the point of the mesh is in the solid.
fn is_surely_inside(solid: &MeshSolid, vertex: DVec3) -> bool {
    let Some((y, error)) = solid_point(solid, vertex) else {
        return false;
    };
    let (a, length) = (solid.axis, solid.length);
    let (height, top) = (y.dot(a), a.length_squared());
    let from_axis = y.cross(a).length();
    error <= height
        && height + error <= top * (1.0 - 8.0 * UNIT)
        && from_axis * (1.0 + 8.0 * UNIT) + error <= solid.radius * length * (1.0 - 8.0 * UNIT)
}

/// `y` for a point of the mesh and the error of its products with `a`, unless
/// the map is too rough for it.
fn solid_point(solid: &MeshSolid, vertex: DVec3) -> Option<(DVec3, f64)> {
    let map = solid.map;
    if !(map.defect <= 0.25) {
        return None;
    }
    let q = vertex - solid.base;
    let y = map.inverse * q;
    let (reach, base) = (q.length(), solid.base.length());
    let error =
        map.squeeze * (4.0 * UNIT * reach + UNIT * base + 2.5 * map.defect * (reach + UNIT * base));
    Some((y, solid.length * (error + 8.0 * UNIT * y.length())))
}

/// In f64: true only if the triangle is beyond one end, and the middle of the
/// axis strictly behind its plane.
fn is_surely_beyond_end(solid: &MeshSolid, corners: [DVec3; 3]) -> bool {
    let top = solid.axis.length_squared() * (1.0 + 8.0 * UNIT);
    let heights = corners.map(|corner| {
        let (y, error) = solid_point(solid, corner)?;
        Some((y.dot(solid.axis), error))
    });
    let all = |is_beyond: &dyn Fn(f64, f64) -> bool| {
        let mut heights = heights.iter();
        heights.all(|height| height.is_some_and(|(height, error)| is_beyond(height, error)))
    };
    let is_beyond =
        all(&|height, error| height + error <= 0.0) || all(&|height, error| height - error >= top);
    if !is_beyond {
        return false;
    }
    let plane = RoundedPlane::new(solid, corners);
    let along = 0.5 * plane.along;
    plane.height - along > plane.error + UNIT * along.abs()
}

/// In f64: true only if the solid is behind the triangle's plane, and the
/// triangle is not degenerate.
fn is_surely_outside(solid: &MeshSolid, corners: [DVec3; 3]) -> bool {
    let plane = RoundedPlane::new(solid, corners);
    let ends = plane.along.max(0.0);
    let error = plane.error + UNIT * ends;
    let disc = solid.radius * (plane.across + plane.m_error) / solid.length;
    plane.height - ends - error > disc * (1.0 + 16.0 * UNIT)
}

/// A triangle's plane seen from the solid, in f64.
struct RoundedPlane {
    /// `n·q`.
    height: f64,
    /// `m·a`.
    along: f64,
    /// `|m × a|`.
    across: f64,
    /// Of each of the two.
    m_error: f64,
    /// Of `n·q` and `m·a` together.
    error: f64,
}

impl RoundedPlane {
    fn new(solid: &MeshSolid, [v0, v1, v2]: [DVec3; 3]) -> Self {
        let (a, length, map) = (solid.axis, solid.length, solid.map);
        let (d1, d2) = (v1 - v0, v2 - v0);
        let n = d1.cross(d2);
        let size = n.length();
        let n_error = 8.0 * UNIT * d1.length() * d2.length();
        let m = map.matrix.transpose() * n;
        let m_error = map.stretch * (n_error + 5.0 * UNIT * size);
        let m_error = length * (m_error + 8.0 * UNIT * m.length());

        let q = v0 - solid.base;
        let (reach, base) = (q.length(), solid.base.length());
        let height = n.dot(q);
        let height_error = n_error * (reach + UNIT * base) + size * UNIT * (5.0 * reach + base);
        Self {
            height,
            along: m.dot(a),
            across: m.cross(a).length(),
            m_error,
            error: height_error + m_error + UNIT * height.abs(),
        }
    }
}

/// The plane of a triangle, in the world.
struct Plane {
    corners: [ExactVector; 3],
    /// Outward, of any length.
    normal: ExactVector,
}

impl Plane {
    fn new(frame: &MeshFrame, corners: [[f32; 3]; 3]) -> Self {
        Self::of(corners.map(|corner| frame.exact_world_from_mesh(wide(corner))))
    }

    /// Through points of the world.
    fn of(corners: [ExactVector; 3]) -> Self {
        let [v0, v1, v2] = &corners;
        Self {
            normal: (v1 - v0).cross(&(v2 - v0)),
            corners,
        }
    }

    fn is_degenerate(&self) -> bool {
        self.normal.0.iter().all(|x| *x == exact(0.0))
    }
}

/// A placed solid in exact numbers.
struct ExactSolid {
    matrix: ExactMatrix,
    adjugate: ExactMatrix,
    determinant: Exact,
    /// `T`.
    translation: ExactVector,
    /// `p0`, in the solid's own space.
    start: ExactVector,
    /// `a`.
    axis: ExactVector,
    /// `a·a`.
    axis_squared: Exact,
    /// `r²`.
    radius_squared: Exact,
}

impl ExactSolid {
    fn new(placed: &PlacedSolid) -> Self {
        let (map, cylinder) = (&placed.frame.exact, &placed.cylinder);
        let start = ExactVector::new(cylinder.p0());
        let axis = &ExactVector::new(cylinder.p1()) - &start;
        let (adjugate, determinant) = map.adjugate();
        let radius = exact(cylinder.radius());
        Self {
            matrix: map.matrix().clone(),
            adjugate,
            determinant,
            translation: map.translation().clone(),
            start,
            axis_squared: axis.dot(&axis),
            axis,
            radius_squared: &radius * &radius,
        }
    }

    fn is_inside(&self, vertex: &ExactVector) -> bool {
        let x = self.solid_point(vertex);
        let (height, top) = (x.dot(&self.axis), &self.determinant * &self.axis_squared);
        let zero = exact(0.0);
        let between = if self.determinant < zero {
            top <= height && height <= zero
        } else {
            zero <= height && height <= top
        };
        let across = x.cross(&self.axis);
        between && across.dot(&across) <= &self.radius_squared * &self.determinant * &top
    }

    /// `D` times the `x` of a point of the world.
    fn solid_point(&self, point: &ExactVector) -> ExactVector {
        let scaled = self.adjugate.times(&(point - &self.translation));
        &scaled - &self.start.times(&self.determinant)
    }

    /// Whether the triangle is beyond one end, and the middle of the axis strictly
    /// behind its plane.
    fn is_below(&self, plane: &Plane) -> bool {
        // Times D, so that the sense of the axis does not depend on its sign.
        let top = &self.determinant * &self.determinant * &self.axis_squared;
        let heights = plane
            .corners
            .each_ref()
            .map(|corner| self.solid_point(corner).dot(&self.axis) * &self.determinant);
        let is_beyond = heights.iter().all(|height| *height <= exact(0.0))
            || heights.iter().all(|height| *height >= top);
        let (gap, along) = self.gap_and_along(plane);
        is_beyond && gap * exact(2.0) > along
    }

    /// `n·(v0 - L p0 - T)` and `m·a`.
    fn gap_and_along(&self, plane: &Plane) -> (Exact, Exact) {
        let start = &self.matrix.times(&self.start) + &self.translation;
        let along = self.matrix.times_from_left(&plane.normal).dot(&self.axis);
        (plane.normal.dot(&(&plane.corners[0] - &start)), along)
    }

    fn is_behind(&self, plane: &Plane) -> bool {
        let m = self.matrix.times_from_left(&plane.normal);
        let (mut gap, along) = self.gap_and_along(plane);
        if along > exact(0.0) {
            gap -= along;
        }
        let across = m.cross(&self.axis);
        gap >= exact(0.0)
            && &gap * &gap * &self.axis_squared >= &self.radius_squared * across.dot(&across)
    }
}

#[cfg(test)]
pub(in crate::check) mod tests;
