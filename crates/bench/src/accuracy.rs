//! The comparison itself: who takes part, and what is found of each.

use super::rivals::{Native, SIDES, Shape, Traced};
use super::statistics::{Spread, ratios};
use super::timing::{Rounds, Timer, interleave};
use super::truth::{Errors, JudgedCases};
use crate::formulations::{Batch, Formulation, Precision, Problem};
use cyltrace::embree::DeviceOptions;
use cyltrace::tracer::{Options, TracerError};

/// The formulation that times are compared with.
const BASELINE: (&str, Precision) = ("triple-product", Precision::F64);

/// Rivals build a scene for each case, so they get fewer cases: at most
/// this many, the 99th percentile being the tenth worst,
const RIVAL_CASES: usize = 1000;

/// and not more than give this number of mesh sides in a family.
const RIVAL_SIDES: usize = 200_000;

/// What the time of a contender is the time of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum Times {
    /// A ray and its one cylinder, which are at hand.
    Solver,
    /// A ray through a tree of cylinders, and all of its hit.
    #[strum(serialize = "end to end")]
    EndToEnd,
}

impl Times {
    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// One that takes part.
pub struct Contender {
    /// How it answers and runs.
    pub formulation: Box<dyn Formulation>,
    /// What its time is.
    pub times: Times,
    /// The greatest number of cases of a family that it gets.
    pub most_cases: usize,
}

/// Those of the given formulations and of the rivals whose name is wanted, and
/// the baseline, in a fixed order.
///
/// # Errors
/// When Embree cannot be set up.
pub fn contenders(
    formulations: Vec<Box<dyn Formulation>>,
    options: &Options,
    is_wanted: impl Fn(&str) -> bool,
) -> Result<Vec<Contender>, TracerError> {
    let mut all: Vec<Contender> = formulations
        .into_iter()
        .filter(|formulation| is_wanted(formulation.name()) || is_baseline(formulation.as_ref()))
        .map(|formulation| Contender {
            formulation,
            times: Times::Solver,
            most_cases: usize::MAX,
        })
        .collect();
    let mut add = |formulation: Box<dyn Formulation>, most_cases: usize| {
        all.push(Contender {
            formulation,
            times: Times::EndToEnd,
            most_cases,
        });
    };
    if is_wanted(Traced::NAME) {
        add(Box::new(Traced::new(options.clone())?), RIVAL_CASES);
    }
    let device = DeviceOptions {
        threads: options.threads,
        max_isa: options.max_isa,
    };
    if is_wanted(Native::CONE_NAME) {
        let cone = Native::new(Shape::Cone, Native::CONE_NAME, &device)?;
        add(Box::new(cone), RIVAL_CASES);
    }
    for (sides, name) in SIDES {
        if is_wanted(name) {
            let mesh = Native::new(Shape::Mesh(sides), name, &device)?;
            add(
                Box::new(mesh),
                RIVAL_CASES.min(RIVAL_SIDES / sides as usize),
            );
        }
    }
    Ok(all)
}

/// The names of the rivals, in the order of [`contenders`].
pub fn rival_names() -> impl Iterator<Item = &'static str> {
    let analytic = [Traced::NAME, Native::CONE_NAME];
    analytic.into_iter().chain(SIDES.map(|(_, name)| name))
}

fn is_baseline(formulation: &dyn Formulation) -> bool {
    (formulation.name(), formulation.precision()) == BASELINE
}

/// The default number and length of the samples of each contender.
///
/// Short samples, many of them: where other programs share the processor, a
/// sample is disturbed if a turn of theirs (some milliseconds) falls into it.
/// Samples of 2 ms were, in most rounds, and came out three times too long; a
/// tenth of that is disturbed about one time in ten, which a median doesn't
/// notice, and is still 10^4 ticks of the clock.
pub const USUAL_ROUNDS: Rounds = Rounds {
    rounds: 101,
    sample_s: 2e-4,
};

/// How many rays are timed. A processor learns the branches of a batch that is
/// run again and again: with 1000 rays literal `center-dot` in f32 took 20 ns,
/// with 4000 and with 16 000 twice as long, as it does in a callback that
/// never sees a ray twice. More would only leave the second-level cache.
pub const USUAL_TIMED: u64 = 8192;

