//! The `cyltrace` program: see `cyltrace --help`.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
