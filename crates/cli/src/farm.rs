//! `cyltrace farm`: scripts for engines that run jobs on many machines.

use std::path::Path;

use anyhow::{Context, bail};
use clap::Parser;

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
    let (command, output) = command_and_output(&arguments.command)?;
    let folder = format!("{output}.parts");
    let count = arguments.parts;
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
    let output = quoted(&[&output])?;
    let whole = quoted(&[&format!("{program} merge {folder} -o {output}")])?;
    Ok(format!(
        r#"#!/bin/sh
# The {count} parts of {output} as an array job of Slurm, and then the job that merges them.
# Run with sh. Run again, it makes only the parts that are missing or damaged.
set -eu
if [ -z "${{SLURM_ARRAY_TASK_ID:-}}" ]; then
    mkdir -p {folder}
    array=$(sbatch --parsable --job-name=cyltrace --requeue --array=1-{count}{options} "$0")
    sbatch --job-name=cyltrace-merge --dependency=afterok:"${{array%%;*}}" --kill-on-invalid-dep=yes{options} --wrap={whole}
    exit
fi
exec {program} {command} \
    --part "$SLURM_ARRAY_TASK_ID/{count}" --resume -o {folder}/"$SLURM_ARRAY_TASK_ID.cylpart" \
    ${{SLURM_CPUS_PER_TASK:+--threads=$SLURM_CPUS_PER_TASK}}
"#
    ))
}

/// The command without its output, and the output.
fn command_and_output(command: &[String]) -> anyhow::Result<(Vec<String>, String)> {
    let words = [&[String::from("cyltrace")], command, &["--part=1/1".into()]].concat();
    // The error of clap names the argument.
    let parsed = Arguments::try_parse_from(words)
        .map_err(|error| anyhow::anyhow!("the command after `--` is wrong: {error}"))?;
    let (output, is_resumed) = match &parsed.command {
        Command::Render(arguments) => (Some(&arguments.output), arguments.part.resume),
        Command::Trace(arguments) => (Some(&arguments.output), arguments.part.resume),
        Command::Check(arguments) => (arguments.output.as_ref(), arguments.part.resume),
        _ => bail!("the command after `--` must be render, trace or check, with -o FILE"),
    };
    let output: &Path = output.context("the command after `--` needs -o FILE")?;
    if is_standard_stream(output) || is_resumed {
        bail!("the command after `--` must write to a file, and is without --resume");
    }
    let text = output
        .to_str()
        .context("the name of -o FILE is not UTF-8")?;
    let without = without_output(command, output)
        .context("write the output of the command after `--` as `-o FILE` or `--output=FILE`")?;
    Ok((without, text.to_owned()))
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
