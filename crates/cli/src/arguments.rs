//! The arguments, as clap reads them.

use std::num::{NonZeroU32, NonZeroUsize};
use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand, ValueEnum};
use cyltrace::embree::MaxIsa;
use cyltrace::scene::{
    Decimal, Delimiter, Film, GREATEST_CASES, GREATEST_RAYS, GREATEST_SAMPLES, GREATEST_THREADS,
    Integrator, TableFormat,
};
use cyltrace_bench::stress::StressFamily;
use cyltrace_check::{Class, Replay};
use cyltrace_oracle::cases::{Family, Inputs};

mod bench;
mod numbers;

pub use bench::{AccuracyArguments, Bench, BenchArguments, ScaleArguments, TraversalArguments};
use numbers::{count_up_to, parse_length, parse_seed, parse_segments, parse_size};

use super::limit::MemoryArguments;
use super::memory;
use super::output_sink::is_standard_stream;

/// Traces analytic cylinders through Embree: exact hits, no meshes.
#[derive(Debug, Parser)]
#[command(version, about, long_about = None, max_term_width = 100)]
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
}

/// What every command takes.
#[derive(Args, Debug)]
pub struct Common {
    /// Write the figures of the run to FILE; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Print neither figures nor progress
    #[arg(long, short)]
    pub quiet: bool,
    /// Use N threads [default: as many as the machine has]
    #[arg(long, value_name = "N", value_parser = count_up_to::<NonZeroUsize>(GREATEST_THREADS as u64), allow_negative_numbers = true)]
    pub threads: Option<NonZeroUsize>,
    /// Hold Embree to an instruction set: sse2, sse4.2, avx, avx2 or avx512
    #[arg(long, value_name = "NAME")]
    pub max_isa: Option<MaxIsa>,
}

impl Common {
    /// Whether the lines meant for people are printed: not when asked to be
    /// quiet, nor when standard output is for the figures.
    pub fn prints(&self) -> bool {
        !self.quiet
            && self
                .json
                .as_deref()
                .is_none_or(|path| !is_standard_stream(path))
    }
}

/// Make a picture of a scene
#[derive(Args, Debug)]
pub struct RenderArguments {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// The picture: a name ending in .png (8-bit sRGB, clamped to [0, 1]) or
    /// .exr (32-bit linear)
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Size of the picture in pixels [default: the scene's, else 1280x720]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<Film>,
    /// Samples a pixel; powers of two are best [default: the scene's, else 4]
    #[arg(long, value_name = "N", value_parser = count_up_to::<NonZeroU32>(GREATEST_SAMPLES.into()), allow_negative_numbers = true)]
    pub spp: Option<NonZeroU32>,
    /// What the picture shows [default: the scene's, else sun]
    #[arg(long, value_name = "NAME", value_enum)]
    pub integrator: Option<IntegratorName>,
    /// Chooses the random numbers
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        value_parser = parse_seed,
        allow_negative_numbers = true
    )]
    pub seed: u64,
    #[command(flatten)]
    pub memory: MemoryArguments,
    #[command(flatten)]
    pub decisions: DecisionArguments,
    #[command(flatten)]
    pub common: Common,
}

/// Trace rays from a table and write their hits to another, or say which solids
/// hold points
#[derive(Args, Debug)]
pub struct TraceArguments {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    #[command(flatten)]
    pub table: TraceTable,
    #[command(flatten)]
    pub format: FormatArguments,
    /// CSV of hits, one row a ray, in order; with --points of the solids that hold
    /// each point, one row a solid. `-` is standard output
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Write every hit of a ray, in order of t, instead of the first
    #[arg(long, conflicts_with = "points")]
    pub all: bool,
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
    /// Decide hits, misses and parts of cylinders as exact arithmetic does for any f64
    /// ray, which takes longer: cylinders that share their ends leave no seam
    #[arg(long)]
    pub exact: bool,
}

