//! The first point of the surface, decided by signs alone.
//!
//! In the notation of `triple_product`, with `S = |a|² D`, the roots of the wall are
//! `(-(m·n) ∓ √S) / |n|²`. Multiplied by `|n|² > 0`, every comparison of them has the form
//! `p + q √S`:
//!
//! - the axial position: `y |n|² = x·a |n|² - (m·n) d·a ∓ d·a √S`;
//! - the range: `(t - t_min) |n|² = -(m·n) - t_min |n|² ∓ √S`.
//!
//! The line intersects the planes of the disks at `-(x·a) / (d·a)` and `(a·a - x·a) / (d·a)`.

use std::cmp::Ordering::{self, Equal, Greater, Less};

use glam::DVec3;

use super::{Number, cross, difference, dot};
use crate::math::Ray;
use crate::solid::offset::{Between, Offset};
use crate::solid::{Caps, Crossing, Cylinder, Part};

/// The formula of the parameter of the first hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum At {
    /// The root of the wall with the minus sign.
    FirstRoot,
    /// The root with the plus sign.
    SecondRoot,
    /// The intersection with the plane of the disk at `p0`.
    Plane0,
    /// The intersection with the plane of the disk at `p1`.
    Plane1,
    /// The start of the range, for a line within the surface.
    Start,
}

/// The first hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Decision {
    pub at: At,
    pub part: Part,
    pub crossing: Crossing,
}

/// The quantities of the triple-product solver as numbers `N`.
pub(super) struct Terms<N> {
    pub nn: N,
    pub mn: N,
    pub aa: N,
    pub ya: N,
    pub yd: N,
    /// `|m|² - radius² |a|²`.
    pub outside: N,
    /// `|a|² D`.
    pub s: N,
}

impl<N: Number> Terms<N> {
    pub fn new(cylinder: &Cylinder, x: &impl Offset, direction: DVec3) -> Self {
        let a: [N; 3] = difference(cylinder.p1(), cylinder.p0());
        let x = x.exactly();
        let d = direction.to_array().map(N::of);
        let r = N::of(cylinder.radius());
        let (n, m) = (cross(&a, &d), cross(&a, &x));
        let (nn, mn, w) = (dot(&n, &n), dot(&m, &n), dot(&x, &n));
        let (aa, ya, yd) = (dot(&a, &a), dot(&x, &a), dot(&d, &a));
        let rr = r.times(&r);
        let discriminant = rr.times(&nn).minus(&w.times(&w));
        Self {
            outside: dot(&m, &m).minus(&rr.times(&aa)),
            s: aa.times(&discriminant),
            nn,
            mn,
            aa,
            ya,
            yd,
        }
    }

    /// Compares the parameter of a point of the line with `limit`.
    ///
    /// # Panics
    /// For the start of the range, which is not computed.
    pub fn compare(&self, at: At, limit: &N) -> Option<Ordering> {
        let height = match at {
            At::Start => panic!("the start of the range is not computed"),
            At::FirstRoot | At::SecondRoot => {
                let p = self.mn.plus(&limit.times(&self.nn));
                return self.at_root(&N::of(0.0).minus(&p), &N::of(1.0), at);
            }
            At::Plane0 => N::of(0.0).minus(&self.ya),
            At::Plane1 => self.aa.minus(&self.ya),
        };
        let beyond = height.minus(&limit.times(&self.yd)).sign()?;
        Some(match self.yd.sign()? {
            Less => beyond.reverse(),
            _ => beyond,
        })
    }

    /// The sign of `p ∓ q √s` at the first or second root.
    fn at_root(&self, p: &N, q: &N, root: At) -> Option<Ordering> {
        let q_sign = match root {
            At::FirstRoot => q.sign()?.reverse(),
            _ => q.sign()?,
        };
        let (p_sign, s_sign) = (p.sign()?, self.s.sign()?);
        let root_sign = if s_sign == Equal { Equal } else { q_sign };
        match (p_sign, root_sign) {
            (Equal, other) | (other, Equal) => Some(other),
            (p_sign, root_sign) if p_sign == root_sign => Some(p_sign),
            _ => {
                let squares = p.times(p).minus(&q.times(q).times(&self.s));
                Some(match squares.sign()? {
                    Greater => p_sign,
                    Less => root_sign,
                    Equal => Equal,
                })
            }
        }
    }
}

