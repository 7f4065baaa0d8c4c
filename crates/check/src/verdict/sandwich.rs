//! Bounds of the first hit from the crossings of two meshes around it.
//!
//! For a solid `C` with caps at both ends, let the *inner* mesh be a subset of
//! it and the *outer* one a superset, both convex. The line of a ray is inside each
//! in an interval, and they are nested:
//!
//! ```text
//! outer [a, b]  ⊇  solid [e, l]  ⊇  inner [c, d]
//! ```
//!
//! The first hit of the solid's surface from `t_min` on is `e` if
//! `e >= t_min`, else `l` if `l >= t_min`. Only crossings at or after `t_min` are
//! known, and they determine where the ray starts:
//!
//! - *outside the outer mesh* (`a` comes first): `e >= a`. If the ray enters the inner mesh
//!   at `c`, then `e <= c`; else it may miss the solid.
//! - *inside the inner mesh* (`b` and `d` are known, `c` is not): the ray starts
//!   in the solid, and the first hit is `l`, `d <= l <= b`: the roles swap.
//! - *between both* (`b` is known, `a` is not): the ray starts in the solid or
//!   before it. If it enters the inner mesh, it leaves the solid after
//!   `t_min`, so a first hit is at most `b`; else there may be none. The lower bound is
//!   `t_min`.
//! - If the ray misses the outer mesh, it misses the solid.
//!
//! *Faces.* A side of a mesh of f32 vertices is two triangles that are not
//! quite in one plane, so a line may cross the surface more than twice. The bounds above
//! stay true: an outer mesh is the surface of a star-shaped body that
//! contains the solid (`bounding_meshes::hull::proof`), so `a`, its first entry, is not behind the
//! solid, nor its last exit `b` before the solid's end. Each point of the inner
//! mesh's triangles is between its vertices and hence in the solid, so any
//! entry is at or after `e`, any exit at or before `l`. A ray starts inside a
//! mesh if an exit comes before any entry. If both coincide, where two
//! faces join, it may start on either side: it counts as inside of an outer
//! mesh and outside of an inner one, which claims less.
//!
//! *Tubes.* Without one of its disks the surface is a part of the boundary of
//! `C`: a first hit is that of the boundary or later, so the lower bounds stay true.
//! A crossing of the boundary between two parameters is on the surface unless it
//! is in the open disk that is missing. That lies in a plane with `C` on one
//! side. Going in between `a` and `c`, the ray starts at `a`; if the point at
//! `a` is strictly on the solid's side of the plane, the ray stays strictly
//! there up to `c`, which is in the solid, or reaches the plane at `c` itself,
//! and then enters there through the rim, which belongs to the wall. So the
//! entry is *certain* if the point at `a` is strictly on the solid's side of
//! the planes of all missing disks, and, by the same argument backwards, the
//! exit between `d` and `b` if the point at `b` is. If the entry is not
//! certain, a certain exit still is a hit: the upper bound is `b`.
//!
//! *Disks* have no inside; in place of an inner mesh they have two sheets (`hull`). A
//! ray that crosses both from `t_min` on, in either order, hits the disk between the two.
//! Other crossings of the sheets prove nothing. The ray does not hit the
//! disk before it enters the mesh around it, nor after it leaves it. The sheets may be within
//! that mesh or beyond it.
//!
//! *Many solids.* The first hit of all is between the least lower and the least
//! upper bound.
//!
//! *Partial traversal.* To settle an answer `t <= T`, crossings beyond some `T` may be left
//! out. A mesh that the ray enters and does not leave by then is left *later*.
//! An unknown bound is above `T`, hence above `t`: an upper one allows
//! `t`, and a solid whose lower one is unknown cannot come before it. A solid
//! that starts around the ray and ends after `T` is not found either; it has
//! `t_min` for a lower and more than `T` for an upper bound, and both allow `t`.
//! So an answer that agrees with the partial bounds agrees with those of the whole ray. The
//! converse is not true, and other answers are judged by the whole ray.

use crate::bounding_meshes::crossings::{Crossings, LATER};

/// The parameters between which a first hit is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    /// No hit is before this; infinite without a hit.
    pub low: f64,
    /// There is a hit up to here; infinite if there may be none.
    pub high: f64,
}