/// What is asked about.
#[derive(Args, Debug)]
#[group(required = true, multiple = false)]
pub struct TraceTable {
    /// CSV with the columns ox,oy,oz,dx,dy,dz and optionally t_min,t_max
    /// (defaults 0 and inf); `-` is standard input
    #[arg(long, value_name = "FILE")]
    pub rays: Option<PathBuf>,
    /// CSV with the columns x,y,z; `-` is standard input
    #[arg(long, value_name = "FILE")]
    pub points: Option<PathBuf>,
}

/// How the tables on the command line are written.
#[derive(Args, Clone, Debug)]
pub struct FormatArguments {
    /// What separates the cells of tables: comma, semicolon, tab or blanks
    /// [default: what their first lines show]
    #[arg(long, value_name = "NAME")]
    pub delimiter: Option<Delimiter>,
    /// What precedes the decimals of numbers in tables: point or comma
    /// [default: point]
    #[arg(long, value_name = "NAME")]
    pub decimal: Option<Decimal>,
    /// The columns of rays or points by their numbers, from 0, in the order in which
    /// the names are listed above: for a table without a header
    #[arg(long, value_name = "N,N", value_delimiter = ',')]
    pub columns: Vec<u64>,
}

impl FormatArguments {
    /// What is stated.
    pub fn format(&self) -> TableFormat {
        TableFormat {
            delimiter: self.delimiter,
            decimal: self.decimal.unwrap_or_default(),
        }
    }
}

/// Say what a scene holds, without tracing it
#[derive(Args, Debug)]
pub struct InfoArguments {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    #[command(flatten)]
    pub memory: MemoryArguments,
    #[command(flatten)]
    pub common: Common,
}

/// Write a scene as a mesh of triangles, with the proven deviation
#[derive(Args, Debug)]
pub struct TessellateArguments {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// The mesh: a name ending in .obj (text, with a group for each placed
    /// prototype) or .ply (binary, f64)
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Sides of a prism, and of what else is turned about an axis
    #[arg(
        long,
        value_name = "N",
        default_value_t = 64,
        value_parser = parse_segments,
        allow_negative_numbers = true
    )]
    pub segments: u32,
    /// Meshes with their corners on the surface, within the solids [default]
    #[arg(long, conflicts_with = "circumscribed")]
    pub inscribed: bool,
    /// Meshes whose sides touch the surface from without
    #[arg(long)]
    pub circumscribed: bool,
    /// Refuse to write more than SIZE bytes, such as 500MB or 4GiB
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = memory::parse_size)]
    pub max_memory: u64,
    #[command(flatten)]
    pub common: Common,
}

/// Put hard cases to every formulation and to exact arithmetic
///
/// Exits with 1 when a promise of the library's own solvers is broken.
#[derive(Args, Debug)]
pub struct StressArguments {
    /// Only this family; may be repeated [default: all]
    #[arg(long, value_name = "NAME")]
    pub family: Vec<StressFamily>,
    /// Cases of each family and kind of inputs; of set operations all up to 1000, then a
    /// hundredth
    #[arg(long, value_name = "N", default_value_t = 100_000, value_parser = clap::value_parser!(u64).range(1..=GREATEST_CASES))]
    pub cases: u64,
    /// Chooses the cases
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Only cases of f32 or of f64 numbers [default: both]
    #[arg(long, value_name = "KIND", value_parser = parse_inputs)]
    pub inputs: Option<Inputs>,
    /// Only this formulation of cylinders, in f32 and f64, or the solver of this
    /// kind of solid; may be repeated [default: all]
    #[arg(long, value_name = "NAME")]
    pub formulation: Vec<String>,
    /// Write the tables, the figures and maps into DIR
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Print what is promised and run nothing
    #[arg(long, conflicts_with_all = ["replay", "map"])]
    pub promises: bool,
    /// Print a case, as a run printed it, and what each formulation says
    #[arg(long, value_name = "BITS", conflicts_with = "map")]
    pub replay: Option<String>,
    /// Draw which formulations are right on neighbouring floats around the
    /// hardest case of a family
    #[arg(long, value_name = "FAMILY")]
    pub map: Option<Family>,
    #[command(flatten)]
    pub common: Common,
}

