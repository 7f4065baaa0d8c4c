//! The arguments of `cyltrace bench`.

use std::num::{NonZeroU64, NonZeroUsize};
use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Subcommand};
use cyltrace::scene::{Film, GREATEST_CASES, GREATEST_ROUNDS, GREATEST_TIMED_RAYS, Sampler};
use cyltrace_bench::traversal::{Representation, SceneName};
use cyltrace_bench::{formulations, rival_names};

use super::names::one_of;
use super::numbers::{count_up_to, parse_seed, parse_size};
use super::picture::parse_error;
use super::{Common, DecisionArguments, IntegratorName};
use crate::limit::MemoryArguments;
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
    Image(ImageArguments),
}

/// Compare time and error of every formulation of the ray/cylinder test
///
/// Embree's cone curve and inscribed meshes take part. All contenders get the same cases
/// and are timed in turns.
#[derive(Args, Debug)]
pub struct AccuracyArguments {
    /// Write `accuracy.svg`, `accuracy.csv` and `index.html` to DIR
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Judge N cases of each family, 1 to 10^7; Embree's curve and meshes get at most 1000
    #[arg(long, value_name = "N", default_value = "5000", value_parser = count_up_to::<NonZeroU64>(GREATEST_CASES))]
    pub cases: NonZeroU64,
    /// Seed the cases
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_seed, allow_negative_numbers = true)]
    pub seed: u64,
    /// Take N samples of each time
    #[arg(long, value_name = "N", default_value = "101", value_parser = count_up_to::<NonZeroUsize>(GREATEST_ROUNDS))]
    pub rounds: NonZeroUsize,
    /// Measure only this contender beside `triple-product`; may be repeated [default: all]
    #[arg(long, value_name = "NAME", value_parser = contender())]
    pub formulation: Vec<String>,
    #[command(flatten)]
    pub common: Common,
}

/// Compare whole traversals with Embree's own solids, meshes and instances
///
/// Each rival is built alone beside this library, timed in turns with it on the same rays,
/// and freed before the next. Rivals get the rays in the given order and in the order of
/// this library's batches; the better one counts. An exact oracle judges a sample of the
/// rays, and the exit code is 1 if any answer of this library is wrong. A rival that cannot
/// be built here is a row with a reason in place of figures.
#[derive(Args, Debug)]
pub struct TraversalArguments {
    /// Trace only this scene; may be repeated [default: all]
    #[arg(long, value_name = "NAME", value_parser = one_of(SceneName::ALL.iter().copied(), SceneName::name))]
    pub scene: Vec<SceneName>,
    /// Time only this rival beside this library; may be repeated. `own` is Embree's own
    /// geometry for each kind of solid: curves, points and the triangles of cuboids
    /// [default: all]
    #[arg(long, value_name = "NAME", value_parser = rival())]
    pub rival: Vec<Chosen>,
    /// Read `lattice.toml` and `forest.toml` from DIR
    #[arg(long, value_name = "DIR", default_value = "scenes")]
    pub scenes: PathBuf,
    /// Trace N rays of each kind
    #[arg(long, value_name = "N", default_value = "16384", value_parser = count_up_to::<NonZeroUsize>(GREATEST_TIMED_RAYS))]
    pub rays: NonZeroUsize,
    /// Take N samples of each time
    #[arg(long, value_name = "N", default_value = "11", value_parser = count_up_to::<NonZeroUsize>(GREATEST_ROUNDS))]
    pub rounds: NonZeroUsize,
    /// Seed the solids and the rays
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_seed, allow_negative_numbers = true)]
    pub seed: u64,
    /// Leave out rivals that take more than SIZE of memory, such as `500MB` or `4GiB`
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = memory::parse_size)]
    pub max_memory: u64,
    /// Write figures (SVG), `traversal.csv` and `index.html` to DIR
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub decisions: DecisionArguments,
    #[command(flatten)]
    pub common: Common,
}

