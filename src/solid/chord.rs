//! The interval of a ray inside a convex solid, and the one step that turns it into hits.
//!
//! A solver returns the closed interval of `t` in which the ray's line is inside the solid, and
//! the part of the boundary that each end lies on. Hits then depend only on which parts exist
//! (caps) and on the ray's range, so closest hit, any hit and all hits share this file.
//!
//! The surface is a closed set, and a rim belongs to the cap. If the cap is absent, its rim is
//! still the edge of the wall: such an end is a hit of the side. A ray that runs *within* the
//! surface (in a cap's plane, or along the wall) touches it all along; the start of its range
//! is a hit if it lies between the ends.

use super::{Caps, Crossing, Part};
use crate::math::Real;

/// One end of a [`Chord`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChordEnd<S = f64> {
    /// The ray's parameter.
    pub t: S,
    /// The part of the solid's boundary, also if the surface lacks that part.
    pub part: Part,
    /// Whether the point is on a rim, and so on the wall too.
    pub on_rim: bool,
}

/// The interval in which a line is inside a closed convex solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chord<S = f64> {
    /// Where the ray enters.
    pub enter: ChordEnd<S>,
    /// Where the ray leaves, at a `t` that is not less than that of `enter`.
    pub leave: ChordEnd<S>,
    /// The part that contains the whole chord, if one does.
    pub lies_on: Option<Part>,
}

/// An intersection of a ray and a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intersection<S = f64> {
    /// The parameter of the whole ray.
    pub t: S,
    /// The parameter on the chord, before the shift.
    pub t_local: S,
    /// The part of the surface.
    pub part: Part,
    /// The direction of the crossing.
    pub crossing: Crossing,
}

impl<S: Real> Chord<S> {
    /// The chord of a line across the axis, from wall to wall: in the plane of a disk, or
    /// between the disks.
    #[inline]
    pub(super) fn across(ends: [S; 2], disk: Option<Part>) -> Self {
        let [enter, leave] = ends.map(|t| ChordEnd {
            t,
            part: disk.unwrap_or(Part::Side),
            on_rim: disk.is_some(),
        });
        Self {
            enter,
            leave,
            lies_on: disk,
        }
    }

    /// The intersections of the ray with the surface that has the disks `caps`: those with
    /// `t_min <= t + shift <= t_max`, in order, at most two.
    ///
    /// The range is that of the whole ray; `shift` is the position of the chord's `t = 0` on
    /// it: 0 unless the solver was given a point farther along the ray. A tangent is an entry
    /// and an exit at the same `t`.
    #[inline]
    pub fn intersections(
        &self,
        caps: Caps,
        shift: S,
        t_min: S,
        t_max: S,
    ) -> impl Iterator<Item = Intersection<S>> + use<S> {
        let enter = self.entry(caps, shift, t_min, t_max);
        let leave = self.exit(caps, shift, t_min, t_max);
        enter.into_iter().chain(leave)
    }

    /// The first of [`Chord::intersections`].
    #[inline(always)]
    #[must_use]
    pub fn first(&self, caps: Caps, shift: S, t_min: S, t_max: S) -> Option<Intersection<S>> {
        self.entry(caps, shift, t_min, t_max)
            .or_else(|| self.exit(caps, shift, t_min, t_max))
    }

    #[inline]
    fn entry(&self, caps: Caps, shift: S, t_min: S, t_max: S) -> Option<Intersection<S>> {
        if let Some(part) = self.lies_on
            && exists(part, caps)
            && self.contains(t_min - shift)
            && t_min <= t_max
        {
            return Some(Intersection {
                t: t_min,
                t_local: t_min - shift,
                part,
                crossing: Crossing::Enter,
            });
        }
        self.enter
            .intersection(Crossing::Enter, caps, shift, t_min, t_max)
    }

    #[inline]
    fn exit(&self, caps: Caps, shift: S, t_min: S, t_max: S) -> Option<Intersection<S>> {
        self.leave
            .intersection(Crossing::Leave, caps, shift, t_min, t_max)
    }

    /// Whether `t` is strictly between the entry and the exit. At the exit, the exit is the
    /// hit.
    fn contains(&self, t: S) -> bool {
        self.enter.t < t && t < self.leave.t
    }
}

impl<S: Real> ChordEnd<S> {
    /// The end, moved to `t` if it is before that.
    #[inline(always)]
    pub(super) fn not_before(self, t: S) -> Self {
        Self {
            t: if self.t < t { t } else { self.t },
            ..self
        }
    }

    /// The end as an intersection, if the surface exists there and `t` is in range.
    #[inline(always)]
    pub(super) fn intersection(
        &self,
        crossing: Crossing,
        caps: Caps,
        shift: S,
        t_min: S,
        t_max: S,
    ) -> Option<Intersection<S>> {
        let part = self.present(caps)?;
        self.is_in_range(shift, t_min, t_max)
            .then_some(Intersection {
                t: self.t + shift,
                t_local: self.t,
                part,
                crossing,
            })
    }