/// Hold analytic hits against meshes that Embree traces
///
/// Exits with 1 when an answer is wrong, or when the meshes say nothing about
/// more than half of a class of rays.
#[derive(Args, Debug)]
pub struct CheckArguments {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// Sides of the prisms; each number is checked with the same rays
    #[arg(long, value_name = "N,N", value_delimiter = ',', default_value = "16,64", value_parser = parse_segments, allow_negative_numbers = true)]
    pub segments: Vec<u32>,
    /// Rays of each class, or a table of rays as `trace` reads it, for --hits
    /// and --mesh
    #[arg(long, value_name = "N|FILE", default_value = "100000", value_parser = parse_rays)]
    pub rays: Rays,
    /// Compare these hits of another program for the table of rays: CSV with
    /// the columns hit and t, one row a ray
    #[arg(long, value_name = "FILE", conflicts_with = "mesh")]
    pub hits: Option<PathBuf>,
    #[command(flatten)]
    pub format: FormatArguments,
    /// What --hits may be off, relative to the distances of a ray [default:
    /// 16 / 2^24, which suits f32]
    #[arg(long, value_name = "X", value_parser = parse_length, requires = "hits")]
    pub tolerance: Option<f64>,
    /// Compare this mesh of the scene: .obj, .ply or .stl
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
    /// What --mesh may be off, in scene units [default: what the file's comment
    /// says]
    #[arg(long, value_name = "X", value_parser = parse_length, requires = "mesh")]
    pub deviation: Option<f64>,
    /// Only this class of rays: camera, sphere, inside, grazing or axial; may be
    /// repeated [default: all five]
    #[arg(long, value_name = "NAME")]
    pub class: Vec<Class>,
    /// Chooses the rays
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_seed, allow_negative_numbers = true)]
    pub seed: u64,
    /// What the meshes may take, such as 500MB or 4GiB
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = memory::parse_size)]
    pub max_memory: u64,
    /// Write a page with pictures, plots and the worst rays into DIR
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Check one ray again and tell everything about it: BITS as a run printed
    /// them, or CLASS:INDEX
    #[arg(long, value_name = "BITS", conflicts_with_all = ["hits", "mesh", "report"])]
    pub replay: Option<Replay>,
    #[command(flatten)]
    pub decisions: DecisionArguments,
    #[command(flatten)]
    pub common: Common,
}

/// Rays to make, or to read.
#[derive(Clone, Debug)]
pub enum Rays {
    /// So many of each class.
    Count(u64),
    /// Those of a table.
    Table(PathBuf),
}

/// The integrators by their names.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum IntegratorName {
    /// Sun and sky with shadows
    Sun,
    /// The visible part of an open sky
    Ao,
    /// The outward normal as a colour
    Normal,
}

impl From<IntegratorName> for Integrator {
    fn from(name: IntegratorName) -> Self {
        match name {
            IntegratorName::Sun => Self::Sun,
            IntegratorName::Ao => Self::Ao,
            IntegratorName::Normal => Self::Normal,
        }
    }
}

/// The name under which an integrator is reported.
pub fn integrator_name(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::Sun => "sun",
        Integrator::Ao => "ao",
        Integrator::Normal => "normal",
    }
}

/// A whole number is a count, the name of a file that is there a table.
fn parse_rays(text: &str) -> Result<Rays, String> {
    let count: Option<u64> = text.parse().ok();
    match count.filter(|count| (1..=GREATEST_RAYS).contains(count)) {
        Some(count) => Ok(Rays::Count(count)),
        None if text == "-" || Path::new(text).exists() => Ok(Rays::Table(text.into())),
        None => Err(String::from(
            "it is neither a whole number from 1 to 10^9 nor a file that is there",
        )),
    }
}

fn parse_inputs(text: &str) -> Result<Inputs, String> {
    let known = Inputs::ALL.into_iter().find(|inputs| inputs.name() == text);
    known.ok_or_else(|| "it must be f32 or f64".to_owned())
}
