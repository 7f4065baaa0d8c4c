//! Replays the inputs of `fuzz/corpus` through the fuzz targets, without libFuzzer: the
//! seeds, and whatever fuzzing found to be wrong once.
//!
//! `CYLTRACE_FUZZ_CASES=100000 cargo test --release --test cli fuzz_corpus` also tries that many
//! random inputs on the targets that draw what they do from any bytes.

#[path = "../../../../fuzz/src/lib.rs"]
mod targets;

use std::fs;
use std::panic;
use std::path::{Path, PathBuf};

use cyltrace::math::Random;
use targets::TARGETS;

const SEED: u64 = 77;

/// The inputs of a target, in the order of their names.
fn inputs(target: &str) -> Vec<PathBuf> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
        .join("fuzz/corpus")
        .join(target);
    let entries = fs::read_dir(&folder);
    let entries = entries.unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut inputs: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    inputs.sort();
    inputs
}

#[test]
fn every_input_of_the_corpus_is_right() {
    let mut wrong = Vec::new();
    for (name, target) in TARGETS {
        let inputs = inputs(name);
        assert!(!inputs.is_empty(), "{name} has no inputs");
        println!("{name}: {} inputs", inputs.len());
        for input in inputs {
            let bytes = fs::read(&input).unwrap();
            if panic::catch_unwind(|| target(&bytes)).is_err() {
                wrong.push(input);
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_target_has_its_file_and_every_file_its_target() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let mut files: Vec<String> = fs::read_dir(root.join("fuzz/targets"))
        .unwrap()
        .map(|entry| {
            entry
                .unwrap()
                .path()
                .file_stem()
                .unwrap()
                .to_str()
                .unwrap()
                .to_owned()
        })
        .collect();
    files.sort();
    let names: Vec<&str> = TARGETS.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, files);
    let manifest = fs::read_to_string(root.join("fuzz/Cargo.toml")).unwrap();
    for name in names {
        assert!(manifest.contains(&format!("name = \"{name}\"")), "{name}");
    }
}

#[test]
fn scenes_of_random_bytes_are_traced_rightly() {
    let cases = std::env::var("CYLTRACE_FUZZ_CASES");
    let cases: u64 = cases.map_or(300, |cases| cases.parse().expect("a number"));
    let wrong: Vec<u64> = (0..cases)
        .filter(|&case| {
            let mut random = Random::new(SEED, case);
            let length = 64 + random.below(2_000);
            let bytes: Vec<u8> = (0..length).map(|_| random.below(256) as u8).collect();
            panic::catch_unwind(|| targets::traced_scene(&bytes)).is_err()
        })
        .collect();
    assert!(wrong.is_empty(), "seed {SEED}, cases {wrong:?}");
}
