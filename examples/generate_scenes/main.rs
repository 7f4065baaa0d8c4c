//! Writes the tables of the sample scenes into `scenes/`, always the same
//! bytes: `cargo run --release --example generate_scenes`.
//!
//! With `--check` nothing is written; the exit code is 1 when a committed
//! table differs from what the generator makes.

mod tables;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let check = match std::env::args().nth(1).as_deref() {
        None => false,
        Some("--check") => true,
        Some(other) => {
            eprintln!("error: unknown argument \"{other}\"; the only one is --check");
            return ExitCode::from(2);
        }
    };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut differing = 0;
    for table in tables::all() {
        let path = folder.join(table.file);
        println!(
            "{}: {} rows, {} bytes",
            table.file,
            table.rows,
            table.text.len()
        );
        if check {
            if std::fs::read_to_string(&path).ok().as_deref() != Some(table.text.as_str()) {
                eprintln!("error: {} differs from the generator's", path.display());
                differing += 1;
            }
        } else if let Err(error) = std::fs::write(&path, &table.text) {
            eprintln!("error: cannot write {}: {error}", path.display());
            return ExitCode::from(2);
        }
    }
    if differing == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(1)
    }
}
