//! What exact arithmetic says of the set operations of a drawn scene's root.
//!
//! With whole numbers every crossing has to be the true one. With others, turned faces
//! that are meant to coincide do so up to a rounding, and what is thinner than the
//! roundings may be there or not (`src/solid/composition/line.rs`). So a point between
//! two crossings is compared only if it is farther than the roundings from the surface of
//! each operand.

use cyltrace::math::{Ray, UNIT_ROUNDOFF, power_of_two};
use cyltrace::scene::CompositionRecord;
use cyltrace::solid::{AnySolid, Composition, Crossing, Location, Part, RoundedCone};
use cyltrace::tracer::{Containing, Hit};
use cyltrace_oracle::{ComposedTruth, to_f64};
use glam::DVec3;

use super::drawn_scene::DrawnScene;
use super::truth::{are_whole, is_whole};

/// The compositions of a root, to be compared with.
pub struct Compositions<'a> {
    drawn: &'a DrawnScene,
    truths: Vec<(&'a CompositionRecord, ComposedTruth)>,
}

impl<'a> Compositions<'a> {
    /// Those of a scene.
    pub fn new(drawn: &'a DrawnScene) -> Self {
        let records = drawn.scene.prototypes[0].solids.compositions.iter();
        let truths = records.map(|record| (record, ComposedTruth::new(&record.solid)));
        Self {
            drawn,
            truths: truths.collect(),
        }
    }

    /// Compares the hits of a whole line.
    ///
    /// # Panics
    /// When a crossing is wrong.
    pub fn judge(&self, line: &Ray, hits: &[Hit]) {
        for (record, truth) in &self.truths {
            let found: Vec<&Hit> = (hits.iter())
                .filter(|hit| hit.instance.is_empty() && hit.primitive == record.primitive)
                .collect();
            let is_exact = (record.solid.solids().iter().all(is_whole))
                && are_whole(&[line.origin, line.direction]);
            match is_exact {
                true => self.judge_exactly(line, &found, record, truth),
                false => self.judge_between(line, &found, record, truth),
            }
        }
    }

    fn judge_exactly(
        &self,
        line: &Ray,
        found: &[&Hit],
        record: &CompositionRecord,
        truth: &ComposedTruth,
    ) {
        let expected = truth.hits(line);
        let case = || {
            let drawn = self.drawn;
            format!("{found:#?}, truly {expected:#?}: {line:?} {record:#?} {drawn:#?}")
        };
        let keys: Vec<Crossing> = found.iter().map(|hit| hit.crossing).collect();
        let true_keys: Vec<Crossing> = expected.iter().map(|hit| hit.crossing).collect();
        assert_eq!(keys, true_keys, "wrong crossings: {}", case());
        for (hit, expected) in found.iter().zip(&expected) {
            let t = to_f64(&expected.t);
            // A parameter is within 2^-34 of itself (`docs/derivations.md`, section 8); of
            // lines from the surface, the way is what is rounded.
            let off = (hit.t - t).abs() <= power_of_two(-34) * t.abs().max(1.0);
            assert!(off, "another t than {t}: {}", case());
            let mut faces = expected.faces.iter();
            // An apex may be of the wall or of a disk of radius zero.
            let is_face = faces.any(|face| face.part == hit.part || face.normal.is_none());
            assert!(is_face, "not a face: {}", case());
        }
    }

    fn judge_between(
        &self,
        line: &Ray,
        found: &[&Hit],
        record: &CompositionRecord,
        truth: &ComposedTruth,
    ) {
        let mut stops: Vec<f64> = found.iter().map(|hit| hit.t).collect();
        stops.extend(truth.hits(line).iter().map(|hit| to_f64(&hit.t)));
        stops.sort_by(f64::total_cmp);
        for pair in stops.windows(2) {
            let t = 0.5 * (pair[0] + pair[1]);
            let radius = 8.0 * displacement(line, t, &record.solid);
            let point = line.at(t);
            let mut operands = record.solid.solids().into_iter();
            if operands.any(|operand| is_near_surface(&operand, point, radius)) {
                continue;
            }
            let location = truth.locate(point);
            let last = found.iter().rfind(|hit| hit.t < t);
            let is_inside = last.is_some_and(|hit| hit.crossing == Crossing::Enter);
            assert_eq!(
                is_inside,
                location == Location::Inside,
                "at {t}, {found:#?}: {line:?} {record:#?} {:#?}",
                self.drawn
            );
        }
    }

    /// Compares which of them contain a point.
    ///
    /// # Panics
    /// When exact arithmetic disagrees.
    pub fn judge_point(&self, point: DVec3, found: &[Containing]) {
        for (record, truth) in &self.truths {
            let is_found = (found.iter())
                .any(|one| one.instance.is_empty() && one.primitive == record.primitive);
            let is_true = truth.locate(point).is_held();
            assert_eq!(is_found, is_true, "contains {point:?} {record:#?}");
        }
    }
}

/// What a solver's line may be displaced by (`docs/derivations.md`, section 5), the
/// greatest of all operands.
fn displacement(line: &Ray, t: f64, solid: &Composition) -> f64 {
    let way = line.origin.length() + t.abs() * line.direction.length();
    let sizes = solid.solids().into_iter();
    let sizes = sizes.map(|solid| solid.anchor().length() + solid.size());
    32.0 * UNIT_ROUNDOFF * (way + sizes.fold(0.0, f64::max))
}

/// Whether a point may be within a distance of a solid's surface.
fn is_near_surface(solid: &AnySolid, point: DVec3, distance: f64) -> bool {
    use Part::{Cap0, Cap1, Side, XMax, XMin, YMax, YMin, ZMax, ZMin};
    let parts: &[Part] = match solid {
        AnySolid::Sphere(_) | AnySolid::Disk(_) => &[Side],
        AnySolid::Cuboid(_) => &[XMin, XMax, YMin, YMax, ZMin, ZMax],
        // One ball in the other leaves no wall between them, or one too narrow to matter.
        AnySolid::RoundedCone(one) if has_no_wall(one) => &[Cap0, Cap1],
        _ => &[Side, Cap0, Cap1],
    };
    let from_anchor = point - solid.anchor();
    let mut nearest = parts
        .iter()
        .map(|&part| solid.surface_point(part, from_anchor).point);
    // NaN is near.
    !nearest.all(|surface| surface.distance(point) > distance)
}

fn has_no_wall(cone: &RoundedCone) -> bool {
    let taper = (cone.radius0() - cone.radius1()).abs();
    (cone.p1() - cone.p0()).length() <= taper * (1.0 + power_of_two(-40))
}
