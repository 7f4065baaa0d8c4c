//! First order from normals in f64, which may be turned.
//!
//! Every piece may be turned by its θ ([`Piece`]). Pieces whose normals differ by less are one
//! circle, and crossings on a circle that may have one direction are one.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use smallvec::SmallVec;

use super::bend::Angles;
use super::circle::Circle;
use super::first_order::{FirstOrder, Place};
use super::piece::{Piece, Pieces};

/// Decides from the pieces alone.
pub(super) struct Turned<'a>(pub &'a Pieces);

/// A crossing of a group's circle with others.
struct Crossing {
    angle: f64,
    /// The error bound of the angle.
    error: f64,
    /// The groups that contain the direction; empty where only members change their order.
    groups: SmallVec<[usize; 4]>,
}

impl Crossing {
    /// Whether another may be the same direction; `turn` is added to its angle.
    fn is_one_with(&self, next: &Self, turn: f64) -> bool {
        next.angle + turn - self.angle <= self.error + next.error
    }

    fn merge(&mut self, other: Self) {
        // The angle of a crossing is preferred to that of a mere change of order.
        if self.groups.is_empty() {
            self.angle = other.angle;
        }
        self.error = self.error.max(other.error);
        for group in other.groups {
            if !self.groups.contains(&group) {
                self.groups.push(group);
            }
        }
    }
}

impl Turned<'_> {
    /// The directions on the circle of a group that bound its arcs, in order.
    fn bounds(
        &self,
        circle: &Circle,
        own: usize,
        others: &[usize],
        changes: &Angles,
    ) -> SmallVec<[Crossing; 8]> {
        let own = &self.0[own];
        let mut all = SmallVec::<[Crossing; 8]>::new();
        let mut add = |angle: f64, error: f64, group: Option<usize>| {
            let turns = libm::floor(angle / TAU);
            all.push(Crossing {
                angle: angle - TAU * turns,
                error,
                groups: group.into_iter().collect(),
            });
        };
        for &other in others {
            for (angle, error) in crossings(circle, own, &self.0[other]) {
                add(angle, error, Some(other));
            }
        }
        for &angle in changes {
            add(angle, own.turned, None);
        }
        all.sort_by(|one, other| one.angle.total_cmp(&other.angle));
        let mut merged = SmallVec::<[Crossing; 8]>::new();
        for crossing in all {
            match merged.last_mut() {
                Some(last) if last.is_one_with(&crossing, 0.0) => last.merge(crossing),
                _ => merged.push(crossing),
            }
        }
        // Around the circle the last may be the first.
        if merged.len() > 1 && merged[merged.len() - 1].is_one_with(&merged[0], TAU) {
            let last = merged.pop().expect("there are two");
            merged[0].merge(last);
        }
        merged
    }
}

impl FirstOrder for Turned<'_> {
    type Exact = ();
    const IS_EXACT: bool = false;

    fn are_one(&self, one: usize, other: usize) -> bool {
        self.0[one].is_tangent_to(&self.0[other])
    }

    fn for_each_place(
        &self,
        circle: &Circle,
        own: usize,
        others: &[usize],
        changes: &Angles,
        mut look: impl FnMut(&Place<()>),
    ) {
        let mut look = |direction: DVec3, groups: &[usize], error: f64| {
            look(&Place {
                direction,
                error,
                groups,
                exact: (),
            });
        };
        let crossings = self.bounds(circle, own, others, changes);
        let Some(last) = crossings.last() else {
            return look(circle.at(0.0), &[own], 0.0);
        };
        let mut before = last.angle - TAU;
        for crossing in crossings {
            let middle = 0.5 * (before + crossing.angle);
            look(circle.at(middle), &[own], 0.0);
            if !crossing.groups.is_empty() {
                let mut groups = crossing.groups;
                groups.push(own);
                look(circle.at(crossing.angle), &groups, crossing.error);
            }
            before = crossing.angle;
        }
    }

    fn is_within(&self, place: &Place<()>, piece: usize) -> bool {
        let piece = &self.0[piece];
        place.direction.dot(piece.normal) < piece.cosine
    }

    fn sine(&self, _: &Place<()>, _: usize, _: usize) -> Option<f64> {
        None
    }
}

/// The angles of a circle's directions that another piece has too, with their error bounds.
///
/// On the circle `v·n' - k'` is `M cos(φ - φ0) - K`. A piece that is turned by θ moves the
/// roots by `2 θ / (M sin(φ - φ0))`. Circles whose distance from touching is below `2 θ` touch.
fn crossings(circle: &Circle, own: &Piece, other: &Piece) -> SmallVec<[(f64, f64); 2]> {
    let error = 2.0 * own.turned.max(other.turned);
    let (a, b) = (circle.x.dot(other.normal), circle.y.dot(other.normal));
    let amplitude = libm::hypot(a, b);
    let mut found = SmallVec::new();
    if amplitude <= error {
        return found;
    }
    let middle = libm::atan2(b, a);
    let cosine = (other.cosine - circle.middle.dot(other.normal)) / amplitude;
    let beyond = (cosine.abs() - 1.0) * amplitude;
    if beyond.abs() <= error {
        let angle = if cosine > 0.0 { middle } else { middle + PI };
        found.push((angle, error / amplitude));
    } else if beyond < 0.0 {
        let half = libm::acos(cosine);
        let error = error / (amplitude * libm::sin(half));
        found.extend([(middle + half, error), (middle - half, error)]);
    }
    found
}