/// Measure how time and memory grow with the scene
///
/// Build time, memory and rays per second are measured against the number of cylinders
/// (random sticks, 10^3 to 10^7) and of placements of a prototype of 1000 sticks (10^2 to
/// 10^7), with the exponents of their growth.
#[derive(Args, Debug)]
pub struct ScaleArguments {
    /// Stop at N cylinders and N placements
    #[arg(long, value_name = "N", default_value = "10000000")]
    pub most: NonZeroUsize,
    /// Trace N rays of each kind
    #[arg(long, value_name = "N", default_value = "65536", value_parser = count_up_to::<NonZeroUsize>(GREATEST_TIMED_RAYS))]
    pub rays: NonZeroUsize,
    /// Take N samples of each time
    #[arg(long, value_name = "N", default_value = "5", value_parser = count_up_to::<NonZeroUsize>(GREATEST_ROUNDS))]
    pub rounds: NonZeroUsize,
    /// Seed the scenes and the rays
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_seed, allow_negative_numbers = true)]
    pub seed: u64,
    /// Leave out scenes whose records and trees take more than SIZE of memory, such as
    /// `500MB` or `4GiB`
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = memory::parse_size)]
    pub max_memory: u64,
    /// Write figures (SVG), `scale.csv` and `index.html` to DIR
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub common: Common,
}

/// Compare time and error of pictures
///
/// Each scene is rendered with each integrator that suits it (`sun` only where the scene does not
/// need `path`) and each sampler: with 4, 8, 16 and so on samples for every pixel, and until each
/// error of `--error`. Errors are those against a picture of another seed with 16 times the samples
/// or more. All pictures of a scene and an integrator are timed in turns.
#[derive(Args, Debug)]
pub struct ImageArguments {
    /// The scene files [default: `minimal`, `lattice`, `set_operations` and `forest` in `scenes`]
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// Render W by H pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "160x96")]
    pub size: Film,
    /// Take up to N samples for every pixel, 4 to 65536
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(4..=65_536))]
    pub spp: u32,
    /// Render until this error, as `render --error`; may be repeated [default: 0.2 and 0.1]
    #[arg(long, value_name = "E", value_parser = parse_error, allow_negative_numbers = true)]
    pub error: Vec<f64>,
    /// Render with this integrator only; may be repeated
    #[arg(long, value_name = "NAME", value_enum)]
    pub integrator: Vec<IntegratorName>,
    /// Render with this sampler only; may be repeated
    #[arg(long, value_name = "NAME", value_parser = one_of(Sampler::ALL, Sampler::name))]
    pub sampler: Vec<Sampler>,
    /// Take N samples of each time
    #[arg(long, value_name = "N", default_value = "3", value_parser = count_up_to::<NonZeroUsize>(GREATEST_ROUNDS))]
    pub rounds: NonZeroUsize,
    /// Seed the random numbers
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_seed, allow_negative_numbers = true)]
    pub seed: u64,
    /// Write figures (SVG), `image.csv` and `index.html` to DIR
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    #[command(flatten)]
    pub memory: MemoryArguments,
    #[command(flatten)]
    pub common: Common,
}

/// The rivals that a name chooses.
#[derive(Clone, Debug)]
pub struct Chosen(pub Vec<Representation>);

/// Accepts `own` and the names of single rivals.
fn rival() -> impl TypedValueParser<Value = Chosen> {
    let all = Representation::ALL.into_iter();
    let rivals = all.filter(|one| !one.is_ours()).map(|one| one.to_string());
    let names: Vec<String> = [String::from("own")].into_iter().chain(rivals).collect();
    PossibleValuesParser::new(names).map(|name| Chosen(Representation::rivals(&name)))
}

/// Accepts the names of the formulations, of the tracer, and of Embree's geometry.
fn contender() -> PossibleValuesParser {
    let all = formulations::all();
    let mut names: Vec<&str> = all.iter().map(|one| one.name()).collect();
    // Each name occurs for f32 and for f64.
    names.sort_unstable();
    names.dedup();
    PossibleValuesParser::new(names.into_iter().chain(rival_names()))
}
