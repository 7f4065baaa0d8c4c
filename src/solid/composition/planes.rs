//! First order from exact normals.
//!
//! The tangent planes through one point divide the directions. With an outward normal `n` of
//! each ([`outward`](super::operand::outward)), of any length, all decisions are signs of
//! polynomials:
//!
//! - Two pieces are one group if `n1 × n2 = 0`.
//! - The plane of `j` crosses the plane of the group `g` in `±c`, `c = g × n_j`. Seen against
//!   `g`, `c_k` is counterclockwise of `c_j` by less than half a turn if
//!   `(c_j × c_k)·g = |g|² g·(n_j × n_k)` is positive, which has the sign of `c_j·n_k`. If it
//!   is zero, they are one line.
//! - Neighbouring crossings are less than half a turn apart, so their sum is in the arc between
//!   them. If there is only one line, `±g × c` are in the arcs.
//! - A direction `v` is inside of a piece if `v·n < 0`.
//!
//! Directions in f64 are used only for heights of second order. If an arc is narrower than f64
//! resolves, they are those of its ends, and heights that differ by no more than their own
//! errors coincide as everywhere.

use std::cmp::Ordering;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use smallvec::SmallVec;

use super::bend::Angles;
use super::circle::Circle;
use super::first_order::{FirstOrder, Place};
use super::operand::{Vector, outward};
use super::piece::Pieces;
use crate::solid::AnySolid;
use crate::solid::exact::{Big, Number, cross, dot, ratio, unit};

/// The tangent planes of pieces, each by an outward normal.
pub(super) struct Planes(SmallVec<[Vector; 8]>);

/// A direction in which other groups cross the circle of a group.
struct Crossing {
    direction: Vector,
    /// The normal of the first of them, so that `direction` is `g ×` it.
    normal: Vector,
    groups: SmallVec<[usize; 4]>,
}

impl Planes {
    /// The planes of pieces at a stated point; `None` if an apex is among them.
    pub fn at(point: DVec3, pieces: &Pieces, solids: &[&AnySolid]) -> Option<Self> {
        let normals = pieces.iter().map(|piece| {
            let solid = solids[piece.leaf as usize];
            outward(solid, piece, point)
        });
        normals.collect::<Option<_>>().map(Self)
    }

    /// The crossings of a group's circle, counterclockwise.
    fn crossings(&self, own: usize, others: &[usize]) -> SmallVec<[Crossing; 8]> {
        let mut half = SmallVec::<[Crossing; 8]>::new();
        for &other in others {
            let mut normal = self.0[other].clone();
            let mut direction = cross(&self.0[own], &normal);
            // All are within half a turn from the first.
            let turn = half.first().map(|first| first.turn_to(&normal));
            if turn == Some(Ordering::Less) {
                (normal, direction) = (opposite(&normal), opposite(&direction));
            }
            let found = half.iter_mut().find(|one| one.turn_to(&normal).is_eq());
            match found {
                Some(one) => one.groups.push(other),
                None => half.push(Crossing {
                    direction,
                    normal,
                    groups: SmallVec::from_slice(&[own, other]),
                }),
            }
        }
        half.sort_by(|one, next| one.turn_to(&next.normal).reverse());
        let other_half: SmallVec<[Crossing; 8]> = half.iter().map(Crossing::opposite).collect();
        half.extend(other_half);
        half
    }
}

impl Crossing {
    /// Whether the crossing with a plane, `g ×` its normal, is counterclockwise (`Greater`) or
    /// clockwise of this one.
    fn turn_to(&self, normal: &Vector) -> Ordering {
        sign(&dot(&self.direction, normal))
    }

    fn opposite(&self) -> Self {
        Self {
            direction: opposite(&self.direction),
            normal: opposite(&self.normal),
            groups: self.groups.clone(),
        }
    }
}

impl FirstOrder for Planes {
    type Exact = Vector;
    const IS_EXACT: bool = true;

    fn are_one(&self, one: usize, other: usize) -> bool {
        let across = cross(&self.0[one], &self.0[other]);
        across.iter().all(|number| sign(number).is_eq())
    }

    fn for_each_place(
        &self,
        circle: &Circle,
        own: usize,
        others: &[usize],
        changes: &Angles,
        mut look: impl FnMut(&Place<Vector>),
    ) {
        let mut look = |direction: DVec3, exact: &Vector, groups: &[usize]| {
            look(&Place {
                direction,
                error: 0.0,
                groups,
                exact: exact.clone(),
            });
        };
        let crossings = self.crossings(own, others);
        if crossings.is_empty() {
            // All pieces are in the group, so the exact direction does not matter.
            let first = changes.first().copied().unwrap_or(0.0);
            for start in [first, first + PI] {
                for angle in middles(start, PI, changes) {
                    look(circle.at(angle), &self.0[own], &[own]);
                }
            }
            return;
        }
        let angle =
            |direction: DVec3| libm::atan2(direction.dot(circle.y), direction.dot(circle.x));
        for (position, crossing) in crossings.iter().enumerate() {
            let next = &crossings[(position + 1) % crossings.len()];
            let direction = unit(&crossing.direction);
            look(direction, &crossing.direction, &crossing.groups);
            let start = angle(direction);
            let (within, width) = if crossings.len() == 2 {
                (cross(&self.0[own], &crossing.direction), PI)
            } else {
                let width = reduced(angle(unit(&next.direction)) - start);
                (
                    sum(&crossing.direction, &next.direction),
                    width.clamp(0.0, PI),
                )
            };
            for angle in middles(start, width, changes) {
                look(circle.at(angle), &within, &[own]);
            }
        }
    }

    fn is_within(&self, place: &Place<Vector>, piece: usize) -> bool {
        sign(&dot(&place.exact, &self.0[piece])).is_lt()
    }

    fn sine(&self, place: &Place<Vector>, one: usize, other: usize) -> Option<f64> {
        let (one, other) = (&self.0[one], &self.0[other]);
        let across = cross(one, other);
        let square = ratio(
            &dot(&across, &across),
            &dot(one, one).times(&dot(other, other)),
        );
        // Sines below 2^-511 are replaced by that: their order could matter only where three
        // such planes bend, and the sign is exact.
        let size = square.max(f64::MIN_POSITIVE).sqrt();
        Some(match sign(&dot(&place.exact, &across)) {
            Ordering::Less => -size,
            _ => size,
        })
    }
}

/// The middles of the parts into which `changes` divide an arc.
fn middles(start: f64, width: f64, changes: &Angles) -> Angles {
    let offsets = changes.iter().map(|change| reduced(change - start));
    let mut ends: Angles = offsets
        .filter(|&offset| 0.0 < offset && offset < width)
        .collect();
    ends.extend([0.0, width]);
    ends.sort_by(f64::total_cmp);
    let pairs = ends.windows(2);
    pairs
        .map(|pair| start + 0.5 * (pair[0] + pair[1]))
        .collect()
}

/// An angle relative to an arc's start, in the turn around half a turn. An angle within the arc
/// stays next to it in spite of rounding.
fn reduced(angle: f64) -> f64 {
    angle - TAU * libm::floor((angle + FRAC_PI_2) / TAU)
}

fn sign(number: &Big) -> Ordering {
    number
        .sign()
        .expect("signs of numbers of any length are certain")
}

fn opposite(v: &Vector) -> Vector {
    std::array::from_fn(|i| Big::of(0.0).minus(&v[i]))
}

fn sum(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| a[i].plus(&b[i]))
}