/// What was found of a contender.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its name.
    pub name: &'static str,
    /// What it computes in.
    pub precision: Precision,
    /// What its time is.
    pub times: Times,
    /// Nanoseconds a ray.
    pub ns: Spread,
    /// Time over the baseline's of the same round; `None` without baseline.
    pub ratio: Option<Spread>,
    /// Nanoseconds a ray, by round.
    pub ns_by_round: Vec<f64>,
    /// How it did on each family.
    pub errors: Vec<Errors>,
    /// Memory kept for a cylinder.
    pub bytes: usize,
}

impl Row {
    /// The 99th percentile of the position error in radii on the ordinary
    /// cases.
    #[must_use]
    pub fn p99_error_r(&self) -> Option<f64> {
        self.errors.first()?.p99_r
    }

    /// The family in which that percentile is greatest, by number, and its
    /// value there.
    #[must_use]
    pub fn worst(&self) -> Option<(usize, f64)> {
        let percentiles = self.errors.iter().enumerate();
        percentiles
            .filter_map(|(family, errors)| Some((family, errors.p99_r?)))
            .max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()))
    }

    /// The share of wrong hits and misses, the mean over the families.
    #[must_use]
    pub fn wrong_percent_mean(&self) -> f64 {
        let sum: f64 = self.errors.iter().map(Errors::wrong_percent).sum();
        sum / self.errors.len() as f64
    }
}

/// The whole outcome.
#[derive(Clone, Debug, PartialEq)]
pub struct Accuracy {
    /// The families; the first is the ordinary one.
    pub families: Vec<&'static str>,
    /// A row a contender.
    pub rows: Vec<Row>,
}

impl Accuracy {
    /// The number of steps that [`Accuracy::measure`] reports.
    #[must_use]
    pub fn steps(families: usize, contenders: usize, rounds: Rounds) -> usize {
        families * contenders + rounds.rounds
    }

