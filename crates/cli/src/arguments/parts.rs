//! The arguments that split a command's work into parts, and those of `merge` and `parts`.

use std::num::{NonZeroU64, NonZeroUsize};
use std::path::PathBuf;

use clap::Args;
use cyltrace_parts::{GREATEST_PARTS, PartNumber};

use super::Common;
use super::numbers::{count_up_to, parse_threads};

/// Does a part of the work of a command.
#[derive(Args, Clone, Debug)]
pub struct PartArguments {
    /// Do only part K of N, from `1/N` to `N/N`, and write it to the output FILE for `cyltrace
    /// merge`. Parts may be made in any order, on any machine
    #[arg(long, value_name = "K/N")]
    pub part: Option<PartNumber>,
    /// Leave a part as it is if it is already there: whole, and of the same scene and settings
    #[arg(long)]
    pub resume: bool,
}

/// Shares a picture among processes of this machine.
#[derive(Args, Clone, Debug)]
pub struct WorkerArguments {
    /// Render in N processes that share nothing, 1 to 1024. If one dies, its part is rendered
    /// again. Threads and `--max-memory` are divided among them. Parts are in the folder
    /// FILE.parts until the picture is complete; with `--resume`, those that an earlier run
    /// left there are used
    #[arg(long, value_name = "N", value_parser = parse_threads, conflicts_with = "part")]
    pub workers: Option<NonZeroUsize>,
    /// Divide the picture into N parts for `--workers`, 1 to 10^6 [default: 8 for each worker]
    #[arg(long, value_name = "N", value_parser = count_up_to::<NonZeroU64>(GREATEST_PARTS), requires = "workers")]
    pub parts: Option<NonZeroU64>,
}

/// `--threads` and `--max-isa` of commands that do not trace.
const NO_EFFECT: &str = "Accepted as by other commands, without effect";

/// Put the parts of a result together
///
/// The output has the bytes that one process would have written without `--part`. Gaps,
/// overlaps, damaged parts and parts of another result are refused. For a check, the exit
/// code is 1 if an answer is wrong.
#[derive(Args, Debug)]
#[command(mut_arg("max_isa", |arg| arg.help(NO_EFFECT)), mut_arg("threads", |arg| arg.help(NO_EFFECT)))]
pub struct MergeArguments {
    /// The parts, in any order, or folders that contain only parts of the result
    #[arg(value_name = "PART", required = true)]
    pub parts: Vec<PathBuf>,
    /// Write the result to FILE: a picture (`.png` or `.exr`), a table (`-` is standard
    /// output), or the JSON of a check
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    #[command(flatten)]
    pub common: Common,
}

/// List the parts in a folder, and those that are missing
///
/// Exits with 1 if a part is missing or damaged.
#[derive(Args, Debug)]
#[command(mut_arg("max_isa", |arg| arg.help(NO_EFFECT)), mut_arg("threads", |arg| arg.help(NO_EFFECT)))]
pub struct PartsArguments {
    /// The folder
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    #[command(flatten)]
    pub common: Common,
}
