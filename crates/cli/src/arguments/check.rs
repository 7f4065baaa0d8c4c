//! The arguments of `cyltrace check`.

use std::path::{Path, PathBuf};

use clap::Args;
use cyltrace::scene::GREATEST_RAYS;
use cyltrace_check::{Class, Replay};

use super::numbers::{parse_length, parse_seed, parse_segments};
use super::{Common, DecisionArguments, FormatArguments, PartArguments};
use crate::memory;

/// `--columns`, which here concerns rays only.
const COLUMNS: &str = "Read a table of rays without a header: the numbers of its columns from 0, in the order `ox,oy,oz,dx,dy,dz,t_min,t_max` (six or eight numbers)";

/// Validate hits against meshes that Embree traces, or against exact results
///
/// Exits with 1 if an answer is wrong, or if the meshes leave more than half of a class of
/// rays without a bound.
#[derive(Args, Debug)]
#[command(
    mut_arg("columns", |arg| arg.help(COLUMNS)),
    mut_arg("resume", |arg| arg.requires("part")),
    mut_arg("part", |arg| arg.requires("output").conflicts_with_all(["hits", "mesh", "replay", "report"])),
)]
pub struct CheckArguments {
    /// The scene file
    #[arg(value_name = "SCENE")]
    pub scene: PathBuf,
    /// Bound round solids by meshes of N sides, 3 to 4096; each number is checked with the
    /// same rays
    #[arg(long, value_name = "N,N", value_delimiter = ',', default_value = "16,64", value_parser = parse_segments, allow_negative_numbers = true)]
    pub segments: Vec<u32>,
    /// Trace N random rays of each class, 1 to 10^9, or N in all with `--mesh`. `--hits`
    /// requires a table of rays in place of N, in the format of `trace`; `--mesh` also
    /// accepts one
    #[arg(long, value_name = "N|FILE", default_value = "100000", value_parser = parse_rays)]
    pub rays: Rays,
    /// Validate the hits of another program for `--rays FILE`: a table with one row per ray
    /// and the columns `hit` (`1`, `0`, `True` or `False`) and `t`
    #[arg(long, value_name = "FILE", conflicts_with = "mesh")]
    pub hits: Option<PathBuf>,
    #[command(flatten)]
    pub format: FormatArguments,
    /// Allow hits this error, relative to the distances along the ray [default: 16 / 2^24,
    /// which suits f32]
    #[arg(long, value_name = "X", value_parser = parse_length, requires = "hits")]
    pub tolerance: Option<f64>,
    /// Validate this mesh of the scene: `.obj`, `.ply` or `.stl`
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
    /// Allow the mesh this distance from the true surface, in scene units [default: the
    /// deviation that the file's comments state]
    #[arg(long, value_name = "X", value_parser = parse_length, requires = "mesh")]
    pub deviation: Option<f64>,
    /// Trace only this class of rays: `camera`, `sphere`, `inside`, `grazing` or `axial`;
    /// may be repeated [default: all five]
    #[arg(long, value_name = "NAME")]
    pub class: Vec<Class>,
    /// Seed the rays
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_seed, allow_negative_numbers = true)]
    pub seed: u64,
    /// Let the meshes take up to SIZE of memory, such as `500MB` or `4GiB`; a larger scene
    /// is checked in parts
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = memory::parse_size)]
    pub max_memory: u64,
    /// Write `index.html` to DIR: pictures, heat maps, convergence, the table and the worst
    /// rays
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Check one ray again and print its answer, bounds and exact hit. BITS is the word that
    /// a run printed beside a violation; `CLASS:INDEX` is ray INDEX of a class, with the
    /// same `--seed`, `--segments` and `--max-memory`
    #[arg(long, value_name = "BITS", conflicts_with_all = ["hits", "mesh", "report"])]
    pub replay: Option<Replay>,
    /// Write the part of `--part` to FILE
    #[arg(long, short, value_name = "FILE", requires = "part")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub part: PartArguments,
    #[command(flatten)]
    pub decisions: DecisionArguments,
    #[command(flatten)]
    pub common: Common,
}

/// The source of the rays.
#[derive(Clone, Debug)]
pub enum Rays {
    /// This number of random rays of each class.
    Count(u64),
    /// The rays of a table.
    Table(PathBuf),
}

/// Reads a number of rays, or the name of an existing file.
fn parse_rays(text: &str) -> Result<Rays, String> {
    let count: Option<u64> = text.parse().ok();
    match count.filter(|count| (1..=GREATEST_RAYS).contains(count)) {
        Some(count) => Ok(Rays::Count(count)),
        None if text == "-" || Path::new(text).exists() => Ok(Rays::Table(text.into())),
        None => Err(String::from(
            "it must be a whole number from 1 to 10^9 or the name of an existing file",
        )),
    }
}
