//! The command line as clap reads it. The help texts here are also the tables of options
//! in docs/command-line.md, see `reference.rs`.

use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use cyltrace::embree::MaxIsa;
use cyltrace::scene::{
    Decimal, Delimiter, Film, GREATEST_CASES, GREATEST_SAMPLES, Integrator, Sampler, TableFormat,
};
use cyltrace_bench::stress::{Contender, StressFamily};
use cyltrace_oracle::cases::{Family, Inputs};

mod bench;
mod check;
mod farm;
mod frames;
mod names;
mod numbers;
mod parts;
mod picture;

pub use bench::{
    AccuracyArguments, Bench, BenchArguments, ImageArguments, ScaleArguments, TraversalArguments,
};
pub use check::{CheckArguments, Rays};
pub use farm::{Farm, FarmArguments, SlurmScriptArguments};
pub use frames::FrameArguments;
use names::one_of;
use numbers::{count_up_to, parse_seed, parse_segments, parse_size, parse_threads};
pub use parts::{MergeArguments, PartArguments, PartsArguments, WorkerArguments};
pub use picture::PictureArguments;

use super::exit_codes;
use super::limit::MemoryArguments;
use super::memory;
use super::output_sink::is_standard_stream;

/// Trace rays against cylinders and other analytic solids, and validate the hits
#[derive(Debug, Parser)]
#[command(
    name = "cyltrace",
    version,
    long_about = None,
    after_long_help = exit_codes::help(),
    max_term_width = 100
)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    Render(RenderArguments),
    Trace(TraceArguments),
    Info(InfoArguments),
    Tessellate(TessellateArguments),
    Bench(BenchArguments),
    Stress(StressArguments),
    Check(CheckArguments),
    Merge(MergeArguments),
    Parts(PartsArguments),
    Farm(FarmArguments),
    Completions(CompletionsArguments),
    Man(ManArguments),
}

/// The options of every command that reads, traces or measures.
#[derive(Args, Debug)]
pub struct Common {
    /// Write the results and times of the run as JSON to FILE; `-` writes them to standard
    /// output, in place of the text
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Print neither text nor progress
    #[arg(long, short)]
    pub quiet: bool,
    /// Use N threads, 1 to 1024; results do not depend on the number [default: all of the
    /// machine]
    #[arg(long, value_name = "N", value_parser = parse_threads, allow_negative_numbers = true)]
    pub threads: Option<NonZeroUsize>,
    /// Restrict Embree to an instruction set: `sse2`, `sse4.2`, `avx`, `avx2` or `avx512`;
    /// results do not depend on it [default: the best of the machine]
    #[arg(long, value_name = "NAME")]
    pub max_isa: Option<MaxIsa>,
}

impl Common {
    /// Whether text is printed for people: not under `--quiet`, nor when the JSON goes to
    /// standard output.
    pub fn prints(&self) -> bool {
        !self.quiet
            && self
                .json
                .as_deref()
                .is_none_or(|path| !is_standard_stream(path))
    }
}

/// Render a picture of a scene
#[derive(Args, Debug)]
#[command(group(ArgGroup::new("divided").args(["part", "workers"])), mut_arg("resume", |arg| arg.requires("divided")))]
pub struct RenderArguments {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// Write the picture to FILE: `.png` (8-bit sRGB, clamped to [0, 1] unless there is a tone
    /// map) or `.exr` (32-bit linear, not clamped)
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Render W by H pixels, at most 2^28 in all [default: the scene's, else 1280x720]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<Film>,
    /// Take N samples per pixel, 1 to 2^20; powers of two are best [default: the scene's,
    /// else 4]
    #[arg(long, value_name = "N", value_parser = count_up_to::<NonZeroU32>(GREATEST_SAMPLES.into()), allow_negative_numbers = true)]
    pub spp: Option<NonZeroU32>,
    /// Show the result of this integrator [default: the scene's, else `path` if it has lights or materials that need it, else `sun`]
    #[arg(long, value_name = "NAME", value_enum)]
    pub integrator: Option<IntegratorName>,
    /// Spread samples evenly (`sobol`), or as independent random numbers (`random`), for
    /// comparisons [default: the scene's, else `sobol`]
    #[arg(long, value_name = "NAME", value_parser = one_of(Sampler::ALL, Sampler::name))]
    pub sampler: Option<Sampler>,
    /// Seed the random numbers
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        value_parser = parse_seed,
        allow_negative_numbers = true
    )]
    pub seed: u64,
    /// Keep finished tiles in FILE while rendering. The same command goes on from there after it
    /// was interrupted or killed, and FILE is removed when the picture is written. Parts have
    /// `--resume` instead, and pictures with `--time` or `--frames` cannot be resumed
    #[arg(long, value_name = "FILE", conflicts_with_all = ["divided", "time", "frames"])]
    pub checkpoint: Option<PathBuf>,
    #[command(flatten)]
    pub picture: PictureArguments,
    #[command(flatten)]
    pub frames: FrameArguments,
    #[command(flatten)]
    pub part: PartArguments,
    #[command(flatten)]
    pub workers: WorkerArguments,
    #[command(flatten)]
    pub memory: MemoryArguments,
    #[command(flatten)]
    pub decisions: DecisionArguments,
    #[command(flatten)]
    pub common: Common,
}

