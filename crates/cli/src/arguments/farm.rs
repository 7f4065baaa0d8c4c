//! The arguments of `cyltrace farm`.

use std::num::NonZeroU64;

use clap::{Args, Subcommand};

use super::numbers::count_up_to;

/// Most tasks of an array that Slurm allows, unless its administrator says otherwise.
const GREATEST_ARRAY: u64 = 1000;

/// Make the parts of a result on several machines
#[derive(Args, Debug)]
pub struct FarmArguments {
    #[command(subcommand)]
    pub farm: Farm,
}

#[derive(Debug, Subcommand)]
pub enum Farm {
    SlurmScript(SlurmScriptArguments),
}

/// Print a script that makes the parts as an array job of Slurm, and merges them
///
/// The command follows after `--`, as it would be run on one machine. Run the script with `sh`
/// on a machine that has `sbatch`; all machines must see the current folder. Run again, it
/// makes only the parts that are missing.
#[derive(Args, Debug)]
pub struct SlurmScriptArguments {
    /// Make N parts, 1 to 1000, each a task of the array
    #[arg(long, value_name = "N", value_parser = count_up_to::<NonZeroU64>(GREATEST_ARRAY))]
    pub parts: NonZeroU64,
    /// Pass an option on to `sbatch`, such as `--sbatch=--time=01:00:00`; may be repeated
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true)]
    pub sbatch: Vec<String>,
    /// Run this program on the machines
    #[arg(long, value_name = "PATH", default_value = "cyltrace")]
    pub program: String,
    /// The command: `render`, `trace` or `check` with its arguments and `-o FILE`
    #[arg(last = true, required = true, value_name = "COMMAND")]
    pub command: Vec<String>,
}
