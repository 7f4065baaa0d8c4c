//! Formulations against the oracle, on families of hard cases.
//!
//! Every case is put to the oracle once and to each formulation; what comes
//! out is one [`Cell`] for each family, kind of inputs and formulation. The
//! figures are the same for any number of threads.

mod cell;
mod map;
mod promises;
mod quantiles;
mod replay;
mod self_hits;
mod witness;

pub use cell::{Cell, Figures};
pub use map::{UlpMap, ulp_map};
pub use promises::{Claim, PROMISES, Promise};
pub use quantiles::Quantiles;
pub use replay::{ReplayError, from_bits, to_bits};
pub use self_hits::is_own;
pub use witness::{TrueAnswer, Witness};

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use crate::cases::{Family, Inputs};
use crate::solid::formulations::{Formulation, Problem};

/// Cases that are worked on at a time: enough for a formulation's own loop to
/// count, few enough that threads end together.
const BLOCK: u64 = 500;

/// What to run.
pub struct Settings {
    /// The families, in order.
    pub families: Vec<Family>,
    /// The kinds of inputs, in order.
    pub inputs: Vec<Inputs>,
    /// The formulations, in order.
    pub formulations: Vec<Box<dyn Formulation>>,
    /// Cases of each family and kind of inputs.
    pub cases: u64,
    /// Chooses the cases.
    pub seed: u64,
}

impl Settings {
    /// How many cases will be put to the oracle.
    #[must_use]
    pub fn all_cases(&self) -> u64 {
        self.cases * self.families.len() as u64 * self.inputs.len() as u64
    }
}

/// Runs all of it in the rayon pool that this is called in; `progress` is told
/// how many more cases are done. `None` when `stop` was set.
pub fn run(
    settings: &Settings,
    progress: &(dyn Fn(u64) + Sync),
    stop: &AtomicBool,
) -> Option<Vec<Cell>> {
    let mut cells = Vec::new();
    for &inputs in &settings.inputs {
        for &family in &settings.families {
            let figures = run_family(settings, family, inputs, progress, stop)?;
            let named = settings.formulations.iter().zip(figures);
            cells.extend(named.map(|(formulation, figures)| Cell {
                family,
                inputs,
                formulation: formulation.name(),
                precision: formulation.precision(),
                seed: settings.seed,
                figures,
            }));
        }
    }
    Some(cells)
}

/// One set of figures a formulation.
fn run_family(
    settings: &Settings,
    family: Family,
    inputs: Inputs,
    progress: &(dyn Fn(u64) + Sync),
    stop: &AtomicBool,
) -> Option<Vec<Figures>> {
    let none = || -> Vec<Figures> {
        let formulations = settings.formulations.iter();
        formulations.map(|_| Figures::default()).collect()
    };
    let figures = (0..settings.cases.div_ceil(BLOCK))
        .into_par_iter()
        .map(|block| {
            if stop.load(Ordering::Relaxed) {
                return none();
            }
            let first = block * BLOCK;
            let end = (first + BLOCK).min(settings.cases);
            let figures = run_block(settings, family, inputs, first..end);
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

fn run_block(
    settings: &Settings,
    family: Family,
    inputs: Inputs,
    indices: std::ops::Range<u64>,
) -> Vec<Figures> {
    let witnesses: Vec<Witness> = indices
        .map(|index| Witness::new(family.case(settings.seed, index, inputs), index, inputs))
        .collect();
    let problems: Vec<Problem> = witnesses.iter().map(|witness| witness.problem).collect();
    let formulations = settings.formulations.iter();
    formulations
        .map(|formulation| {
            let mut figures = Figures::default();
            let answers = formulation.answers(&problems);
            for (witness, answer) in witnesses.iter().zip(&answers) {
                figures.judge(witness, answer.as_ref(), formulation.precision(), inputs);
            }
            if self_hits::is_own(formulation.as_ref()) {
                let spawned =
                    self_hits::count(formulation.as_ref(), &witnesses, &answers, settings.seed);
                figures.spawned += spawned.rays;
                figures.self_hits += spawned.self_hits;
            }
            figures
        })
        .collect()
}
