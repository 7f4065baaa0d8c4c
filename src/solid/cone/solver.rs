//! Ray against cone: the wall's interval, cut by the disks.
//!
//! `wall.rs` computes the interval in which the line is inside the infinite wall. Comparing the
//! heights of its ends with the disks' planes (`heights.rs`) intersects it with the slab
//! between the disks. The other nappe is beyond the apex, and so outside of the slab.

use std::cmp::Ordering::{Equal, Greater, Less};

use glam::DVec3;

use super::heights::{End, Heights, Root};
use super::roots::Inside;
use super::taper::Taper;
use super::wall::WallIntersection;
use crate::solid::Part;
use crate::solid::chord::{Chord, ChordEnd};
use crate::solid::offset::Offset;

/// The interval in which the line `p0 + x + t d` is inside the closed cone with this wall.
pub(super) fn chord<A: Offset>(taper: &Taper<A>, x: impl Offset, d: DVec3) -> Option<Chord> {
    let hit = taper.intersect(x, d)?;
    let heights = Heights::new(taper, x, d);
    match hit {
        WallIntersection::Along => Some(along(&heights, Part::Side)),
        WallIntersection::Inside(inside) if heights.slope == 0.0 => across(&heights, inside),
        WallIntersection::Inside(inside) => oblique(&heights, inside),
    }
}

/// The part at an end.
fn part_at(end: End) -> Part {
    match end {
        End::First => Part::Cap0,
        End::Second => Part::Cap1,
    }
}

/// The ends in the order in which the line crosses their planes.
fn in_order(heights: &Heights<impl Offset, impl Offset>) -> (End, End) {
    if heights.slope > 0.0 {
        (End::First, End::Second)
    } else {
        (End::Second, End::First)
    }
}

/// The chord of a ruling of the wall, from end to end; it lies on `part`.
pub(in crate::solid) fn along(heights: &Heights<impl Offset, impl Offset>, part: Part) -> Chord {
    let (near, far) = in_order(heights);
    let rim = |end| ChordEnd {
        t: heights.at(end),
        part: part_at(end),
        on_rim: true,
    };
    Chord {
        enter: rim(near),
        leave: rim(far),
        lies_on: Some(part),
    }
}

/// The chord of a line across the axis: from wall to wall at one height, which may be that of a
/// disk.
fn across(heights: &Heights<impl Offset, impl Offset>, inside: Inside) -> Option<Chord> {
    let [above0, above1] = heights.above;
    if above0 < 0.0 || above1 > 0.0 {
        return None;
    }
    let disk = if above0 == 0.0 {
        Some(Part::Cap0)
    } else if above1 == 0.0 {
        Some(Part::Cap1)
    } else {
        None
    };
    let leave = inside.leave.max(inside.enter);
    Some(Chord::across([inside.enter, leave], disk))
}

/// The chord of any other line.
fn oblique(heights: &Heights<impl Offset, impl Offset>, inside: Inside) -> Option<Chord> {
    let (near, far) = in_order(heights);
    // The height of a root compared with an end, in the direction of the line.
    let passed = |root, t, end| {
        let above = heights.compare(root, t, end);
        if heights.slope > 0.0 {
            above
        } else {
            above.reverse()
        }
    };
    let enter = |end| passed(Root::Enter, inside.enter, end);
    let leave = |end| passed(Root::Leave, inside.leave, end);
    if enter(far) == Greater || leave(near) == Less {
        return None;
    }
    let on_disk = |end, on_rim| ChordEnd {
        t: heights.at(end),
        part: part_at(end),
        on_rim,
    };
    // A root that is not cut off is on the wall, or on the rim of the other disk, through which
    // the line would pass in the other direction.
    let on_wall = |t, other, is_at_other| ChordEnd {
        // The `t` of the plane, so that the reversed line has the same.
        t: if is_at_other { heights.at(other) } else { t },
        part: if is_at_other {
            part_at(other)
        } else {
            Part::Side
        },
        on_rim: is_at_other,
    };
    // A line that leaves where it enters only touches a rim; then both ends are on it.
    let (touches_near, touches_far) = (leave(near) == Equal, enter(far) == Equal);
    let enter = match enter(near) {
        Greater => on_wall(inside.enter, far, touches_far),
        to_rim => on_disk(near, to_rim == Equal || touches_near),
    };
    let leave = match leave(far) {
        Less => on_wall(inside.leave, near, touches_near),
        to_rim => on_disk(far, to_rim == Equal || touches_far),
    };
    Some(Chord {
        enter,
        // At an edge, rounding may put the two in the wrong order.
        leave: ChordEnd {
            t: leave.t.max(enter.t),
            ..leave
        },
        lies_on: None,
    })
}
