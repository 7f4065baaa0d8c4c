//! The program `cyltrace`: arguments, progress bars, messages and exit codes.
//!
//! Exit codes: 0 good; 1 a check failed (commands that check); 2 the command
//! could not run; 128 and the signal's number when a signal ended it.

mod allocator;
mod arguments;
mod bench;
mod check;
mod ending;
mod hit_table;
mod info;
mod interrupt;
mod json;
mod limit;
mod memory;
mod outliers;
mod output_sink;
mod outputs;
mod print;
mod progress;
mod render;
mod scene;
mod stress;
mod tessellate;
mod text;
mod trace;

use std::process::ExitCode;

use clap::Parser;

use allocator::LimitedAllocator;
use arguments::{Arguments, Command};
use interrupt::Interrupted;
use print::{StandardOutputError, print, print_error};

/// Nothing is wrong.
const GOOD: u8 = 0;

/// A check failed.
const CHECK_FAILED: u8 = 1;

/// The command could not run.
const COULD_NOT_RUN: u8 = 2;

#[global_allocator]
static ALLOCATOR: LimitedAllocator = LimitedAllocator;

/// Runs the command that the program's arguments name.
fn main() -> ExitCode {
    match interrupt::install().and_then(|()| run_arguments()) {
        Ok(code) => ExitCode::from(code),
        Err(error) if error.is::<Interrupted>() => {
            print_error(&error);
            ExitCode::from(interrupt::exit_code())
        }
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            print_error(&format_args!("{error:#}"));
            ExitCode::from(COULD_NOT_RUN)
        }
    }
}

/// Runs the command that the program's arguments state.
fn run_arguments() -> anyhow::Result<u8> {
    arguments()?.map_or(Ok(GOOD), |arguments| run_command(&arguments))
}

/// The arguments; `None` when they asked for help or for the version, which
/// has been printed. Wrong ones end the program.
fn arguments() -> anyhow::Result<Option<Arguments>> {
    match Arguments::try_parse() {
        Ok(arguments) => Ok(Some(arguments)),
        Err(error) if error.use_stderr() => error.exit(),
        Err(help) => {
            let printed = help.print();
            printed.map_err(|error| StandardOutputError::of(&error))?;
            Ok(None)
        }
    }
}

/// Runs a command; the answer is the exit code of one that could run.
fn run_command(arguments: &Arguments) -> anyhow::Result<u8> {
    match &arguments.command {
        Command::Render(arguments) => render::run(arguments).map(|()| GOOD),
        Command::Trace(arguments) => trace::run(arguments).map(|()| GOOD),
        Command::Info(arguments) => info::run(arguments).map(|()| GOOD),
        Command::Tessellate(arguments) => tessellate::run(arguments).map(|()| GOOD),
        Command::Stress(arguments) => stress::run(arguments),
        Command::Bench(arguments) => bench::run(arguments),
        Command::Check(arguments) => check::run(arguments),
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
