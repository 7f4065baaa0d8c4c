//! The command line: arguments, progress bars, messages and exit codes.
//!
//! Exit codes: 0 good; 1 a check failed (commands that check); 2 the command
//! could not run; 130 it was interrupted.

mod arguments;
mod bench;
mod hit_table;
mod info;
mod interrupt;
mod json;
mod memory;
mod progress;
mod ray_table;
mod render;
mod scene;
mod stress;
mod target;
mod trace;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};
use interrupt::Interrupted;

/// Nothing is wrong.
const GOOD: u8 = 0;

/// A check failed.
const CHECK_FAILED: u8 = 1;

/// The command could not run.
const COULD_NOT_RUN: u8 = 2;

/// What shells report for a program that Ctrl-C ended.
const INTERRUPTED: u8 = 130;

/// Runs the command that the program's arguments name.
pub fn run() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match &arguments.command {
        Command::Render(arguments) => render::run(arguments).map(|()| GOOD),
        Command::Trace(arguments) => trace::run(arguments).map(|()| GOOD),
        Command::Info(arguments) => info::run(arguments).map(|()| GOOD),
        Command::Bench(arguments) => bench::run(arguments).map(|()| GOOD),
        Command::Stress(arguments) => stress::run(arguments),
    };
    match result {
        Ok(code) => ExitCode::from(code),
        Err(error) if error.is::<Interrupted>() => {
            eprintln!("error: {error}");
            ExitCode::from(INTERRUPTED)
        }
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}

/// Whether the reader of a pipe had enough, as in `cyltrace trace ... | head`.
fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        cause
            .downcast_ref::<std::io::Error>()
            .is_some_and(|error| error.kind() == std::io::ErrorKind::BrokenPipe)
    })
}