/// The decision in the numbers `N`: the first hit, or a miss. `None` if the numbers are not
/// certain enough.
pub(super) fn decide<N: Number>(cylinder: &Cylinder, ray: &Ray) -> Option<Option<Decision>> {
    let x = Between {
        from: cylinder.p0(),
        to: ray.origin,
    };
    let terms = Terms::<N>::new(cylinder, &x, ray.direction);
    let Some(ends) = terms.ends()? else {
        return Some(None);
    };
    let case = Case {
        terms,
        caps: cylinder.caps(),
        ray,
    };
    case.first(&ends)
}

/// A point where the line enters or leaves.
#[derive(Clone, Copy)]
pub(super) struct End {
    pub at: At,
    pub part: Part,
    pub on_rim: bool,
    /// Whether the other end is on this one's rim, so that the line only touches it.
    pub touches: bool,
}

/// Both ends, and the part that contains the line between them, if one does.
pub(super) struct Ends {
    pub enter: End,
    pub leave: End,
    pub lies_on: Option<Part>,
}

/// A decision; `None` means uncertainty.
pub(super) type Certain<T> = Option<T>;

impl<N: Number> Terms<N> {
    /// The points where the line enters and leaves the closed solid, if it intersects it.
    pub fn ends(&self) -> Certain<Option<Ends>> {
        match self.nn.sign()? {
            Equal => self.parallel_ends(),
            _ if self.s.sign()? == Less => Some(None),
            _ if self.yd.sign()? == Equal => self.perpendicular_ends(),
            _ => self.oblique_ends(),
        }
    }

    /// A line along the axis.
    fn parallel_ends(&self) -> Certain<Option<Ends>> {
        let on_rim = match self.outside.sign()? {
            Greater => return Some(None),
            to_wall => to_wall == Equal,
        };
        let plane = |at, part| End {
            at,
            part,
            on_rim,
            touches: false,
        };
        let ends = [plane(At::Plane0, Part::Cap0), plane(At::Plane1, Part::Cap1)];
        let lies_on = on_rim.then_some(Part::Side);
        Some(Some(self.in_order(ends, lies_on)?))
    }

    /// The ends at the disks in their order along the line.
    fn in_order(&self, [cap0, cap1]: [End; 2], lies_on: Option<Part>) -> Certain<Ends> {
        let (enter, leave) = match self.yd.sign()? {
            Greater => (cap0, cap1),
            _ => (cap1, cap0),
        };
        Some(Ends {
            enter,
            leave,
            lies_on,
        })
    }

    /// A line across the axis.
    fn perpendicular_ends(&self) -> Certain<Option<Ends>> {
        let (ya, beyond) = (&self.ya, self.ya.minus(&self.aa));
        let disk = match (ya.sign()?, beyond.sign()?) {
            (Less, _) | (_, Greater) => return Some(None),
            (Equal, _) => Some(Part::Cap0),
            (_, Equal) => Some(Part::Cap1),
            _ => None,
        };
        let end = |at| End {
            at,
            part: disk.unwrap_or(Part::Side),
            on_rim: disk.is_some(),
            touches: false,
        };
        Some(Some(Ends {
            enter: end(At::FirstRoot),
            leave: end(At::SecondRoot),
            lies_on: disk,
        }))
    }

