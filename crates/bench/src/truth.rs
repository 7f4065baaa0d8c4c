//! Cases with their exact answers, and how far a formulation is from them.

use rayon::prelude::*;

use super::statistics::p99;
use crate::formulations::{Formulation, Problem};
use cyltrace_oracle::cases::{Family, Inputs};
use cyltrace_oracle::{TrueHit, exact, first_hit, to_f64};

/// Problems handed to a formulation at a time, so that threads share the work.
const AT_A_TIME: usize = 64;

/// The exact parameter of a hit as two numbers, good to some 2^-100: the
/// errors of f64 solvers are themselves a few 2^-53.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrueT {
    nearest: f64,
    rest: f64,
}

impl TrueT {
    /// That of a hit.
    pub fn of(hit: &TrueHit) -> Self {
        let nearest = hit.t_f64();
        let rest = to_f64(&(&hit.t - exact(nearest)));
        Self { nearest, rest }
    }

    /// How far an answer is off. The difference of two near numbers is exact,
    /// so nothing is lost in it.
    pub fn off(&self, t: f64) -> f64 {
        ((t - self.nearest) - self.rest).abs()
    }
}

/// Problems of one kind, with their answers worked out once.
#[derive(Clone, Debug)]
pub struct JudgedCases {
    name: &'static str,
    problems: Vec<Problem>,
    truths: Vec<Option<TrueT>>,
}

/// How a formulation did on some cases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// The number of cases.
    pub cases: usize,
    /// Cases in which it says hit for a miss, or miss for a hit.
    pub wrong: usize,
    /// Position error `|t - true t| |d| / radius`, the 99th percentile over
    /// the cases in which both say hit; `None` if there are none, infinite or
    /// NaN if over a hundredth of the answers are.
    pub p99_r: Option<f64>,
}

impl Errors {
    /// The share of wrong hits and misses.
    #[must_use]
    pub fn wrong_percent(&self) -> f64 {
        100.0 * self.wrong as f64 / self.cases.max(1) as f64
    }
}

impl JudgedCases {
    /// Asks the oracle about every problem.
    ///
    /// # Panics
    /// When a ray is not valid.
    #[must_use]
    pub fn new(name: &'static str, problems: Vec<Problem>) -> Self {
        let truths = problems
            .par_iter()
            .map(|problem| {
                let truth = first_hit(&problem.cylinder, &problem.ray);
                truth.hit.as_ref().map(TrueT::of)
            })
            .collect();
        Self {
            name,
            problems,
            truths,
        }
    }

    /// The first `count` cases of a family in f32 numbers, so that what computes
    /// in f32 gets the same question.
    #[must_use]
    pub fn of(family: Family, seed: u64, count: u64) -> Self {
        Self::new(family.name(), draw(family, seed, count))
    }

    /// The name of their family.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The cases.
    #[must_use]
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// Compares a formulation with the truth on the first `most` cases.
    #[must_use]
    pub fn judge(&self, formulation: &dyn Formulation, most: usize) -> Errors {
        let cases = self.problems.len().min(most);
        let answers: Vec<Option<f64>> = self.problems[..cases]
            .par_chunks(AT_A_TIME)
            .flat_map_iter(|problems| formulation.answers(problems))
            .map(|answer| answer.map(|answer| answer.t))
            .collect();
        assert_eq!(answers.len(), cases, "an answer for each problem");
        let mut wrong = 0;
        let mut errors = Vec::new();
        for ((problem, truth), answer) in self.problems.iter().zip(&self.truths).zip(answers) {
            match (truth, answer) {
                (Some(truth), Some(t)) => errors.push(position_error(problem, truth, t)),
                (None, None) => {}
                _ => wrong += 1,
            }
        }
        Errors {
            cases,
            wrong,
            p99_r: p99(errors),
        }
    }
}

/// The first `count` cases of a family, in f32 numbers.
#[must_use]
pub fn draw(family: Family, seed: u64, count: u64) -> Vec<Problem> {
    let case = |index| family.case(seed, index, Inputs::F32);
    (0..count).into_par_iter().map(case).collect()
}

/// How far along the ray the answer is from the truth, in radii.
fn position_error(problem: &Problem, truth: &TrueT, t: f64) -> f64 {
    truth.off(t) * problem.ray.direction.length() / problem.cylinder.radius()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    #[test]
    fn judge_solver_in_f64_is_right_to_a_few_roundings() {
        let cases = JudgedCases::new("sample", samples::problems(1, 400));
        let errors = cases.judge(&samples::Shifted(0.0), usize::MAX);
        assert_eq!((errors.cases, errors.wrong), (400, 0));
        let p99 = errors.p99_r.expect("some of them hit");
        assert!(p99 > 0.0 && p99 < 1e-12, "{p99:e}");
    }

    #[test]
    fn judge_shifted_answers_are_off_by_the_shift() {
        let cases = JudgedCases::new("sample", samples::problems(2, 400));
        let errors = cases.judge(&samples::Shifted(0.25), usize::MAX);
        let shifts = cases
            .problems()
            .iter()
            .map(|problem| 0.25 * problem.ray.direction.length() / problem.cylinder.radius());
        let greatest = shifts.fold(0.0, f64::max);
        let p99 = errors.p99_r.expect("some of them hit");
        assert!(p99 > 0.2 * greatest && p99 <= greatest * 1.001, "{p99:e}");
    }

    #[test]
    fn judge_solver_that_never_hits_is_wrong_wherever_there_is_a_hit() {
        let cases = JudgedCases::new("sample", samples::problems(3, 100));
        let hits = cases.truths.iter().flatten().count();
        let errors = cases.judge(&samples::Blind, 1000);
        assert!(hits > 20 && errors.wrong == hits, "{hits} {errors:?}");
        assert_eq!(errors.p99_r, None);
        assert_eq!(errors.wrong_percent(), hits as f64);
    }
}