impl Interval {
    /// There is no hit.
    pub const NOTHING: Self = Self {
        low: f64::INFINITY,
        high: f64::INFINITY,
    };

    /// The bounds of the first of two first hits.
    pub fn first(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.min(other.high),
        }
    }

    /// Whether a hit and a miss are both allowed for a ray that ends at `t_max`.
    pub fn is_open(&self, t_max: f64) -> bool {
        self.low <= t_max && self.low < f64::INFINITY && self.allows(None, t_max)
    }

    /// Whether an answer for a ray that ends at `t_max` is allowed.
    pub fn allows(&self, t: Option<f64>, t_max: f64) -> bool {
        match t {
            Some(t) => self.low <= t && t <= self.high && t <= t_max,
            None => self.high > t_max || self.high == f64::INFINITY,
        }
    }
}

/// The bounds from both meshes of one solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SolidBounds {
    /// Of the first hit of this solid.
    pub interval: Interval,
    /// The crossing of the inner mesh next to the first hit, if the
    /// ray starts outside of the outer mesh or inside of the inner one and
    /// that crossing is certain.
    pub inner: Option<f64>,
    /// No hit of this solid is after this.
    pub last: f64,
    /// Whether the crossings contradict that the meshes are nested.
    pub is_odd: bool,
}

/// The bounds for one solid. `is_certain` says whether the point at a parameter
/// is strictly on the solid's side of the planes of its missing disks.
pub(crate) fn solid_bounds(
    outer: &Crossings,
    inner: &Crossings,
    t_min: f64,
    is_certain: impl Fn(f64) -> bool,
) -> SolidBounds {
    let bounds = |low, high, inner, is_odd| SolidBounds {
        interval: Interval { low, high },
        inner,
        last: outer.last_leave,
        is_odd,
    };
    if outer.is_none() {
        let is_odd = !inner.is_none();
        return bounds(f64::INFINITY, f64::INFINITY, None, is_odd);
    }
    let enters = inner.enter < f64::INFINITY && !inner.starts_inside();
    let exit = || {
        if is_certain(outer.last_leave) {
            outer.last_leave
        } else {
            f64::INFINITY
        }
    };
    if !outer.may_start_inside() {
        let is_certain_entry = enters && is_certain(outer.enter);
        let high = match (enters, is_certain_entry) {
            (_, true) => inner.enter,
            (true, false) => exit(),
            (false, false) => f64::INFINITY,
        };
        let is_odd = outer.leave == f64::INFINITY
            || inner.starts_inside()
            || (enters && (inner.enter < outer.enter || inner.leave == f64::INFINITY))
            || inner.last_leave > outer.last_leave;
        let inner = is_certain_entry.then_some(inner.enter);
        return bounds(outer.enter, high, inner, is_odd);
    }
    let is_odd = inner.last_leave > outer.last_leave || (enters && inner.leave == f64::INFINITY);
    if inner.starts_inside() {
        let (low, high) = (inner.last_leave, exit());
        bounds(low, high, high.is_finite().then_some(low), is_odd)
    } else if enters {
        bounds(t_min, exit(), None, is_odd)
    } else {
        bounds(t_min, f64::INFINITY, None, is_odd)
    }
}

