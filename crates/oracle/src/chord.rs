//! The stretch of a line within a convex solid in exact numbers, and the points at
//! which a ray meets the surface.

use std::cmp::Ordering;

use super::cylinder::TrueHit;
use super::number::{Exact, ExactVector, Surd, exact, sign};
use super::ray::ExactRay;
use cyltrace::solid::{Crossing, Part};

/// The closed interval in which a line is within a closed convex solid.
#[derive(Clone, Debug)]
pub struct TrueChord {
    pub(super) enter: TrueEnd,
    pub(super) leave: TrueEnd,
    /// The part within which the whole chord runs, if it does.
    pub lies_on: Option<Part>,
}

/// An end of that interval.
#[derive(Clone, Debug)]
pub(super) struct TrueEnd {
    pub t: Surd,
    pub part: Part,
}

impl TrueChord {
    /// Where the line goes in and where it comes out, whatever the ray's range.
    #[must_use]
    pub fn ends(&self) -> [TrueHit; 2] {
        [
            self.enter.hit(Crossing::Enter),
            self.leave.hit(Crossing::Leave),
        ]
    }

    /// All points in the ray's range where it meets the surface, in order. A
    /// tangent is two at the same parameter. A ray within the surface touches it
    /// all the way: the start of its range counts as an entry if it lies between them.
    #[must_use]
    pub fn hits(&self, ray: &ExactRay) -> Vec<TrueHit> {
        let is_in_range = |end: &TrueEnd| {
            end.t.cmp_f64(ray.t_min) != Ordering::Less
                && end.t.cmp_f64(ray.t_max) != Ordering::Greater
        };
        let start_of_range = self.lies_on.filter(|_| {
            ray.t_min <= ray.t_max
                && self.enter.t.cmp_f64(ray.t_min) == Ordering::Less
                && self.leave.t.cmp_f64(ray.t_min) == Ordering::Greater
        });
        let mut hits = Vec::new();
        if let Some(part) = start_of_range {
            hits.push(TrueHit {
                t: exact(ray.t_min),
                part,
                crossing: Crossing::Enter,
            });
        } else if is_in_range(&self.enter) {
            hits.push(self.enter.hit(Crossing::Enter));
        }
        if is_in_range(&self.leave) {
            hits.push(self.leave.hit(Crossing::Leave));
        }
        hits
    }
}

impl TrueEnd {
    fn hit(&self, crossing: Crossing) -> TrueHit {
        TrueHit {
            t: self.t.value(),
            part: self.part,
            crossing,
        }
    }
}

/// Where the line `x + t d` enters and leaves the ball of a radius around zero: the
/// roots of `d·d t² + 2 x·d t + x·x - radius²`.
pub(super) fn in_ball(x: &ExactVector, d: &ExactVector, radius: &Exact) -> Option<[Surd; 2]> {
    let (a, b) = (d.dot(d), x.dot(d));
    let s = &b * &b - &a * (x.dot(x) - radius * radius);
    (sign(&s) != Ordering::Less).then(|| {
        [-1.0, 1.0].map(|q| Surd {
            p: -&b,
            q: exact(q),
            s: s.clone(),
            r: a.clone(),
        })
    })
}
