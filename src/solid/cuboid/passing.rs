//! Lines that certainly pass by a cuboid, told without a division or a branch.
//!
//! A line misses the cuboid iff two of the intervals (1) of `chord.rs` are disjoint:
//! three intervals of which any two meet have a point in common. With `y_i = f_i·x` and
//! `e_i = f_i·d`, those of the axes j and k are disjoint iff
//!
//! ```text
//! |y_j e_k - y_k e_j| > h_j |e_k| + h_k |e_j|
//! ```
//!
//! also where an `e` is zero. Each `y` is off by at most `3 u |x|` and each `e` by `3 u
//! |d|`, u = 2^-53, so the left side by 15 u of `|x| |d|` and the right one by 5 u of
//! `(h_j + h_k) |d|`. Lengths are at most the sums of the sizes of their components,
//! which take no root.

use glam::DVec3;

use super::Cuboid;
use crate::math::power_of_two;

/// 16 u, doubled for the roundings of the sums.
const ROUNDINGS: f64 = power_of_two(-48);

/// Whether the line `centre + x + t d` certainly passes by. Says nothing if not, as for
/// what is not finite.
#[inline(always)]
pub(super) fn passes_by(cuboid: &Cuboid, x: DVec3, d: DVec3) -> bool {
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
    (beside.x > limit.x) | (beside.y > limit.y) | (beside.z > limit.z)
}
