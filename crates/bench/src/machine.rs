//! The machine and the settings of a measurement, without which a time says nothing.

use std::fs;

use cyltrace::embree::{Device, DeviceOptions, MaxIsa};

/// Everything that a run's figures depend on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Environment {
    /// The processor's model name if the system reports it (Linux), else its
    /// architecture.
    pub processor: String,
    /// The processor, and the number of its threads.
    pub machine: String,
    /// Embree's version.
    pub embree: String,
    /// The widest instruction set that Embree and the callbacks use.
    pub isa: &'static str,
    /// The instruction sets that this program was compiled for, beyond the
    /// first of its architecture.
    pub target_features: Vec<&'static str>,
    /// The commit of the sources, if `CYLTRACE_COMMIT` was set when compiling.
    pub commit: Option<&'static str>,
    /// Cases of each family, or rays of each kind.
    pub cases: u64,
    /// The seed of the cases.
    pub seed: u64,
    /// Samples of each time.
    pub rounds: usize,
}

impl Environment {
    /// The environment of this program on this machine.
    #[must_use]
    pub fn here(max_isa: Option<MaxIsa>, cases: u64, seed: u64, rounds: usize) -> Self {
        let processor = processor();
        let count = std::thread::available_parallelism().map_or(1, usize::from);
        Self {
            machine: format!("{processor}, {count} processors"),
            processor,
            embree: embree_version(),
            isa: MaxIsa::name_in_use(max_isa),
            target_features: target_features(),
            commit: option_env!("CYLTRACE_COMMIT"),
            cases,
            seed,
            rounds,
        }
    }

    /// The environment in one or two sentences.
    #[must_use]
    pub fn sentence(&self) -> String {
        format!(
            "{} cases per family with f32 inputs, seed {}, {} rounds. {}",
            self.cases,
            self.seed,
            self.rounds,
            self.place()
        )
    }

    /// The machine and the program, as a sentence.
    #[must_use]
    pub fn place(&self) -> String {
        let compiled = if self.target_features.is_empty() {
            String::from("the default target")
        } else {
            self.target_features.join(", ")
        };
        let commit = self
            .commit
            .map_or_else(String::new, |commit| format!(" from {commit}"));
        format!(
            "{}; compiled for {compiled}{commit}; Embree {} on {}.",
            self.machine, self.embree, self.isa
        )
    }
}

fn embree_version() -> String {
    let device = Device::new(&DeviceOptions::default());
    device.map_or_else(
        |_| String::from("unknown"),
        |device| device.version().to_string(),
    )
}

fn processor() -> String {
    let described = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = described
        .lines()
        .find_map(|line| line.strip_prefix("model name"));
    let name = name.map(|rest| rest.trim_start_matches([' ', '\t', ':']).trim_end());
    name.unwrap_or(std::env::consts::ARCH).to_owned()
}

fn target_features() -> Vec<&'static str> {
    [
        ("sse4.2", cfg!(target_feature = "sse4.2")),
        ("avx", cfg!(target_feature = "avx")),
        ("avx2", cfg!(target_feature = "avx2")),
        ("fma", cfg!(target_feature = "fma")),
        ("avx512f", cfg!(target_feature = "avx512f")),
    ]
    .into_iter()
    .filter_map(|(name, is_there)| is_there.then_some(name))
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentence_names_target_and_seed() {
        let mut here = Environment::here(Some(MaxIsa::Sse2), 10, 3, 5);
        here.target_features = vec!["avx", "avx2"];
        here.commit = Some("abc");
        here.embree = String::from("3.13.5");
        let text = here.sentence();
        for part in [
            "10 cases",
            "seed 3",
            "5 rounds",
            "avx, avx2 from abc",
            "Embree 3.13.5 on sse2",
        ] {
            assert!(text.contains(part), "no {part} in {text}");
        }
        assert!(!here.processor.is_empty() && here.machine.starts_with(&here.processor));
    }
}
