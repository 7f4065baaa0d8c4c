//! `--part`, `merge`, `parts`, workers, scripts and checkpoints: the bytes of one process, whatever happens
//! to the parts.

mod checkpoint;
mod damage;
mod same_bytes;
mod slurm;
mod workers;

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::program::{cyltrace, folder_of, words};

/// Cylinders in a table, placed twice, and a sphere.
const SCENE: &str = r#"
[film]
width = 75
height = 50

[[sphere]]
center = [0, 0, 0]
radius = 0.7

[[instance]]
of = "twigs"
translate = [-1, 0, 0]
[[instance]]
of = "twigs"
translate = [1, 0.2, 0]
scale = 0.6

[[prototype]]
name = "twigs"
[[prototype.cylinder_table]]
file = "twigs.csv"
columns = { p0 = ["x0", "y0", "z0"], p1 = ["x1", "y1", "z1"], radius = "r" }
"#;

const TWIGS: &str = "\
x0,y0,z0,x1,y1,z1,r
0,0,-1,0,0,1,0.2
0,0,0,1,1,0.5,0.1
-1,0,0,1,0.5,0.2,0.05
0,-1,0,0,1,1,0.1
";

fn scene() -> TempDir {
    folder_of(&[("scene.toml", SCENE), ("twigs.csv", TWIGS)])
}

/// Runs a command line that succeeds.
fn run(folder: &Path, line: &str) -> String {
    let (code, output, error) = cyltrace(folder, &words(line));
    assert_eq!(code, 0, "{line}: {output}{error}");
    output
}

/// The error message of a command line that fails.
fn refused(folder: &Path, line: &str) -> String {
    let (code, output, error) = cyltrace(folder, &words(line));
    assert_eq!(code, 2, "{line}: {output}{error}");
    error
}

/// Runs a command line in `count` parts, each in a file of the folder `parts`.
fn make_parts(folder: &Path, line: &str, count: u64) {
    fs::create_dir_all(folder.join("parts")).expect("created");
    for number in 1..=count {
        run(
            folder,
            &format!("{line} --part {number}/{count} -o parts/{number} -q"),
        );
    }
}

fn bytes(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).expect("a file")
}

/// The number of files that processes are writing in a folder.
fn unfinished(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).expect("readable");
    let names = entries.map(|entry| entry.expect("entry").file_name());
    names
        .filter(|name| name.to_string_lossy().starts_with(".cyltrace-"))
        .count()
}
