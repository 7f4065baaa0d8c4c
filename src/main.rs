//! The `cyltrace` program: see `cyltrace --help`.

mod cli;

use std::process::ExitCode;

#[global_allocator]
static ALLOCATOR: cli::LimitedAllocator = cli::LimitedAllocator;

fn main() -> ExitCode {
    cli::run()
}
