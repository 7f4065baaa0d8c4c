//! Formulations of the cylinder and solvers of the other solids against the oracle,
//! on families of hard cases.
//!
//! Set operations have families and a judge of their own (`composed.rs`).
//!
//! Every case is put to the oracle once and to each [`Contender`] for its kind of
//! solid; what comes out is one [`Cell`] for each family, kind of inputs and
//! contender. A family without a contender is left out. The figures are the same for any number of threads.

mod cell;
mod composed;
mod contender;
mod family;
mod map;
mod promises;
mod quantiles;
mod replay;
mod self_hits;
mod witness;

pub use cell::{Cell, Figures};
pub use composed::{ComposedWitness, Verdict};
pub use contender::Contender;
pub use family::StressFamily;
pub use map::{UlpMap, ulp_map};
pub use promises::{Claim, PROMISES, Promise};
pub use quantiles::Quantiles;
pub use replay::{ReplayError, StressCase, from_word, to_bits, to_word};
pub use witness::{TrueAnswer, Witness};

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use cyltrace_oracle::cases::{AnyFamily, Case, ComposedFamily, Inputs};

/// Cases that are worked on at a time: enough for a contender's own loop to
/// count, few enough that threads end together.
const BLOCK: u64 = 500;

/// The same of set operations, about which the oracle takes longer.
const COMPOSED_BLOCK: u64 = 20;

/// What to run.
pub struct Settings {
    /// The families, in order.
    pub families: Vec<StressFamily>,
    /// The kinds of inputs, in order.
    pub inputs: Vec<Inputs>,
    /// Who answers, in order.
    pub contenders: Vec<Contender>,
    /// Cases of each family and kind of inputs; see [`Settings::cases_of`].
    pub cases: u64,
    /// Chooses the cases.
    pub seed: u64,
}

impl Settings {
    /// How many cases will be put to the oracle.
    #[must_use]
    pub fn all_cases(&self) -> u64 {
        let families = self.judged_families();
        let cases: u64 = families.map(|family| self.cases_of(family)).sum();
        cases * self.inputs.len() as u64
    }

    /// The cases of a family. The oracle takes some hundred times longer about set
    /// operations: they get all up to 1000 cases, and beyond a hundredth of the cases if
    /// that is more.
    #[must_use]
    pub fn cases_of(&self, family: StressFamily) -> u64 {
        match family {
            StressFamily::Solid(_) => self.cases,
            StressFamily::Composed(_) => self.cases.min((self.cases / 100).max(1000)),
        }
    }

    /// The families for which there is a contender.
    fn judged_families(&self) -> impl Iterator<Item = StressFamily> {
        let families = self.families.iter().copied();
        families.filter(|family| self.contenders_for(*family).next().is_some())
    }

    fn contenders_for(&self, family: StressFamily) -> impl Iterator<Item = &Contender> {
        let contenders = self.contenders.iter();
        contenders.filter(move |contender| contender.answers_about(family))
    }
}

/// Runs all of it in the rayon pool that this is called in; `progress` gets
/// how many more cases are done. `None` when `stop` was set.
pub fn run(
    settings: &Settings,
    progress: &(dyn Fn(u64) + Sync),
    stop: &AtomicBool,
) -> Option<Vec<Cell>> {
    let mut cells = Vec::new();
    for &inputs in &settings.inputs {
        for family in settings.judged_families() {
            let figures = run_family(settings, family, inputs, progress, stop)?;
            let named = settings.contenders_for(family).zip(figures);
            cells.extend(named.map(|(contender, figures)| Cell {
                family,
                inputs,
                formulation: contender.name(),
                precision: contender.precision(),
                seed: settings.seed,
                figures,
            }));
        }
    }
    Some(cells)
}

/// One set of figures a contender.
fn run_family(
    settings: &Settings,
    family: StressFamily,
    inputs: Inputs,
    progress: &(dyn Fn(u64) + Sync),
    stop: &AtomicBool,
) -> Option<Vec<Figures>> {
    let none = || -> Vec<Figures> {
        let contenders = settings.contenders_for(family);
        contenders.map(|_| Figures::default()).collect()
    };
    let (cases, block_size) = match family {
        StressFamily::Solid(_) => (settings.cases_of(family), BLOCK),
        StressFamily::Composed(_) => (settings.cases_of(family), COMPOSED_BLOCK),
    };
    let figures = (0..cases.div_ceil(block_size))
        .into_par_iter()
        .map(|block| {
            if stop.load(Ordering::Relaxed) {
                return none();
            }
            let first = block * block_size;
            let end = (first + block_size).min(cases);
            let figures = match family {
                StressFamily::Solid(family) => run_block(settings, family, inputs, first..end),
                StressFamily::Composed(family) => {
                    run_composed(settings, family, inputs, first..end)
                }
            };
            progress(end - first);
            figures
        })
        .reduce(none, |mut all, block| {
            for (all, block) in all.iter_mut().zip(block) {
                all.merge(block);
            }
            all
        });
    (!stop.load(Ordering::Relaxed)).then_some(figures)
}

fn run_composed(
    settings: &Settings,
    family: ComposedFamily,
    inputs: Inputs,
    indices: std::ops::Range<u64>,
) -> Vec<Figures> {
    let mut figures = Figures::default();
    for index in indices {
        let case = family.case(settings.seed, index, inputs);
        let verdict = Verdict::of(&case, &ComposedWitness::new(&case));
        figures.count(&verdict, index);
    }
    settings
        .contenders_for(family.into())
        .map(|_| figures.clone())
        .collect()
}

fn run_block(
    settings: &Settings,
    family: AnyFamily,
    inputs: Inputs,
    indices: std::ops::Range<u64>,
) -> Vec<Figures> {
    let witnesses: Vec<Witness> = indices
        .map(|index| Witness::new(family.case(settings.seed, index, inputs), index, inputs))
        .collect();
    let cases: Vec<Case> = witnesses.iter().map(|witness| witness.case).collect();
    settings
        .contenders_for(family.into())
        .map(|contender| {
            let mut figures = Figures::default();
            let answers = contender.answers(&cases);
            for (witness, answer) in witnesses.iter().zip(&answers) {
                figures.judge(witness, answer.as_ref(), contender.precision(), inputs);
            }
            if contender.is_own() {
                let spawned = self_hits::count(contender, &witnesses, &answers, settings.seed);
                figures.spawned += spawned.rays;
                figures.self_hits += spawned.self_hits;
            }
            figures
        })
        .collect()
}
