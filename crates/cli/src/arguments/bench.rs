//! The arguments of `cyltrace bench`.

use std::num::{NonZeroU64, NonZeroUsize};
use std::path::PathBuf;

use clap::{Args, Subcommand};
use cyltrace::scene::{GREATEST_CASES, GREATEST_ROUNDS, GREATEST_TIMED_RAYS};
use cyltrace_bench::traversal::{Representation, SceneName};

use super::numbers::count_up_to;
use super::{Common, DecisionArguments};
use crate::memory;

/// Measure run times and errors
#[derive(Args, Debug)]
pub struct BenchArguments {
    #[command(subcommand)]
    pub bench: Bench,
}

#[derive(Debug, Subcommand)]
pub enum Bench {
    Accuracy(AccuracyArguments),
    Traversal(TraversalArguments),
    Scale(ScaleArguments),
}

/// Compare the time and the error of every known formulation, of Embree's cone
/// curve and of meshes, on the same cases
#[derive(Args, Debug)]
pub struct AccuracyArguments {
    /// Write accuracy.svg, accuracy.csv and index.html to DIR
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Cases of each family; meshes and other rivals get at most 1000 of them
    #[arg(long, value_name = "N", default_value = "5000", value_parser = count_up_to::<NonZeroU64>(GREATEST_CASES))]
    pub cases: NonZeroU64,
    /// Chooses the cases
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Samples of each time
    #[arg(long, value_name = "N", default_value = "101", value_parser = count_up_to::<NonZeroUsize>(GREATEST_ROUNDS))]
    pub rounds: NonZeroUsize,
    /// Measure this formulation or rival only, beside triple-product; may be
    /// given several times
    #[arg(long, value_name = "NAME")]
    pub formulation: Vec<String>,
    #[command(flatten)]
    pub common: Common,
}

/// Compare whole traversals: this library beside a callback in C, Embree's own
/// solids, meshes and instances
///
/// Each rival is timed in turns with this library, on the same coherent, shadow
/// and incoherent rays, in the order given and in that of this library's batches;
/// the better order counts. An exact oracle judges a sample of the rays: the exit
/// code is 1 if this library has one of them wrong. A rival that cannot be built
/// here is a row without figures that says why.
///
/// Scenes: sticks_1e4, sticks_1e5 and sticks_1e6 are random sticks in the unit
/// cube, 2 n^(-1/3) long and a twentieth of that in radius; lattice and forest are
/// read from their files in --scenes; cones_1e5, rounded_cones_1e5, spheres_1e5,
/// cuboids_1e5 and disks_1e5 are random solids, of which a ray meets as many as of
/// sticks. Without --threads, one thread and all are timed.
#[derive(Args, Debug)]
pub struct TraversalArguments {
    /// Only this scene; may be repeated [default: all ten]
    #[arg(long, value_name = "NAME", value_parser = parse_scene)]
    pub scene: Vec<SceneName>,
    /// Only this rival: a name of the column representation, or own for Embree's own
    /// geometry of each kind of solid (curves, points, the triangles of cuboids); may
    /// be repeated [default: all]
    #[arg(long, value_name = "NAME", value_parser = parse_rival)]
    pub rival: Vec<Chosen>,
    /// Where lattice.toml and forest.toml are
    #[arg(long, value_name = "DIR", default_value = "scenes")]
    pub scenes: PathBuf,
    /// Rays of each kind
    #[arg(long, value_name = "N", default_value = "16384", value_parser = count_up_to::<NonZeroUsize>(GREATEST_TIMED_RAYS))]
    pub rays: NonZeroUsize,
    /// Samples of each time
    #[arg(long, value_name = "N", default_value = "11", value_parser = count_up_to::<NonZeroUsize>(GREATEST_ROUNDS))]
    pub rounds: NonZeroUsize,
    /// Chooses solids and rays
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Leave out rivals that would take more than SIZE, such as 500MB or 4GiB
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = memory::parse_size)]
    pub max_memory: u64,
    /// Write figures, traversal.csv and index.html to DIR
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub decisions: DecisionArguments,
    #[command(flatten)]
    pub common: Common,
}

/// Follow this library to larger and larger scenes
///
/// Time to build, memory and rays a second against the number of cylinders
/// (random sticks, 10^3 to 10^7) and of placements of a prototype of 1000 sticks
/// (10^2 to 10^7), with the exponents by which they grow.
#[derive(Args, Debug)]
pub struct ScaleArguments {
    /// Stop at N cylinders and N placements
    #[arg(long, value_name = "N", default_value = "10000000")]
    pub most: NonZeroUsize,
    /// Rays of each kind
    #[arg(long, value_name = "N", default_value = "65536", value_parser = count_up_to::<NonZeroUsize>(GREATEST_TIMED_RAYS))]
    pub rays: NonZeroUsize,
    /// Samples of each time
    #[arg(long, value_name = "N", default_value = "5", value_parser = count_up_to::<NonZeroUsize>(GREATEST_ROUNDS))]
    pub rounds: NonZeroUsize,
    /// Chooses scenes and rays
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Leave out scenes whose records and trees would take more than SIZE, such
    /// as 500MB or 4GiB
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = memory::parse_size)]
    pub max_memory: u64,
    /// Write figures, scale.csv and index.html to DIR
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub common: Common,
}

/// The rivals that a name chooses.
#[derive(Clone, Debug)]
pub struct Chosen(pub Vec<Representation>);

/// The error names what is known.
fn parse_rival(text: &str) -> Result<Chosen, String> {
    Representation::rivals(text).map(Chosen).ok_or_else(|| {
        let all = Representation::ALL.into_iter();
        let rivals = all.filter(|one| !one.is_ours()).map(Representation::name);
        let names: Vec<&str> = ["own"].into_iter().chain(rivals).collect();
        format!("it must be one of {}", names.join(", "))
    })
}

/// The error names what is known.
fn parse_scene(text: &str) -> Result<SceneName, String> {
    let known = SceneName::ALL.into_iter().find(|one| one.name() == text);
    known.ok_or_else(|| {
        let names = SceneName::ALL.map(SceneName::name).join(", ");
        format!("it must be one of {names}")
    })
}
