//! The side of a missing disk's plane on which a point is.
//!
//! With the axis `a = p1 - p0`, the placement `x -> M x + T` and the adjugate
//! `J` of `M` (`J M = det M`), the solid is on the side `s >= 0` of the planes
//!
//! ```text
//! s(x) =  σ (a·J (x - T) - det M a·p0)     of the disk at p0
//! s(x) = -σ (a·J (x - T) - det M a·p1)     of the disk at p1
//! ```
//!
//! where σ is the sign of `det M`. With a point of the mesh's
//! space, `x = center + m / scale`, the four coefficients of `s` are computed
//! exactly, divided by a power of two and rounded once.
//!
//! A point `m = o + t d` is computed with at most 2 roundings a coordinate, the
//! products and the sum of three and the constant take 4 more, and the
//! coefficients 1. With `t` itself off by an ulp, the computed `s` is within
//! `10 u` of the sum of the sizes of its terms, where a coordinate counts as
//! `|o| + |t d|`; the code uses 16 u.

use glam::DVec3;

use cyltrace::math::{UNIT_ROUNDOFF, power_of_two};
use cyltrace_oracle::{Exact, ExactVector, exact, to_f64};

use super::mesh_frame::MeshFrame;
use super::window::PlacedSolid;
use crate::solids::shape;

/// The planes of a solid's missing disks, in the mesh's space.
#[derive(Clone, Debug, Default)]
pub(crate) struct OpenEnds(Vec<Plane>);

#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: DVec3,
    constant: f64,
}

impl OpenEnds {
    /// The planes for one solid; none if it is closed.
    pub fn new(placed: &PlacedSolid, frame: &MeshFrame) -> Self {
        let Some([(p0, is_open0), (p1, is_open1)]) = shape(&placed.solid).ends() else {
            return Self::default();
        };
        let missing = [(is_open0, p0, 1.0), (is_open1, p1, -1.0)];
        let planes = missing.into_iter().filter(|&(is_missing, ..)| is_missing);
        Self(
            planes
                .map(|(_, end, side)| plane(([p0, p1], placed), frame, end, side))
                .collect(),
        )
    }

    /// Whether the point `origin + t direction` of the mesh's space is strictly
    /// on the solid's side of all planes, for certain.
    pub fn are_passed(&self, origin: DVec3, direction: DVec3, t: f64) -> bool {
        let point = origin + direction * t;
        let size = origin.abs() + (direction * t).abs();
        self.0.iter().all(|plane| {
            let s = plane.normal.dot(point) + plane.constant;
            let sizes = plane.normal.abs().dot(size) + plane.constant.abs();
            s > 16.0 * UNIT_ROUNDOFF * sizes
        })
    }
}

fn plane(
    ([p0, p1], placed): ([DVec3; 2], &PlacedSolid),
    frame: &MeshFrame,
    end: DVec3,
    side: f64,
) -> Plane {
    let axis = &ExactVector::new(p1) - &ExactVector::new(p0);
    let placement = &placed.frame.exact;
    let (adjugate, determinant) = placement.adjugate();
    let normal = adjugate.times_from_left(&axis);
    let from_translation = &ExactVector::new(frame.center()) - placement.translation();
    let constant = normal.dot(&from_translation) - &determinant * axis.dot(&ExactVector::new(end));
    let side = exact(if determinant < exact(0.0) {
        -side
    } else {
        side
    });
    // Everything times the scale, so that the points of the mesh stay as they are.
    let constant = constant * &side * exact(frame.scale());
    let normal = normal.times(&side);
    let unit = unit_of(normal.0.iter().chain([&constant]));
    let rounded = |x: &Exact| to_f64(&(x * &unit));
    Plane {
        normal: DVec3::from_array([0, 1, 2].map(|i| rounded(&normal.0[i]))),
        constant: rounded(&constant),
    }
}

/// A power of two that brings the greatest of the numbers near 1.
fn unit_of<'a>(numbers: impl Iterator<Item = &'a Exact>) -> Exact {
    let exponent = numbers
        .filter(|x| **x != exact(0.0))
        .map(|x| x.repr().exponent() + x.repr().digits() as isize)
        .max()
        .unwrap_or(0);
    // In steps, because the exponent may be beyond the range of f64.
    let (mut unit, mut left) = (exact(1.0), -exponent);
    while left != 0 {
        let step = left.clamp(-1000, 1000);
        unit *= exact(power_of_two(step as i32));
        left -= step;
    }
    unit
}