    /// Measures all contenders: errors on `cases`, whose first family is the ordinary one,
    /// and times on the ordinary cases `timed`.
    /// `after_step` is called as often as [`Accuracy::steps`] says.
    ///
    /// # Panics
    /// When there is no family, or nothing to time.
    #[must_use]
    pub fn measure(
        cases: &[JudgedCases],
        timed: &[Problem],
        contenders: &[Contender],
        rounds: Rounds,
        timer: &mut dyn Timer,
        after_step: &mut dyn FnMut(),
    ) -> Self {
        assert!(!cases.is_empty(), "no case to judge");
        assert!(!timed.is_empty(), "no ray to time");

        let mut errors = Vec::new();
        for contender in contenders {
            let mut judge = |family: &JudgedCases| {
                let errors = family.judge(contender.formulation.as_ref(), contender.most_cases);
                after_step();
                errors
            };
            errors.push(cases.iter().map(&mut judge).collect::<Vec<_>>());
        }

        let batches: Vec<Box<dyn Batch>> = contenders
            .iter()
            .map(|contender| contender.formulation.batch(timed))
            .collect();
        let seconds = interleave(timer, &batches, rounds, after_step);
        let baseline = contenders
            .iter()
            .position(|contender| is_baseline(contender.formulation.as_ref()))
            .map(|index| seconds[index].as_slice());

        let rows = contenders
            .iter()
            .zip(errors)
            .zip(&seconds)
            .map(|((contender, errors), seconds)| {
                let ns = |seconds: &f64| seconds * 1e9 / timed.len() as f64;
                let ns_by_round: Vec<f64> = seconds.iter().map(ns).collect();
                Row {
                    name: contender.formulation.name(),
                    precision: contender.formulation.precision(),
                    times: contender.times,
                    ns: Spread::of(&ns_by_round),
                    ratio: baseline.map(|baseline| Spread::of(&ratios(seconds, baseline))),
                    ns_by_round,
                    errors,
                    bytes: contender.formulation.bytes(),
                }
            })
            .collect();
        Self {
            families: cases.iter().map(JudgedCases::name).collect(),
            rows,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formulations::Answer;
    use crate::samples::{self, Blind, Shifted};

    /// A clock that advances one second at each reading.
    struct SlowingClock(f64);

    impl Timer for SlowingClock {
        fn seconds(&mut self, work: &mut dyn FnMut()) -> f64 {
            work();
            self.0 += 1.0;
            self.0
        }
    }

    const ROUNDS: Rounds = Rounds {
        rounds: 3,
        sample_s: 0.0,
    };

    fn contender(formulation: impl Formulation + 'static) -> Contender {
        Contender {
            formulation: Box::new(formulation),
            times: Times::Solver,
            most_cases: usize::MAX,
        }
    }

    /// A formulation of another name.
    struct Renamed(&'static str, Shifted);

    impl Formulation for Renamed {
        fn name(&self) -> &'static str {
            self.0
        }
        fn precision(&self) -> Precision {
            self.1.precision()
        }
        fn bytes(&self) -> usize {
            self.1.bytes()
        }
        fn answers(&self, problems: &[Problem]) -> Vec<Option<Answer>> {
            self.1.answers(problems)
        }
        fn batch(&self, problems: &[Problem]) -> Box<dyn Batch> {
            self.1.batch(problems)
        }
    }

    #[test]
    fn measure_times_errors_and_ratios_are_put_in_their_rows() {
        let cases = [
            JudgedCases::new("ordinary", samples::problems(1, 200)),
            JudgedCases::new("other", samples::problems(2, 50)),
        ];
        let contenders = [
            contender(Renamed("triple-product", Shifted(0.0))),
            contender(Shifted(0.5)),
            contender(Blind),
        ];
        let mut steps = 0;
        let mut after = || steps += 1;
        let found = Accuracy::measure(
            &cases,
            &samples::problems(3, 100),
            &contenders,
            ROUNDS,
            &mut SlowingClock(0.0),
            &mut after,
        );
        assert_eq!(steps, Accuracy::steps(2, 3, ROUNDS));
        assert_eq!(found.families, ["ordinary", "other"]);
        let [exact, shifted, blind] = &found.rows[..] else {
            panic!("three rows")
        };
        // After six warm-up runs the clock shows 7, 8, 9; then the second
        // goes first: 10, 11, 12, the baseline last; then the third.
        let seconds = |row: &Row| -> Vec<f64> {
            let back = |ns: &f64| (ns * 100.0 / 1e9).round();
            row.ns_by_round.iter().map(back).collect()
        };
        assert_eq!(seconds(exact), [7.0, 12.0, 14.0]);
        assert_eq!(seconds(shifted), [8.0, 10.0, 15.0]);
        assert_eq!(seconds(blind), [9.0, 11.0, 13.0]);
        let ratio = shifted.ratio.unwrap();
        assert!((ratio.median - 15.0 / 14.0).abs() < 1e-12, "{ratio:?}");
        assert_eq!(exact.ratio.unwrap().median, 1.0);

        assert_eq!(exact.errors[1].cases, 50);
        assert!(exact.p99_error_r().unwrap() < 1e-12);
        assert!(shifted.p99_error_r().unwrap() > 0.5);
        assert_eq!(shifted.wrong_percent_mean(), 0.0);
        assert!(blind.wrong_percent_mean() > 20.0);
        assert_eq!((blind.p99_error_r(), blind.worst()), (None, None));
    }

    #[test]
    fn worst_family_answers_not_finite_are_worse_than_any_number() {
        let cases = [JudgedCases::new("ordinary", samples::problems(1, 20))];
        let contenders = [contender(Shifted(0.5))];
        let mut found = Accuracy::measure(
            &cases,
            &samples::problems(3, 100),
            &contenders,
            ROUNDS,
            &mut SlowingClock(0.0),
            &mut || {},
        );
        let row = &mut found.rows[0];
        assert_eq!(row.ratio, None);
        let errors = row.errors[0];
        for p99_r in [None, Some(1e300), Some(f64::INFINITY), Some(2.0)] {
            row.errors.push(Errors { p99_r, ..errors });
        }
        assert_eq!(row.worst(), Some((3, f64::INFINITY)));
    }

    #[test]
    fn contenders_are_those_wanted_and_the_baseline() {
        let formulations: Vec<Box<dyn Formulation>> = vec![
            Box::new(Shifted(0.0)),
            Box::new(Renamed("triple-product", Shifted(0.0))),
            Box::new(Blind),
        ];
        let wanted = |name: &str| ["blind", "mesh-6", "cone-curve"].contains(&name);
        let all = contenders(formulations, &Options::default(), wanted).unwrap();
        let names: Vec<_> = all.iter().map(|one| one.formulation.name()).collect();
        assert_eq!(names, ["triple-product", "blind", "cone-curve", "mesh-6"]);
        assert!(rival_names().any(|name| name == "mesh-1024"));
        assert!(all.iter().all(|one| one.most_cases >= 195));
    }
}