/// Trace the rays of a table, or find the solids that contain the points of one
#[derive(Args, Debug)]
#[command(mut_arg("resume", |arg| arg.requires("part")))]
pub struct TraceArguments {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    #[command(flatten)]
    pub table: TraceTable,
    #[command(flatten)]
    pub format: FormatArguments,
    /// Write the results to FILE as CSV: one row per ray in the order of the rays, or for
    /// `--points` one row per solid that contains a point; `-` is standard output
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// List every hit of a ray in the order of `t`, not only the first
    #[arg(long, conflicts_with = "points")]
    pub all: bool,
    #[command(flatten)]
    pub part: PartArguments,
    #[command(flatten)]
    pub memory: MemoryArguments,
    #[command(flatten)]
    pub decisions: DecisionArguments,
    #[command(flatten)]
    pub common: Common,
}

/// How hits are decided.
#[derive(Args, Clone, Copy, Debug)]
pub struct DecisionArguments {
    /// Decide hit, miss and part by exact arithmetic for every f64 ray. Without this option,
    /// they are certain only for numbers that f32 represents. Set operations are not
    /// affected. Rays take up to 1.8 times as long
    #[arg(long)]
    pub exact: bool,
}

/// The table that is read: one of the two.
#[derive(Args, Debug)]
#[group(required = true, multiple = false)]
pub struct TraceTable {
    /// Trace the rays of this table: columns `ox,oy,oz,dx,dy,dz` and optionally
    /// `t_min,t_max` (0 and `inf` if absent); `-` is standard input
    #[arg(long, value_name = "FILE")]
    pub rays: Option<PathBuf>,
    /// Find the solids that contain the points of this table: columns `x,y,z`; `-` is
    /// standard input
    #[arg(long, value_name = "FILE")]
    pub points: Option<PathBuf>,
}

/// The format of the tables that the command line names.
#[derive(Args, Clone, Debug)]
pub struct FormatArguments {
    /// Split the cells of tables at this delimiter: `comma`, `semicolon`, `tab` or `blanks`
    /// [default: the one that their first lines show]
    #[arg(long, value_name = "NAME")]
    pub delimiter: Option<Delimiter>,
    /// Read numbers in tables with this decimal separator: `point` or `comma` [default:
    /// `point`]
    #[arg(long, value_name = "NAME")]
    pub decimal: Option<Decimal>,
    /// Read a table of rays or points without a header: the numbers of its columns from 0,
    /// in the order `ox,oy,oz,dx,dy,dz,t_min,t_max` (six or eight numbers) or `x,y,z`
    #[arg(long, value_name = "N,N", value_delimiter = ',')]
    pub columns: Vec<u64>,
}

impl FormatArguments {
    /// The delimiter and the decimal separator.
    pub fn format(&self) -> TableFormat {
        TableFormat {
            delimiter: self.delimiter,
            decimal: self.decimal.unwrap_or_default(),
        }
    }
}

/// `--max-isa` of a command that only estimates what Embree takes.
const INFO_MAX_ISA: &str = "Estimate the memory of Embree's trees for an instruction set: `sse2`, `sse4.2`, `avx`, `avx2` or `avx512` [default: the best of the machine]";

/// `--max-isa` of a command that does not use Embree.
const TESSELLATE_MAX_ISA: &str = "Accepted as by other commands, without effect";

/// Print what a scene contains, without tracing it
#[derive(Args, Debug)]
#[command(mut_arg("max_isa", |arg| arg.help(INFO_MAX_ISA)))]
pub struct InfoArguments {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    #[command(flatten)]
    pub memory: MemoryArguments,
    #[command(flatten)]
    pub common: Common,
}

