//! The promises of the library's solvers on the families of hard cases, and
//! the command that shows them.
//!
//! `CYLTRACE_CASES=1000000 cargo test --release --test cli stress` is the full run.

use std::sync::atomic::AtomicBool;

use assert_cmd::Command;
use cyltrace_bench::formulations::Precision;
use cyltrace_bench::stress::{Cell, Contender, Promise, Settings, StressFamily, run, to_word};
use cyltrace_oracle::cases::{AnyFamily, ComposedFamily, Family, Inputs};
use serde_json::Value;

const SEED: u64 = 11;

fn cases() -> u64 {
    std::env::var("CYLTRACE_CASES").map_or(5_000, |count| count.parse().expect("a number"))
}

fn stressed(cases: u64, families: &[StressFamily], own: bool) -> Vec<Cell> {
    let contenders = Contender::all().into_iter();
    let settings = Settings {
        families: families.to_vec(),
        inputs: Inputs::ALL.to_vec(),
        contenders: contenders.filter(|one| !own || one.is_own()).collect(),
        cases,
        seed: SEED,
    };
    run(&settings, &|_| {}, &AtomicBool::new(false)).expect("nobody stopped it")
}

fn family(name: &str) -> StressFamily {
    name.parse().expect("a family")
}

/// The worst case of a cell for the command line.
fn worst(cell: &Cell) -> String {
    let index = cell.figures.worst.map_or(0, |worst| worst.index);
    to_word(cell.family, cell.inputs, SEED, index)
}

/// Checks every promise about the cells, and counts them.
fn count_kept(cells: &[Cell]) -> usize {
    let mut promised = 0;
    for cell in cells {
        for promise in Promise::about(cell) {
            promised += 1;
            let name = format!(
                "{} {} {}",
                cell.formulation,
                cell.inputs.name(),
                cell.family.name()
            );
            assert!(
                promise.is_kept(cell),
                "{name}: {}; seed {SEED}; cyltrace stress --replay {}",
                promise.claim,
                worst(cell)
            );
        }
    }
    promised
}

#[test]
fn promises_on_every_family_of_solids_are_kept() {
    let families: Vec<_> = AnyFamily::all().into_iter().map(Into::into).collect();
    let promised = count_kept(&stressed(cases(), &families, true));
    assert!(
        promised >= 21 * 8 + 63 * 7,
        "{promised} promises were checked"
    );
}

/// The oracle takes milliseconds about a case, so there are fewer.
#[test]
fn promises_on_every_family_of_set_operations_are_kept() {
    let families = ComposedFamily::ALL.map(StressFamily::from);
    let promised = count_kept(&stressed(cases() / 20, &families, true));
    assert_eq!(promised, 9 * (5 + 2), "promises were checked");
}

/// The judge is able to fail: the textbook form in f32 is caught everywhere
/// that it is known to be wrong.
#[test]
fn known_failures_of_the_textbook_form_are_found() {
    let families = [Family::Far, Family::Thin, Family::Tangent, Family::Cross];
    let families = families.map(|one| AnyFamily::Cylinder(one).into());
    let cells = stressed(1_000, &families, false);
    let textbook = cells.iter().filter(|cell| {
        cell.formulation == "center-dot"
            && cell.precision == Precision::F32
            && cell.inputs == Inputs::F32
    });
    for cell in textbook {
        let wrong = cell.figures.wrong_hit;
        assert!(wrong > 100, "{}: {wrong} of 1000 wrong", cell.family.name());
    }
}

#[test]
fn run_on_any_number_of_threads_gives_the_same_figures() {
    let families = ["rim", "tangent", "cone-rim", "composed-stacks"].map(family);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        let cells = pool.install(|| stressed(1_700, &families, false));
        let figures = cells.iter().map(|cell| {
            let figures = &cell.figures;
            let t = cell.t_ulps();
            let counts = [
                figures.cases,
                figures.wrong_hit,
                figures.wrong_part,
                figures.self_hits,
            ];
            let errors = [
                t.at(0.5),
                t.at(0.999),
                t.greatest(),
                figures.normal.at(0.99),
            ]
            .map(f64::to_bits);
            (counts, errors, figures.worst.map(|worst| worst.index))
        });
        figures.collect::<Vec<_>>()
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn command_writes_a_row_for_each_family_inputs_and_formulation() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = [
        "--cases",
        "300",
        "--formulation",
        "triple-product",
        "--json",
        "figures.json",
        "--quiet",
        "--report",
        "report",
    ];
    let command = || {
        let mut command = Command::cargo_bin("cyltrace").expect("the program");
        command.current_dir(folder.path()).arg("stress");
        command
    };
    command().args(arguments).assert().code(0).stdout("");
    let text = std::fs::read_to_string(folder.path().join("figures.json")).expect("figures");
    let figures: Value = serde_json::from_str(&text).expect("JSON");
    let rows = figures["families"].as_array().expect("rows");
    assert_eq!(rows.len(), Family::ALL.len() * 2 * 2);
    let keys = [
        "name",
        "inputs",
        "formulation",
        "cases",
        "wrong_hit",
        "wrong_part",
        "p999_t_ulp",
        "max_t_ulp",
        "self_hits",
        "promised",
        "kept",
    ];
    for row in rows {
        assert!(keys.iter().all(|key| !row[key].is_null()), "{row}");
        assert_eq!(row["promised"], row["precision"] == "f64", "{row}");
    }
    assert!(folder.path().join("report/stress.txt").exists());

    // The word of a row is replayed: the oracle and both precisions answer.
    let word = rows[0]["worst"].as_str().expect("a case");
    let replayed = command()
        .args(["--replay", word, "--formulation", "triple-product"])
        .assert()
        .code(0);
    let output = String::from_utf8(replayed.get_output().stdout.clone()).expect("text");
    assert!(
        output.contains("oracle") && output.matches("triple-product").count() == 2,
        "{output}"
    );

    for (arguments, message) in [
        (["--family", "knot"], "there is no family"),
        (
            ["--formulation", "guess"],
            "invalid value 'guess' for '--formulation <NAME>'",
        ),
        (["--replay", "1:2"], "16 parts"),
    ] {
        let failed = command().args(arguments).assert().code(2);
        let output = String::from_utf8_lossy(&failed.get_output().stderr).into_owned();
        assert!(output.contains(message), "{output}");
    }
}

#[test]
fn command_draws_a_map_of_a_family() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::cargo_bin("cyltrace").expect("the program");
    command.current_dir(folder.path()).args([
        "stress",
        "--map",
        "graze",
        "--formulation",
        "triple-product",
    ]);
    let done = command.assert().code(0);
    let output = String::from_utf8(done.get_output().stdout.clone()).expect("text");
    assert!(output.contains("triple-product f64"), "{output}");
    assert!(folder.path().join("ulp_map_graze_f32.png").exists());
}
