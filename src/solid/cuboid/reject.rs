//! Rejects lines that certainly miss a cuboid, without a division or a branch.
//!
//! A line misses the cuboid iff two of the intervals (1) of `chord.rs` are disjoint: three
//! intervals with a common point in each pair have a point common to all. With `y_i = f_i·x`
//! and `e_i = f_i·d`, those of the axes j and k are disjoint iff
//!
//! ```text
//! |y_j e_k - y_k e_j| > h_j |e_k| + h_k |e_j|
//! ```
//!
//! also if an `e` is zero. Each `y` is off by at most `3 u |x|` and each `e` by `3 u |d|`,
//! u = 2^-53, so the left side by 15 u of `|x| |d|` and the right side by 5 u of
//! `(h_j + h_k) |d|`. Lengths are replaced by the sums of the sizes of their components, which
//! are not less and take no root.

use glam::DVec3;

use super::Cuboid;
use crate::math::power_of_two;

/// 16 u, doubled for the roundings of the sums.
const ROUNDINGS: f64 = power_of_two(-48);

/// Whether the line `center + x + t d` certainly misses. `false` is inconclusive, and returned
/// for values that are not finite.
#[inline(always)]
pub(super) fn rejects(cuboid: &Cuboid, x: DVec3, d: DVec3) -> bool {
    let (orientation, h) = (cuboid.orientation, cuboid.half_widths);
    let (y, e) = (orientation.to_object(x), orientation.to_object(d));
    let beside = y.cross(e).abs();
    let e = e.abs();
    let across = DVec3::new(
        h.y * e.z + h.z * e.y,
        h.z * e.x + h.x * e.z,
        h.x * e.y + h.y * e.x,
    );
    let sizes = x.abs().element_sum() + h.element_sum();
    let limit = across + ROUNDINGS * sizes * d.abs().element_sum();
    let is_beyond = |beside: f64, limit: f64| (beside > limit) & (beside < f64::INFINITY);
    is_beyond(beside.x, limit.x) | is_beyond(beside.y, limit.y) | is_beyond(beside.z, limit.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Orientation;

    fn rejected(height: f64, d: DVec3) -> bool {
        let turned = Orientation::IDENTITY.rotated_z(30.0);
        let cuboid = Cuboid::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 3.0), turned);
        let x = turned.to_world(DVec3::new(0.5, height, 0.25)) - d * 7.0;
        rejects(&cuboid.expect("it is one"), x, d)
    }

    #[test]
    fn lines_beside_a_face_an_edge_and_a_corner_are_rejected() {
        let turned = Orientation::IDENTITY.rotated_z(30.0);
        for d in [DVec3::X, DVec3::Z, DVec3::new(3.0, 0.0, -2.0)] {
            let d = turned.to_world(d);
            assert!(rejected(1.0 + 1e-9, d));
            assert!(!rejected(1.0, d));
            assert!(!rejected(1.0 - 1e-9, d));
        }
    }

    #[test]
    fn what_is_no_number_or_too_large_is_left_to_the_solver() {
        assert!(rejected(9.0, DVec3::Z));
        assert!(!rejected(f64::NAN, DVec3::Z));
        assert!(!rejected(f64::INFINITY, DVec3::Z));
        assert!(!rejected(1e300, DVec3::new(1e30, 1e30, 1e30)));
    }
}