/// Write a scene as a triangle mesh with a proven deviation
#[derive(Args, Debug)]
#[command(mut_arg("max_isa", |arg| arg.help(TESSELLATE_MAX_ISA)))]
pub struct TessellateArguments {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// Write the mesh to FILE: `.obj` (text, a group for each placed prototype) or `.ply`
    /// (binary, f64)
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Divide the circle of prisms and other solids of revolution into N sides, 3 to 4096
    #[arg(
        long,
        value_name = "N",
        default_value_t = 64,
        value_parser = parse_segments,
        allow_negative_numbers = true
    )]
    pub segments: u32,
    /// Put the corners of the meshes on the surface, so that the meshes are inside the
    /// solids; this is the default
    #[arg(long, conflicts_with = "circumscribed")]
    pub inscribed: bool,
    /// Let the sides of the meshes touch the surface from outside, so that the solids are
    /// inside the meshes
    #[arg(long)]
    pub circumscribed: bool,
    /// Reject a mesh whose file is larger than SIZE, such as `500MB` or `4GiB`; the size of
    /// a `.ply` is known exactly, that of an `.obj` as an upper bound
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = memory::parse_size)]
    pub max_memory: u64,
    #[command(flatten)]
    pub common: Common,
}

/// Compare every solver with exact arithmetic on hard cases
///
/// Exits with 1 if the library's own solvers break a promise.
#[derive(Args, Debug)]
pub struct StressArguments {
    #[arg(long, value_name = "NAME", help = family_help())]
    pub family: Vec<StressFamily>,
    /// Run N cases of each family and kind of inputs, 1 to 10^7; for set operations, run N up
    /// to 1000, and beyond that the greater of 1000 and N / 100
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(1..=GREATEST_CASES))]
    pub cases: u64,
    /// Seed the cases
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_seed, allow_negative_numbers = true)]
    pub seed: u64,
    /// Run only cases whose numbers f32 represents, or only cases of full f64 numbers
    /// [default: both]
    #[arg(long, value_name = "KIND", value_parser = one_of(Inputs::ALL, Inputs::name))]
    pub inputs: Option<Inputs>,
    /// Run only this solver, on the families that it solves: a formulation of the
    /// ray/cylinder test, a kind of solid, or `set_operations`; may be repeated [default:
    /// all]
    #[arg(long, value_name = "NAME", value_parser = solver())]
    pub formulation: Vec<String>,
    /// Write `stress.txt`, `stress.json` and maps to DIR
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Print the promises and run nothing
    #[arg(long, conflicts_with_all = ["replay", "map"])]
    pub promises: bool,
    /// Print one case and every solver's answer to it; BITS is the word that a run printed,
    /// the bits of a cylinder and a ray, or `FAMILY:INPUTS:SEED:NUMBER` such as
    /// `cone-rim:f32:0:17`
    #[arg(long, value_name = "BITS", conflicts_with = "map")]
    pub replay: Option<String>,
    /// Draw which formulations are right on neighboring floats around the hardest case of
    /// FAMILY, to `ulp_map_FAMILY_INPUTS.png` in the folder of `--report` or else the
    /// current one
    #[arg(long, value_name = "FAMILY")]
    pub map: Option<Family>,
    #[command(flatten)]
    pub common: Common,
}

/// Print a script that completes the command line in a shell
#[derive(Args, Debug)]
pub struct CompletionsArguments {
    /// Complete in this shell
    #[arg(value_name = "SHELL", value_enum)]
    pub shell: Shell,
}

/// Print the manual page, or write the pages of all commands
#[derive(Args, Debug)]
pub struct ManArguments {
    /// Write the pages of `cyltrace` and of every command to DIR; without it, the page of
    /// `cyltrace` is printed
    #[arg(value_name = "DIR")]
    pub directory: Option<PathBuf>,
}

/// The names of the integrators.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum IntegratorName {
    /// sun and sky with shadows
    Sun,
    /// the visible part of an open sky
    Ao,
    /// the outward normal as a color
    Normal,
    /// light scattered any number of times, by materials of all kinds
    Path,
}

impl From<IntegratorName> for Integrator {
    fn from(name: IntegratorName) -> Self {
        match name {
            IntegratorName::Sun => Self::Sun,
            IntegratorName::Ao => Self::Ao,
            IntegratorName::Normal => Self::Normal,
            IntegratorName::Path => Self::Path,
        }
    }
}

/// The help of `--family`.
fn family_help() -> String {
    format!(
        "Run this family only, such as `rim`, `cone-rim`, `cuboid-edge` or `composed-stacks`; may be repeated [default: all {}]",
        StressFamily::all().len()
    )
}

/// Accepts the names of the solvers.
fn solver() -> PossibleValuesParser {
    let all = Contender::all();
    let mut names: Vec<&str> = all.iter().map(Contender::name).collect();
    names.dedup();
    PossibleValuesParser::new(names)
}