/// The bounds for a disk. The entries of `sheets` are crossings of the upper one, the exits
/// of the lower one.
pub(crate) fn sheet_bounds(outer: &Crossings, sheets: &Crossings, t_min: f64) -> SolidBounds {
    let both = sheets.enter.max(sheets.leave);
    let is_through = both < LATER;
    let low = if outer.is_none() {
        f64::INFINITY
    } else if outer.may_start_inside() {
        t_min
    } else {
        outer.enter
    };
    SolidBounds {
        interval: Interval {
            low,
            high: if is_through {
                both.min(outer.last_leave)
            } else {
                f64::INFINITY
            },
        },
        inner: None,
        last: outer.last_leave,
        is_odd: is_through && outer.is_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossings(list: &[(f64, bool)]) -> Crossings {
        let mut crossings = Crossings::NONE;
        for &(t, enters) in list {
            crossings.add(t, enters);
        }
        crossings
    }

    fn both(outer: &[(f64, bool)], inner: &[(f64, bool)], certain: bool) -> (f64, f64) {
        let bounds = solid_bounds(&crossings(outer), &crossings(inner), 0.5, |_| certain);
        assert!(!bounds.is_odd, "{bounds:?}");
        (bounds.interval.low, bounds.interval.high)
    }

    #[test]
    fn starts_are_distinguished() {
        let (enter, leave) = (true, false);
        let outer = [(1.0, enter), (4.0, leave)];
        let inner = [(2.0, enter), (3.0, leave)];
        assert_eq!(both(&outer, &inner, true), (1.0, 2.0));
        assert_eq!(both(&outer, &[], true), (1.0, f64::INFINITY));
        assert_eq!(both(&outer[1..], &inner[1..], true), (3.0, 4.0));
        assert_eq!(both(&outer[1..], &inner, true), (0.5, 4.0));
        assert_eq!(both(&outer[1..], &[], true), (0.5, f64::INFINITY));
        assert_eq!(both(&[], &[], true), (f64::INFINITY, f64::INFINITY));
        // Through the missing disk.
        assert_eq!(both(&outer, &inner, false), (1.0, f64::INFINITY));
        assert_eq!(both(&outer[1..], &inner[1..], false), (3.0, f64::INFINITY));
    }

    #[test]
    fn ray_through_an_edge_may_start_on_either_side_of_it() {
        let (enter, leave) = (true, false);
        let fold = [(1.0, enter), (1.0, leave), (4.0, leave)];
        // The solid is left at 0.9, or entered at 2.
        assert_eq!(both(&fold, &[], true), (0.5, f64::INFINITY));
        let inner = [(2.0, enter), (3.0, leave)];
        assert_eq!(both(&fold, &inner, true), (0.5, 4.0));
        let inner_fold = [(2.0, enter), (2.0, leave), (3.0, leave)];
        let outer = [(1.0, enter), (4.0, leave)];
        assert_eq!(both(&outer, &inner_fold, true), (1.0, 2.0));
    }

    #[test]
    fn certain_exit_of_a_tube_is_a_hit() {
        let outer = crossings(&[(1.0, true), (4.0, false)]);
        let inner = crossings(&[(2.0, true), (3.0, false)]);
        let bounds = solid_bounds(&outer, &inner, 0.0, |t| t > 2.5);
        assert_eq!(bounds.interval.high, 4.0);
        assert_eq!(bounds.interval.low, 1.0);
    }

    #[test]
    fn disk_is_hit_between_both_sheets() {
        let (over, under) = (true, false);
        let outer = [(1.0, true), (4.0, false)];
        let high = |sheets: &[(f64, bool)]| {
            let bounds = sheet_bounds(&crossings(&outer), &crossings(sheets), 0.5);
            assert!(!bounds.is_odd, "{sheets:?}");
            assert_eq!(bounds.interval.low, 1.0);
            bounds.interval.high
        };
        assert_eq!(high(&[(2.0, over), (3.0, under)]), 3.0);
        assert_eq!(high(&[(2.0, under), (3.0, over)]), 3.0);
        // Sheets beyond the mesh around the disk.
        assert_eq!(high(&[(0.9, over), (4.1, under)]), 4.0);
        // Twice through a sheet that is bent.
        assert_eq!(high(&[(2.0, under), (3.0, under)]), f64::INFINITY);
        assert_eq!(high(&[(2.0, over), (3.0, over), (3.5, under)]), 3.5);
    }

    #[test]
    fn contradictions_are_odd() {
        let odd = |outer: &[(f64, bool)], inner: &[(f64, bool)]| {
            solid_bounds(&crossings(outer), &crossings(inner), 0.0, |_| true).is_odd
        };
        assert!(odd(&[], &[(1.0, true), (2.0, false)]));
        assert!(odd(&[(1.0, true)], &[]));
        assert!(odd(&[(1.0, true), (3.0, false)], &[(2.0, true)]));
        assert!(odd(&[(1.0, true), (3.0, false)], &[(2.0, false)]));
        assert!(odd(
            &[(1.0, true), (3.0, false)],
            &[(0.5, true), (2.0, false)]
        ));
    }
}
