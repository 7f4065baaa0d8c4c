//! The figures of one contender on one family.
//!
//! What is compared, for a ray that truly hits and is said to:
//!
//! - `t` in ulps of the true `t`, in f32 ulps with `t` rounded to f32 first
//!   (so a correctly rounded answer has at most 0.5), and, for a contender
//!   that computes in f64, in f64 ulps as well;
//! - the position along the ray, `|dt| |d| / r`, with half its size for the `r` of a
//!   solid that is no cylinder;
//! - the normal's angle to the true one, up to its sign, where the part is
//!   right.

use crate::formulations::{Answer, Precision};
use cyltrace::math::power_of_two;
use cyltrace_oracle::cases::Inputs;

use super::composed::Verdict;
use super::family::StressFamily;
use super::quantiles::Quantiles;
use super::witness::{TrueAnswer, Witness};

/// The figures of a contender on a family.
#[derive(Clone, Debug)]
pub struct Cell {
    /// The family.
    pub family: StressFamily,
    /// The kind of inputs.
    pub inputs: Inputs,
    /// The name of the formulation, or of the kind of solid.
    pub formulation: &'static str,
    /// What it computes in.
    pub precision: Precision,
    /// The seed of the cases.
    pub seed: u64,
    /// What was counted.
    pub figures: Figures,
}

impl Cell {
    /// What [`Cell::t_ulps`] counts in: the coarser of what goes in and out.
    #[must_use]
    pub fn ulp_of(&self) -> Precision {
        match (self.inputs, self.precision) {
            (Inputs::F64, Precision::F64) => Precision::F64,
            _ => Precision::F32,
        }
    }

    /// Errors of `t` in ulps of [`Cell::ulp_of`].
    #[must_use]
    pub fn t_ulps(&self) -> &Quantiles {
        match self.ulp_of() {
            Precision::F32 => &self.figures.t_f32_ulps,
            Precision::F64 => &self.figures.t_f64_ulps,
        }
    }
}

/// Counts and errors, of any number of cases.
#[derive(Clone, Debug, Default)]
pub struct Figures {
    /// Cases.
    pub cases: u64,
    /// Cases that truly hit.
    pub hits: u64,
    /// Said to hit and do not, or the reverse.
    pub wrong_hit: u64,
    /// Those with a gap beyond the rounding of the inputs.
    pub wrong_hit_outside: u64,
    /// Hits on another part than the true one.
    pub wrong_part: u64,
    /// Those with a gap beyond the rounding of the inputs.
    pub wrong_part_outside: u64,
    /// Wrong hits and parts of cases that the library promises.
    pub wrong_decided: u64,
    /// Cases of set operations with a wrong crossing anywhere on the ray.
    pub wrong_crossing: u64,
    /// Cases of set operations with a point in the wrong place.
    pub wrong_point: u64,
    /// Answers with a NaN or an infinity.
    pub non_finite: u64,
    /// Errors of `t` rounded to f32, in f32 ulps.
    pub t_f32_ulps: Quantiles,
    /// Errors of `t` in f64 ulps, where the contender computes in f64.
    pub t_f64_ulps: Quantiles,
    /// The greatest error of `t` of promised cases, in units of its bound.
    pub t_bound_used: f64,
    /// Errors of the position along the ray, in radii.
    pub position: Quantiles,
    /// Errors of the normal, in radians.
    pub normal: Quantiles,
    /// Rays spawned from hits, for the library's own solvers.
    pub spawned: u64,
    /// Spawned rays that hit the surface at their own origin.
    pub self_hits: u64,
    /// The worst case.
    pub worst: Option<Worst>,
}

/// What makes a case the worst one, in order of weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Not finite 3, wrong hit 2, wrong part 1, otherwise 0.
    pub class: u8,
    /// The gap of a wrong answer, or the error of `t` in ulps.
    pub size: f64,
    /// The case's number.
    pub index: u64,
}

impl Worst {
    fn outranks(&self, other: &Self) -> bool {
        let by_size = || self.size.total_cmp(&other.size);
        // Of equals the one that comes first.
        let order = self.class.cmp(&other.class).then_with(by_size);
        order.then(other.index.cmp(&self.index)).is_gt()
    }
}

impl Figures {
    /// Counts an answer.
    pub(super) fn judge(
        &mut self,
        witness: &Witness,
        answer: Option<&Answer>,
        precision: Precision,
        inputs: Inputs,
    ) {
        self.cases += 1;
        self.hits += u64::from(witness.truth.is_some());
        let outside = || u64::from(witness.gap() > inputs.unit_roundoff());
        let decided = || u64::from(witness.is_decided());
        match (&witness.truth, answer) {
            (_, Some(answer)) if !answer.t.is_finite() || !answer.normal.is_finite() => {
                self.non_finite += 1;
                self.note(3, witness.gap(), witness.index);
            }
            (Some(truth), Some(answer)) => {
                let t_error = self.compare(witness, truth, answer, precision, inputs);
                if truth.part == answer.part {
                    self.note(0, t_error, witness.index);
                } else {
                    self.wrong_part += 1;
                    self.wrong_part_outside += outside();
                    self.wrong_decided += decided();
                    self.note(1, witness.gap(), witness.index);
                }
            }
            (None, None) => {}
            _ => {
                self.wrong_hit += 1;
                self.wrong_hit_outside += outside();
                self.wrong_decided += decided();
                self.note(2, witness.gap(), witness.index);
            }
        }
    }

