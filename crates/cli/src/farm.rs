//! `cyltrace farm`: scripts for engines that run jobs on many machines.

use std::path::Path;

use anyhow::{Context, anyhow, bail};
use clap::Parser;
use cyltrace_output::Format;

use super::arguments::{Arguments, Command, Farm, FarmArguments, SlurmScriptArguments};
use super::output_sink::is_standard_stream;
use super::print::print;

/// Prints a script.
pub fn run(arguments: &FarmArguments) -> anyhow::Result<()> {
    let Farm::SlurmScript(arguments) = &arguments.farm;
    print(&slurm_script(arguments)?)
}

/// A shell script that submits itself as an array job, and a job that merges.
fn slurm_script(arguments: &SlurmScriptArguments) -> anyhow::Result<String> {
    let Divided {
        command,
        output,
        has_threads,
    } = divided(&arguments.command)?;
    if let Some(array) = arguments.sbatch.iter().find(|option| is_array(option)) {
        bail!("--sbatch={array}: the script itself has the array, of --parts tasks");
    }
    let count = arguments.parts;
    // Parts of another number of parts would not fit together with these.
    let folder = format!("{output}.{count}.parts");
    let quoted = |words: &[&str]| shlex::try_join(words.iter().copied()).context("a zero byte");
    let (program, folder) = (quoted(&[&arguments.program])?, quoted(&[&folder])?);
    let command: Vec<&str> = command.iter().map(String::as_str).collect();
    let command = quoted(&command)?;
    let options: Vec<&str> = arguments.sbatch.iter().map(String::as_str).collect();
    let options = quoted(&options)?;
    let options = match options.as_str() {
        "" => String::new(),
        options => format!(" {options}"),
    };
    let output = quoted(&[&format!("--output={output}")])?;
    let whole = quoted(&[&format!("{program} merge {output} -- {folder}")])?;
    let threads = match has_threads {
        true => "",
        false => " ${SLURM_CPUS_PER_TASK:+--threads=$SLURM_CPUS_PER_TASK}",
    };
    Ok(format!(
        r#"#!/bin/sh
# {count} parts of a result as an array job of Slurm, and then the job that merges them.
# Run with sh. Run again, it makes only the parts that are missing or damaged.
set -eu
if [ -z "${{SLURM_ARRAY_TASK_ID:-}}" ]; then
    mkdir -p -- {folder}
    array=$(sbatch --parsable --job-name=cyltrace --requeue --array=1-{count}{options} "$0")
    sbatch --job-name=cyltrace-merge --dependency=afterok:"${{array%%;*}}" --kill-on-invalid-dep=yes{options} --wrap={whole}
    exit
fi
exec {program} {command} --part="$SLURM_ARRAY_TASK_ID/{count}" --resume{threads} \
    --output={folder}/"$SLURM_ARRAY_TASK_ID.cylpart"
"#
    ))
}

/// Whether an option of `sbatch` makes an array.
fn is_array(option: &str) -> bool {
    option.starts_with("-a") || option.starts_with("--array")
}

/// A command that can be divided into parts.
struct Divided {
    /// Its words without the output.
    command: Vec<String>,
    output: String,
    has_threads: bool,
}

/// Reads the command that follows `--`.
fn divided(command: &[String]) -> anyhow::Result<Divided> {
    let words = [&[String::from("cyltrace")], command, &["--part=1/1".into()]].concat();
    // The error of clap names the argument.
    let parsed = Arguments::try_parse_from(words)
        .map_err(|error| anyhow!("the command after `--` is wrong: {error}"))?;
    let (output, resume, common) = match &parsed.command {
        Command::Render(of) => (Some(&of.output), of.part.resume, &of.common),
        Command::Trace(of) => (Some(&of.output), of.part.resume, &of.common),
        Command::Check(of) => (of.output.as_ref(), of.part.resume, &of.common),
        _ => bail!("the command after `--` must be render, trace or check, with -o FILE"),
    };
    let output: &Path = output.context("the command after `--` needs -o FILE")?;
    match &parsed.command {
        Command::Render(_) => {
            Format::of(output)?;
        }
        Command::Trace(of) => {
            let tables = [&of.table.rays, &of.table.points];
            if tables
                .into_iter()
                .flatten()
                .any(|path| is_standard_stream(path))
            {
                bail!(
                    "the command after `--` must read its table from a file, not from standard input"
                );
            }
        }
        _ => {}
    }
    if is_standard_stream(output) || resume || common.json.is_some() {
        bail!("the command after `--` must write to a file, without --resume and --json");
    }
    let text = output
        .to_str()
        .context("the name of -o FILE is not UTF-8")?;
    let without = without_output(command, output)
        .context("write the output of the command after `--` as `-o FILE` or `--output=FILE`")?;
    Ok(Divided {
        command: without,
        output: text.to_owned(),
        has_threads: common.threads.is_some(),
    })
}

/// The command without `-o FILE`, in any of the ways to write it. `None` if it has another.
fn without_output(command: &[String], output: &Path) -> Option<Vec<String>> {
    let is_output = |text: &str| Path::new(text) == output;
    let mut rest = command.to_vec();
    for at in 0..rest.len() {
        let word = rest[at].clone();
        let value = word
            .strip_prefix("--output=")
            .or_else(|| word.strip_prefix("-o="));
        let value = value.or_else(|| word.strip_prefix("-o").filter(|value| !value.is_empty()));
        if value.is_some_and(is_output) {
            rest.remove(at);
            return Some(rest);
        }
        let next = rest.get(at + 1);
        if ["-o", "--output"].contains(&word.as_str()) && next.is_some_and(|next| is_output(next)) {
            rest.drain(at..=at + 1);
            return Some(rest);
        }
    }
    None
}
