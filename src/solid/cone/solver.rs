//! Ray against cone: the wall's interval, cut by the disks.
//!
//! `wall.rs` finds where the line is inside the infinite wall; that is overlapped
//! with the slab between the disks by where the roots lie to the disks' planes
//! (`heights.rs`). The other nappe lies beyond the apex, so outside of the slab.

use std::cmp::Ordering::{Equal, Greater, Less};

use glam::DVec3;

use super::heights::{End, Heights, Root};
use super::wall::{Inside, Meets, Taper};
use crate::solid::Part;
use crate::solid::chord::{Chord, ChordEnd};
use crate::solid::way::Way;

/// The interval in which the line `p0 + x + t d` is inside the closed cone with this wall.
pub(super) fn chord<A: Way>(taper: &Taper<A>, x: impl Way, d: DVec3) -> Option<Chord> {
    let meets = taper.meets(x, d)?;
    let heights = Heights::new(taper, x, d);
    match meets {
        Meets::Along => Some(along(&heights, Part::Side)),
        Meets::Inside(inside) if heights.slope == 0.0 => across(&heights, inside),
        Meets::Inside(inside) => oblique(&heights, inside),
    }
}

/// The part at an end.
fn part_at(end: End) -> Part {
    match end {
        End::First => Part::Cap0,
        End::Second => Part::Cap1,
    }
}

/// The ends in the order in which the line comes through their planes.
fn in_order(heights: &Heights<impl Way, impl Way>) -> (End, End) {
    if heights.slope > 0.0 {
        (End::First, End::Second)
    } else {
        (End::Second, End::First)
    }
}

/// The chord of a line of the wall, from end to end; it lies on `part`.
pub(in crate::solid) fn along(heights: &Heights<impl Way, impl Way>, part: Part) -> Chord {
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

/// The chord of a line across the axis: from wall to wall at one height, which may
/// be that of a disk.
fn across(heights: &Heights<impl Way, impl Way>, inside: Inside) -> Option<Chord> {
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
    let end = |t| ChordEnd {
        t,
        part: disk.unwrap_or(Part::Side),
        on_rim: disk.is_some(),
    };
    Some(Chord {
        enter: end(inside.enter),
        leave: end(inside.leave.max(inside.enter)),
        lies_on: disk,
    })
}

/// The chord of any other line.
fn oblique(heights: &Heights<impl Way, impl Way>, inside: Inside) -> Option<Chord> {
    let (near, far) = in_order(heights);
    // How far the line has come, as seen in its own direction.
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
    // A root that is not cut off is on the wall, or on the rim of the disk through
    // which the line would otherwise go the other way.
    let on_wall = |t, other, is_at_other| ChordEnd {
        // The plane's, so that a line turned round has the same.
        t: if is_at_other { heights.at(other) } else { t },
        part: if is_at_other {
            part_at(other)
        } else {
            Part::Side
        },
        on_rim: is_at_other,
    };
    // A line that leaves where it enters only touches a rim; both ends are on it.
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
        // At an edge the two may come out in the wrong order by a rounding.
        leave: ChordEnd {
            t: leave.t.max(enter.t),
            ..leave
        },
        lies_on: None,
    })
}