    /// Any other line: each end is on the wall or on a disk.
    fn oblique_ends(&self) -> Certain<Option<Ends>> {
        let Terms {
            nn, mn, aa, ya, yd, ..
        } = self;
        // y |n|² = p0 ∓ yd √s, and from the other disk p1 ∓ yd √s.
        let p0 = ya.times(nn).minus(&mn.times(yd));
        let p1 = p0.minus(&aa.times(nn));
        let forward = yd.sign()? == Greater;
        // The position of the point at a root relative to the first disk along the line (Less
        // is outside of the solid) and to the last.
        let to_first = |root| {
            if forward {
                self.at_root(&p0, yd, root)
            } else {
                Some(self.at_root(&p1, yd, root)?.reverse())
            }
        };
        let to_last = |root| {
            if forward {
                self.at_root(&p1, yd, root)
            } else {
                Some(self.at_root(&p0, yd, root)?.reverse())
            }
        };
        let disk0 = (At::Plane0, Part::Cap0);
        let disk1 = (At::Plane1, Part::Cap1);
        let (first_disk, last_disk) = if forward {
            (disk0, disk1)
        } else {
            (disk1, disk0)
        };
        // A root outside of the disk on its side is cut off by that disk's plane; a root on the
        // plane of either disk is on its rim.
        let end = |root, outside: Ordering, (to_near, near), (to_far, far), touches| {
            let (near_plane, near_cap): (At, Part) = near;
            let (_, far_cap): (At, Part) = far;
            let (at, part, on_rim) = if to_near == outside {
                (near_plane, near_cap, false)
            } else if to_near == Equal {
                (near_plane, near_cap, true)
            } else if to_far == Equal {
                (root, far_cap, true)
            } else {
                (root, Part::Side, false)
            };
            End {
                at,
                part,
                on_rim,
                touches: touches && to_near == outside,
            }
        };
        let heights = |root| Some((to_first(root)?, to_last(root)?));
        let (enter_first, enter_last) = heights(At::FirstRoot)?;
        let (leave_first, leave_last) = heights(At::SecondRoot)?;
        if enter_last == Greater || leave_first == Less {
            return Some(None);
        }
        Some(Some(Ends {
            enter: end(
                At::FirstRoot,
                Less,
                (enter_first, first_disk),
                (enter_last, last_disk),
                leave_first == Equal,
            ),
            leave: end(
                At::SecondRoot,
                Greater,
                (leave_last, last_disk),
                (leave_first, first_disk),
                enter_last == Equal,
            ),
            lies_on: None,
        }))
    }
}

struct Case<'a, N> {
    terms: Terms<N>,
    caps: Caps,
    ray: &'a Ray,
}

impl<N: Number> Case<'_, N> {
    /// Compares the parameter of an end with a limit of the range.
    fn compare(&self, at: At, limit: f64) -> Certain<Ordering> {
        if limit.is_infinite() {
            return Some(if limit > 0.0 { Less } else { Greater });
        }
        self.terms.compare(at, &N::of(limit))
    }

    /// The first end that is on the surface and in the range.
    fn first(&self, ends: &Ends) -> Certain<Option<Decision>> {
        let (t_min, t_max) = (self.ray.t_min, self.ray.t_max);
        if let Some(part) = ends.lies_on
            && self.part_there(part).is_some()
            && self.compare(ends.enter.at, t_min)? == Less
            && self.compare(ends.leave.at, t_min)? == Greater
        {
            return Some(Some(Decision {
                at: At::Start,
                part,
                crossing: Crossing::Enter,
            }));
        }
        for (end, crossing) in [(ends.enter, Crossing::Enter), (ends.leave, Crossing::Leave)] {
            let on_wall = end.on_rim.then_some(Part::Side);
            let Some(part) = self.part_there(end.part).or(on_wall) else {
                continue;
            };
            if self.compare(end.at, t_min)? != Less && self.compare(end.at, t_max)? != Greater {
                return Some(Some(Decision {
                    at: end.at,
                    part,
                    crossing,
                }));
            }
        }
        Some(None)
    }

    /// The part, if the surface has it.
    fn part_there(&self, part: Part) -> Option<Part> {
        let is_there = match part {
            Part::Side => true,
            Part::Cap0 => self.caps.at_p0(),
            Part::Cap1 => self.caps.at_p1(),
            part => part.not_of_a_cylinder(),
        };
        is_there.then_some(part)
    }
}