    /// Whether [`ChordEnd::intersection`] returns an intersection.
    #[inline(always)]
    pub(super) fn is_hit(&self, caps: Caps, shift: S, t_min: S, t_max: S) -> bool {
        (exists(self.part, caps) | self.on_rim) & self.is_in_range(shift, t_min, t_max)
    }

    #[inline(always)]
    fn is_in_range(&self, shift: S, t_min: S, t_max: S) -> bool {
        let t = self.t + shift;
        (t_min <= t) & (t <= t_max)
    }

    /// The part of the surface that this end lies on, if any.
    #[inline]
    fn present(&self, caps: Caps) -> Option<Part> {
        if exists(self.part, caps) {
            Some(self.part)
        } else {
            self.on_rim.then_some(Part::Side)
        }
    }
}

/// Whether a surface with these caps has this part: all parts exist except disks that `caps`
/// excludes.
#[inline]
fn exists(part: Part, caps: Caps) -> bool {
    ((part != Part::Cap0) | caps.at_p0()) & ((part != Part::Cap1) | caps.at_p1())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chord(enter: (f64, Part), leave: (f64, Part)) -> Chord {
        let end = |(t, part)| ChordEnd {
            t,
            part,
            on_rim: false,
        };
        Chord {
            enter: end(enter),
            leave: end(leave),
            lies_on: None,
        }
    }

    #[test]
    fn first_outside_the_range_takes_the_exit() {
        let chord = chord((1.0, Part::Cap0), (2.0, Part::Side));
        let hit = chord.first(Caps::Both, 0.0, 1.5, 9.0).unwrap();
        assert_eq!(
            (hit.t, hit.part, hit.crossing),
            (2.0, Part::Side, Crossing::Leave)
        );
        assert_eq!(chord.first(Caps::Both, 0.0, 1.5, 1.9), None);
        assert_eq!(chord.first(Caps::Both, 0.0, 1.0, 1.0).unwrap().t, 1.0);
    }

    #[test]
    fn shift_moves_the_chord_within_the_range() {
        let chord = chord((1.0, Part::Cap0), (2.0, Part::Side));
        assert_eq!(
            chord.first(Caps::Both, 10.0, 11.0, 11.0).unwrap().t_local,
            1.0
        );
        assert_eq!(
            chord.first(Caps::Both, 10.0, 11.5, 13.0).unwrap().t_local,
            2.0
        );
        assert_eq!(chord.first(Caps::Both, 10.0, 0.0, 9.0), None);
    }

    #[test]
    fn absent_cap_lets_the_ray_through_but_keeps_its_rim() {
        let mut chord = chord((1.0, Part::Cap0), (2.0, Part::Cap1));
        assert_eq!(chord.first(Caps::None, 0.0, 0.0, 9.0), None);
        assert_eq!(
            chord.first(Caps::P1, 0.0, 0.0, 9.0).unwrap().part,
            Part::Cap1
        );
        chord.enter.on_rim = true;
        assert_eq!(
            chord.first(Caps::None, 0.0, 0.0, 9.0).unwrap().part,
            Part::Side
        );
        assert_eq!(
            chord.first(Caps::P0, 0.0, 0.0, 9.0).unwrap().part,
            Part::Cap0
        );
    }

    #[test]
    fn ray_within_the_surface_hits_at_the_start_of_its_range() {
        let mut chord = chord((1.0, Part::Cap0), (3.0, Part::Cap0));
        chord.lies_on = Some(Part::Cap0);
        assert_eq!(chord.first(Caps::Both, 0.0, 2.0, 9.0).unwrap().t, 2.0);
        assert_eq!(chord.first(Caps::Both, 0.0, 0.0, 9.0).unwrap().t, 1.0);
        assert_eq!(chord.first(Caps::P1, 0.0, 2.0, 9.0), None);
        assert_eq!(chord.first(Caps::Both, 0.0, 3.5, 9.0), None);
    }

    #[test]
    fn ray_along_the_wall_from_its_end_hits_the_cap_there() {
        let mut chord = chord((1.0, Part::Cap0), (3.0, Part::Cap1));
        chord.lies_on = Some(Part::Side);
        chord.leave.on_rim = true;
        let parts = |caps, t_min| {
            let hits = chord.intersections(caps, 0.0, t_min, 9.0);
            hits.map(|hit| (hit.t, hit.part)).collect::<Vec<_>>()
        };
        let ends = [(2.0, Part::Side), (3.0, Part::Cap1)];
        assert_eq!(parts(Caps::Both, 2.0), ends);
        assert_eq!(parts(Caps::Both, 3.0), ends[1..]);
        assert_eq!(parts(Caps::P0, 3.0), [(3.0, Part::Side)]);
    }
}
