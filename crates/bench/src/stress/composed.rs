//! Set operations against the oracle.
//!
//! Judged are the first hit as of other solids, all crossings of the ray, and where
//! points are. An answer may name any face that the oracle allows at its point, with the
//! normal out of the composition.

use cyltrace::math::{DoubleDouble, Ray};
use cyltrace::solid::{ComposedIntersection, Composition, Location, Part};
use cyltrace_oracle::cases::ComposedCase;
use cyltrace_oracle::{ComposedHit, ComposedTruth, Face};

use super::witness::TrueAnswer;

/// How far along the ray an answer may be from the true point and still be meant for it,
/// as a share of the composition's size. Errors of `t` are counted by themselves; what is
/// farther off is a wrong hit. Points of different surfaces are that near in
/// none of the families.
const SAME_POINT: f64 = 1e-6;

/// The truth about a case.
pub struct ComposedWitness {
    /// All crossings in the ray's range.
    pub hits: Vec<ComposedHit>,
    /// Where the case's points are.
    pub locations: Vec<Location>,
}

impl ComposedWitness {
    /// Computes the truth by the oracle.
    #[must_use]
    pub fn new(case: &ComposedCase) -> Self {
        let truth = ComposedTruth::new(&case.composition);
        let points = case.points.iter();
        Self {
            hits: truth.hits(&case.ray),
            locations: points.map(|point| truth.locate(*point)).collect(),
        }
    }
}

/// Which of the solver's answers to a case are wrong.
#[derive(Clone, Copy, Debug, Default)]
pub struct Verdict {
    /// Whether the ray truly hits.
    pub is_hit: bool,
    /// A hit for a miss, a miss for a hit, or a hit elsewhere.
    pub is_wrong_hit: bool,
    /// The first hit is on a part that is no face there, or has another normal.
    pub is_wrong_part: bool,
    /// Any crossing is missing, too many, elsewhere or of another face.
    pub is_wrong_crossing: bool,
    /// A point is elsewhere.
    pub is_wrong_point: bool,
    /// An answer is not finite.
    pub is_not_finite: bool,
    /// The true first hit with the reported `t`.
    pub first: Option<(TrueAnswer, f64)>,
    /// Half the composition's size over the length of the direction.
    pub half_size: f64,
}

impl Verdict {
    /// Compares the solver's answers with the truth.
    #[must_use]
    pub fn of(case: &ComposedCase, witness: &ComposedWitness) -> Self {
        let ComposedCase {
            composition, ray, ..
        } = case;
        let from = |anchor| ray.origin - anchor;
        let range = [ray.t_min, ray.t_max];
        let mut all = Vec::new();
        composition.intersections(from, ray.direction, 0.0, range, |met| all.push(met));
        let first = composition.first(from, ray.direction, 0.0, range);
        let size = size_of(composition);
        let mut verdict = Self {
            is_hit: !witness.hits.is_empty(),
            half_size: 0.5 * size / ray.direction.length(),
            ..Self::default()
        };
        let judge = |met: &ComposedIntersection, hit: &ComposedHit| {
            let answer = TrueAnswer::of_composed(hit);
            let error = answer.error_of(met.intersection.t) * ray.direction.length();
            let is_here = error.abs() <= SAME_POINT * size;
            (is_here, is_face(composition, ray, met, &hit.faces), answer)
        };
        match (&first, witness.hits.first()) {
            (Some(met), _) if !met.intersection.t.is_finite() => verdict.is_not_finite = true,
            (Some(met), Some(hit)) => {
                let (is_here, is_face, answer) = judge(met, hit);
                verdict.is_wrong_hit = !is_here;
                verdict.is_wrong_part = is_here && !is_face;
                verdict.first = is_here.then_some((answer, met.intersection.t));
            }
            (met, hit) => verdict.is_wrong_hit = met.is_some() != hit.is_some(),
        }
        let is_same = |(met, hit): (&ComposedIntersection, &ComposedHit)| {
            let (is_here, is_face, _) = judge(met, hit);
            is_here && is_face && met.intersection.crossing == hit.crossing
        };
        verdict.is_wrong_crossing =
            all.len() != witness.hits.len() || !all.iter().zip(&witness.hits).all(is_same);
        let mut points = case.points.iter().zip(&witness.locations);
        verdict.is_wrong_point = points.any(|(point, located)| {
            composition.locate(*point) != *located
                || composition.contains(*point) != located.is_held()
        });
        verdict
    }

    /// Whether anything is wrong.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        self.is_wrong_hit
            || self.is_wrong_part
            || self.is_wrong_crossing
            || self.is_wrong_point
            || self.is_not_finite
    }
}

/// Whether the answer names one of the faces, with its normal.
fn is_face(
    composition: &Composition,
    ray: &Ray,
    met: &ComposedIntersection,
    faces: &[Face],
) -> bool {
    let named = |face: &&Face| face.leaf == met.leaf && face.part == met.intersection.part;
    faces.iter().filter(named).any(|face| {
        let at = |anchor| (ray.origin - anchor) + ray.direction * met.intersection.t;
        let surface = composition.surface(met, at);
        // At an apex any normal is as good.
        face.normal
            .is_none_or(|normal| normal.dot(surface.normal) > 0.0)
    })
}

fn size_of(composition: &Composition) -> f64 {
    let boxes = composition.solids().into_iter().map(|solid| solid.bounds());
    let all = boxes.fold(cyltrace::math::Bounds::EMPTY, |sum, one| sum.union(&one));
    (all.upper - all.lower).length()
}

impl TrueAnswer {
    /// The truth about a crossing, with the first face that it may be of.
    pub(super) fn of_composed(hit: &ComposedHit) -> Self {
        let high = cyltrace_oracle::to_f64(&hit.t);
        let low = cyltrace_oracle::to_f64(&(&hit.t - cyltrace_oracle::exact(high)));
        // Without a face any answer counts as one of a wrong part.
        let face = hit.faces.first();
        Self {
            t: DoubleDouble { high, low },
            part: face.map_or(Part::Side, |face| face.part),
            normal: face.and_then(|face| face.normal),
            t_bound: None,
        }
    }
}
