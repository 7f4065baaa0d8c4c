//! The program `cyltrace`: arguments, progress bars, messages and exit codes.
//!
//! [`exit_codes`] lists the exit codes.

mod allocator;
mod arguments;
mod bench;
mod check;
mod ending;
mod exit_codes;
mod farm;
mod hit_table;
mod info;
mod interrupt;
mod json;
mod limit;
mod manual;
mod memory;
mod number_rows;
mod outliers;
mod output_sink;
mod outputs;
mod parts;
mod print;
mod progress;
mod reached;
#[cfg(test)]
mod reference;
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
use exit_codes::{CHECK_FAILED, COULD_NOT_RUN, GOOD};
use interrupt::Interrupted;
use print::{StandardOutputError, print, print_error};

#[global_allocator]
static ALLOCATOR: LimitedAllocator = LimitedAllocator;

/// Runs the command and turns errors into messages and exit codes.
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

/// Parses the arguments and runs the command.
fn run_arguments() -> anyhow::Result<u8> {
    arguments()?.map_or(Ok(GOOD), |arguments| run_command(&arguments))
}

/// The arguments; `None` after printing the help or the version. Wrong arguments end the
/// program.
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

/// Runs a command and returns its exit code.
fn run_command(arguments: &Arguments) -> anyhow::Result<u8> {
    match &arguments.command {
        Command::Render(arguments) => render::run(arguments).map(|()| GOOD),
        Command::Trace(arguments) => trace::run(arguments).map(|()| GOOD),
        Command::Info(arguments) => info::run(arguments).map(|()| GOOD),
        Command::Tessellate(arguments) => tessellate::run(arguments).map(|()| GOOD),
        Command::Stress(arguments) => stress::run(arguments),
        Command::Bench(arguments) => bench::run(arguments),
        Command::Check(arguments) => check::run(arguments),
        Command::Merge(arguments) => parts::merge::run(arguments),
        Command::Parts(arguments) => parts::list::run(arguments),
        Command::Farm(arguments) => farm::run(arguments).map(|()| GOOD),
        Command::Completions(arguments) => manual::completions(arguments).map(|()| GOOD),
        Command::Man(arguments) => manual::man(arguments).map(|()| GOOD),
    }
}

/// Whether the reader of a pipe has closed it, as in `cyltrace trace ... | head`.
fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        cause
            .downcast_ref::<std::io::Error>()
            .is_some_and(|error| error.kind() == std::io::ErrorKind::BrokenPipe)
    })
}
