//! The settings of a comparison.

use std::path::PathBuf;

use super::interleave::Workers;
use super::representation::Representation;
use super::scenes::SceneName;
use cyltrace::tracer::Options;

/// The scenes, rays and rivals that are measured.
pub struct Plan {
    /// The scenes.
    pub scenes: Vec<SceneName>,
    /// Where scene files are.
    pub directory: PathBuf,
    /// Rays of each kind.
    pub rays: usize,
    /// Samples of each time, at least 1.
    pub rounds: usize,
    /// Chooses sticks and rays.
    pub seed: u64,
    /// The rivals that take part.
    pub rivals: Vec<Representation>,
    /// The threads that trace; the first set of workers' times make the ratios.
    pub worker_sets: Vec<Workers>,
    /// Rivals that would take more bytes are left out.
    pub max_memory: u64,
    /// How scenes are built.
    pub options: Options,
}

impl Plan {
    /// What takes part, in the order of tables: this library and the rivals.
    pub(super) fn representations(&self) -> impl Iterator<Item = Representation> {
        let takes_part = |one: &Representation| one.is_ours() || self.rivals.contains(one);
        Representation::ALL.into_iter().filter(takes_part)
    }
}
