//! Exact truth about set operations.
//!
//! **The set.** Let `E` be what the operations say of the *open* insides of the
//! operands. The composition is `R`, the closure of the points off all operands'
//! surfaces where `E` is true: a point belongs to it if every neighbourhood has an open cell
//! with `E` true (a regularised set operation). A point is inside `R` where `E` is true in
//! all cells around it, outside where it is in none, and on the boundary otherwise.
//!
//! **Hits.** A line has closed intervals in common with `R`. Each is entered at its
//! start and left at its end, at the same parameter where it is a point. Where the line is
//! inside `R` before and behind a point of the boundary, it leaves and enters there. From
//! the boundary to the inside is no crossing. A ray that starts strictly within an
//! interval of its line that is in the boundary hits where it starts.
//!
//! **Faces.** At a point of the boundary, a part of an operand's surface is a face of
//! `R` if `E` differs on its two sides, however near to the point.
//!
//! Two surfaces with the same tangent plane are in the order of their second-order shapes;
//! those equal to second order coincide.
//!
//! Operands are polynomials (`sheet.rs`, `leaf.rs`); points are exact (`place.rs`,
//! `ring.rs`); what is around them is in `around.rs`, `smooth.rs`, `edge.rs` and `apex.rs`.

mod apex;
mod around;
mod edge;
mod face;
mod leaf;
mod line;
mod place;
mod ring;
mod sheet;
mod smooth;
mod survey;

pub(crate) use leaf::{Leaf, TrueOperand};
pub(crate) use sheet::Sheet;
use std::cmp::Ordering;

use glam::DVec3;

use super::number::{Exact, ExactVector, exact};
use around::Around;
use cyltrace::math::Ray;
use cyltrace::solid::{Composition, Crossing, Location};
pub use face::Face;
use line::{Station, stations};
use place::Place;

/// A composition in exact numbers.
#[derive(Clone, Debug)]
pub struct ComposedTruth {
    composition: Composition,
    leaves: Vec<Leaf>,
}

/// A crossing of a ray and the surface of a composition.
#[derive(Clone, Debug)]
pub struct ComposedHit {
    /// The parameter, to some 700 bits.
    pub t: Exact,
    /// Whether the ray comes or goes.
    pub crossing: Crossing,
    /// The faces that the surface has there; an answer may name any.
    pub faces: Vec<Face>,
}

impl ComposedTruth {
    /// The truth about a composition.
    ///
    /// # Panics
    /// When an operand is a disk.
    #[must_use]
    pub fn new(composition: &Composition) -> Self {
        Self {
            leaves: composition.solids().iter().map(Leaf::new).collect(),
            composition: composition.clone(),
        }
    }

    /// Where a point is.
    ///
    /// # Panics
    /// When the point is not finite.
    #[must_use]
    pub fn locate(&self, point: DVec3) -> Location {
        let place = Place::at(&ExactVector::new(point));
        Around::of(&self.composition, &self.leaves, &place).location
    }

    /// All crossings in a ray's range, in order.
    ///
    /// # Panics
    /// When the ray is not valid ([`Ray::is_valid`]).
    #[must_use]
    pub fn hits(&self, ray: &Ray) -> Vec<ComposedHit> {
        assert!(ray.is_valid(), "the oracle was given {ray:?}");
        let [origin, direction] = [ray.origin, ray.direction].map(ExactVector::new);
        let stations = stations(self, &origin, &direction);
        let mut hits = Vec::new();
        hits.extend(start_within(&stations, ray));
        let mut before = Location::Outside;
        for Station { at, here, behind } in &stations {
            let is_in_range = at.t.cmp_f64(ray.t_min) != Ordering::Less
                && at.t.cmp_f64(ray.t_max) != Ordering::Greater;
            for &crossing in crossings([before, here.location, behind.location]) {
                if is_in_range {
                    hits.push(ComposedHit {
                        t: at.t.value(),
                        crossing,
                        faces: here.faces.clone(),
                    });
                }
            }
            before = behind.location;
        }
        hits
    }
}

/// What happens at a point, by where the line is before it, there and behind it.
fn crossings([before, here, behind]: [Location; 3]) -> &'static [Crossing] {
    use Crossing::{Enter, Leave};
    match [before, here, behind].map(Location::is_held) {
        [_, false, _] => &[],
        [false, _, false] => &[Enter, Leave],
        [false, _, true] => &[Enter],
        [true, _, false] => &[Leave],
        [true, _, true] => match [before, here, behind] {
            [Location::Inside, Location::Boundary, Location::Inside] => &[Leave, Enter],
            _ => &[],
        },
    }
}

/// The hit of a ray that starts strictly within an interval in the boundary.
fn start_within(stations: &[Station], ray: &Ray) -> Option<ComposedHit> {
    if ray.t_min > ray.t_max || ray.t_min.is_infinite() {
        return None;
    }
    let order = |station: &&Station| station.at.t.cmp_f64(ray.t_min);
    let last = stations
        .iter()
        .take_while(|station| order(station) != Ordering::Greater)
        .last()?;
    let is_in_boundary = |around: &Around| around.location == Location::Boundary;
    if !is_in_boundary(&last.behind) {
        return None;
    }
    let mut place = &last.behind;
    if order(&last) == Ordering::Equal {
        // It starts at a station: also what is before it must be in the boundary.
        let position = stations.iter().position(|one| std::ptr::eq(one, last))?;
        let before = &stations[position.checked_sub(1)?].behind;
        if !is_in_boundary(before) {
            return None;
        }
        place = &last.here;
    }
    Some(ComposedHit {
        t: exact(ray.t_min),
        crossing: Crossing::Enter,
        faces: place.faces.clone(),
    })
}