    /// Counts a verdict on set operations.
    pub(super) fn count(&mut self, verdict: &Verdict, index: u64) {
        self.cases += 1;
        self.hits += u64::from(verdict.is_hit);
        self.wrong_hit += u64::from(verdict.is_wrong_hit);
        self.wrong_hit_outside += u64::from(verdict.is_wrong_hit);
        self.wrong_part += u64::from(verdict.is_wrong_part);
        self.wrong_part_outside += u64::from(verdict.is_wrong_part);
        self.wrong_crossing += u64::from(verdict.is_wrong_crossing);
        self.wrong_point += u64::from(verdict.is_wrong_point);
        self.non_finite += u64::from(verdict.is_not_finite);
        let class = match verdict {
            Verdict {
                is_not_finite: true,
                ..
            } => 3,
            Verdict {
                is_wrong_hit: true, ..
            } => 2,
            _ => u8::from(verdict.is_wrong()),
        };
        let mut size = 0.0;
        if let Some((truth, t)) = verdict.first {
            let error = truth.error_of(t);
            let f32_error = truth.error_of(f64::from(t as f32));
            size = in_ulps(error, &truth, Precision::F64);
            self.t_f32_ulps
                .push(in_ulps(f32_error, &truth, Precision::F32));
            self.t_f64_ulps.push(size);
            self.position.push(error / verdict.half_size);
        }
        self.note(class, if class > 0 { 0.0 } else { size }, index);
    }

    /// Counts the errors of a hit and answers with that of `t` in ulps.
    fn compare(
        &mut self,
        witness: &Witness,
        truth: &TrueAnswer,
        answer: &Answer,
        precision: Precision,
        inputs: Inputs,
    ) -> f64 {
        let error = truth.error_of(answer.t);
        let f32_error = truth.error_of(f64::from(answer.t as f32));
        let mut ulps = in_ulps(f32_error, truth, Precision::F32);
        self.t_f32_ulps.push(ulps);
        if precision == Precision::F64 {
            let f64_ulps = in_ulps(error, truth, Precision::F64);
            self.t_f64_ulps.push(f64_ulps);
            if inputs == Inputs::F64 {
                ulps = f64_ulps;
            }
        }
        let speed = witness.case.ray.direction.length();
        self.position.push(error * speed / witness.length);
        if let Some(normal) = truth.normal
            && truth.part == answer.part
        {
            let sine = normal.cross(answer.normal).length();
            let cosine = normal.dot(answer.normal).abs();
            self.normal.push(libm::atan2(sine, cosine));
        }
        if let Some(bound) = truth.t_bound
            && witness.is_decided()
        {
            self.t_bound_used = self.t_bound_used.max(error.abs() / bound);
        }
        ulps
    }

    fn note(&mut self, class: u8, size: f64, index: u64) {
        let candidate = Worst { class, size, index };
        if self.worst.is_none_or(|worst| candidate.outranks(&worst)) {
            self.worst = Some(candidate);
        }
    }

    /// Counts all that `other` counted.
    pub(super) fn merge(&mut self, other: Self) {
        self.cases += other.cases;
        self.hits += other.hits;
        self.wrong_hit += other.wrong_hit;
        self.wrong_hit_outside += other.wrong_hit_outside;
        self.wrong_part += other.wrong_part;
        self.wrong_part_outside += other.wrong_part_outside;
        self.wrong_decided += other.wrong_decided;
        self.wrong_crossing += other.wrong_crossing;
        self.wrong_point += other.wrong_point;
        self.non_finite += other.non_finite;
        self.t_f32_ulps.merge(other.t_f32_ulps);
        self.t_f64_ulps.merge(other.t_f64_ulps);
        self.t_bound_used = self.t_bound_used.max(other.t_bound_used);
        self.position.merge(other.position);
        self.normal.merge(other.normal);
        self.spawned += other.spawned;
        self.self_hits += other.self_hits;
        if let Some(worst) = other.worst {
            self.note(worst.class, worst.size, worst.index);
        }
    }
}

/// An error of `t` in ulps of the true one. Where that is zero or almost so,
/// the quotient overflows and the greatest number replaces it.
fn in_ulps(error: f64, truth: &TrueAnswer, precision: Precision) -> f64 {
    (error.abs() / ulp(truth.t.high, precision)).min(f64::MAX)
}

/// The distance of neighbouring numbers at `x`.
fn ulp(x: f64, precision: Precision) -> f64 {
    let exponent = (x.abs().to_bits() >> 52) as i32 - 1023;
    match precision {
        Precision::F32 => power_of_two(exponent.max(-126) - 23),
        Precision::F64 => power_of_two((exponent - 52).max(-1022)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ulp_is_the_distance_to_the_next_number() {
        for x in [1.0, 1.5, 3.0e10, 7.0e-12, -2.0_f64] {
            let size = x.abs();
            assert_eq!(ulp(x, Precision::F64), size.next_up() - size, "{x}");
            let single = size as f32;
            let step = f64::from(single.next_up()) - f64::from(single);
            assert_eq!(ulp(x, Precision::F32), step, "{x}");
        }
        assert_eq!(ulp(0.0, Precision::F32), f64::from(f32::from_bits(1)));
    }

    #[test]
    fn worst_case_is_the_same_in_any_order() {
        let notes = [(0, 5.0, 1), (2, 1e-9, 7), (2, 1e-9, 3), (1, 9.0, 2)];
        let (mut forward, mut backward) = (Figures::default(), Figures::default());
        for (class, size, index) in notes {
            forward.note(class, size, index);
        }
        for (class, size, index) in notes.into_iter().rev() {
            backward.note(class, size, index);
        }
        assert_eq!(forward.worst, backward.worst);
        assert_eq!(forward.worst.map(|worst| worst.index), Some(3));
    }
}
