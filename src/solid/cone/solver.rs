//! Ray against cone: the wall's interval, cut by the discs.
//!
//! `wall.rs` finds where the line is inside the infinite wall, `slab.rs` overlaps
//! that with the slab between the discs: the other nappe lies beyond the apex, so
//! outside of the slab. A cone with equal radii is left to the triple-product
//! solver, whose answers it has bit for bit.
//!
//! Where a radius is zero the disc is the apex, a point of every line of the
//! wall. Rounded heights cannot tell whether a line goes through it, so that is
//! decided exactly: by `|x × d|² = 0`, `x` as seen from the apex. It is asked only
//! where `E` of the wall is zero, which tangents and such lines have in common.

use std::cmp::Ordering;

use glam::DVec3;

use super::Cone;
use super::wall::{Fit, Inside, Meets, Taper};
use crate::solid::chord::{Chord, ChordEnd};
use crate::solid::exact::{Expression, Number, cross, dot, sign, vector};
use crate::solid::slab::{Question, WholeChord};
use crate::solid::{Caps, Cylinder, Part, triple_product};

/// The interval in which the line `p0 + x + t d` is inside the closed cone.
pub(super) fn chord(cone: &Cone, x: DVec3, d: DVec3) -> Option<Chord> {
    if cone.radius0 == cone.radius1 {
        let cylinder = Cylinder::from_valid(cone.p0, cone.p1, cone.radius0, Caps::Both);
        return triple_product::chord(&cylinder, x, d);
    }
    let taper = cone.taper();
    let slab = taper.slab(x, d);
    match taper.meets(x, d)? {
        Meets::Along => slab.along(true),
        Meets::Inside(inside) => match apex(cone, x, d, &inside) {
            Some(end) if inside.enter.is_finite() && inside.leave.is_finite() => Some(Chord {
                enter: end,
                leave: end,
                lies_on: None,
            }),
            Some(end) => Some(from_apex(end, slab.along(false)?)),
            None => WholeChord.of_overlap(&slab.overlap(inside)),
        },
    }
}

/// The chord of a line through both discs, of which one is the apex.
fn from_apex(apex: ChordEnd, chord: Chord) -> Chord {
    if chord.enter.part == apex.part {
        Chord {
            enter: apex,
            ..chord
        }
    } else {
        Chord {
            leave: apex,
            ..chord
        }
    }
}

/// Where the line goes through the apex, if it is an end of the cone.
fn apex(cone: &Cone, x: DVec3, d: DVec3, inside: &Inside) -> Option<ChordEnd> {
    if !inside.is_single {
        return None;
    }
    let (x, part) = if cone.radius0 == 0.0 {
        (x, Part::Cap0)
    } else if cone.radius1 == 0.0 {
        (x - (cone.p1 - cone.p0), Part::Cap1)
    } else {
        return None;
    };
    (sign(&PassesZero { x, d }) == Ordering::Equal).then(|| ChordEnd {
        t: -x.dot(d) / d.dot(d),
        part,
        on_rim: true,
    })
}

/// `|x × d|²`.
struct PassesZero {
    x: DVec3,
    d: DVec3,
}

impl Expression for PassesZero {
    fn value<N: Number>(&self) -> N {
        let l = cross::<N>(&vector(self.x), &vector(self.d));
        dot(&l, &l)
    }
}

impl Cone {
    /// Its wall.
    fn taper(&self) -> Taper {
        Taper {
            a: self.p1 - self.p0,
            radius0: self.radius0,
            radius1: self.radius1,
            fit: Fit::Discs,
        }
    }
}
