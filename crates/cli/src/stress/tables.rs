//! What a run prints.

use std::fmt::Write as _;

use cyltrace_bench::stress::{Cell, PROMISES, Promise, Settings, StressFamily, to_word};
use cyltrace_output::{Table, figure};

/// The table of promises.
pub fn promises() -> String {
    let mut table = Table::new(&["formulations", "inputs", "promise", "because"], 4);
    for promise in PROMISES {
        table.push(vec![
            promise.formulations.join(", "),
            promise.inputs.name().to_owned(),
            promise.claim.to_string(),
            promise.why.to_owned(),
        ]);
    }
    format!("{table}u = 2^-53; the bounds (3) to (6) are those of docs/derivations.md\n")
}

/// All tables of a run.
pub fn all(
    settings: &Settings,
    cells: &[Cell],
    broken: &[(&Cell, &Promise)],
    seconds: f64,
) -> String {
    let mut text = String::new();
    for &inputs in &settings.inputs {
        let of_inputs = || cells.iter().filter(move |cell| cell.inputs == inputs);
        let _ = writeln!(
            text,
            "inputs {}, {} cases per family, seed {}",
            inputs.name(),
            settings.cases,
            settings.seed
        );
        let _ = writeln!(text, "{}", errors(of_inputs()));
        if of_inputs().any(is_composed) {
            let _ = writeln!(text, "set operations, all crossings and points");
            let _ = writeln!(
                text,
                "{}",
                composed(of_inputs().filter(|one| is_composed(one)))
            );
        }
        let _ = writeln!(text, "worst cases, for --replay");
        let _ = writeln!(text, "{}", worst(of_inputs()));
    }
    for (cell, promise) in broken {
        let (name, inputs, family) = (cell.formulation, cell.inputs.name(), cell.family.name());
        let _ = writeln!(
            text,
            "BROKEN: {name}, {inputs} inputs, {family}: {}",
            promise.claim
        );
    }
    let promised: usize = cells.iter().map(|cell| Promise::about(cell).count()).sum();
    let kept = promised - broken.len();
    let _ = writeln!(text, "{kept} of {promised} promises kept, {seconds:.1} s");
    text
}

fn errors<'a>(cells: impl Iterator<Item = &'a Cell>) -> Table {
    let headings = [
        "family",
        "formulation",
        "in",
        "wrong hit %",
        "outside %",
        "wrong part %",
        "not finite",
        "t ulp 50%",
        "99%",
        "99.9%",
        "max",
        "position/r 99%",
        "normal rad 99%",
        "self-hits",
    ];
    let mut table = Table::new(&headings, 3);
    for cell in cells {
        let figures = &cell.figures;
        let percent = |count: u64| figure(100.0 * count as f64 / figures.cases as f64);
        let t = cell.t_ulps();
        let mut row: Vec<String> = vec![
            cell.family.name(),
            cell.formulation.to_owned(),
            cell.precision.name().to_owned(),
        ];
        row.extend(
            [
                figures.wrong_hit,
                figures.wrong_hit_outside,
                figures.wrong_part,
            ]
            .map(percent),
        );
        row.push(figures.non_finite.to_string());
        row.extend([t.at(0.5), t.at(0.99), t.at(0.999), t.greatest()].map(figure));
        row.extend([&figures.position, &figures.normal].map(|errors| figure(errors.at(0.99))));
        row.push(match figures.spawned {
            0 => String::from("-"),
            _ => figures.self_hits.to_string(),
        });
        table.push(row);
    }
    table
}

fn is_composed(cell: &Cell) -> bool {
    matches!(cell.family, StressFamily::Composed(_))
}

fn composed<'a>(cells: impl Iterator<Item = &'a Cell>) -> Table {
    let headings = [
        "family",
        "cases",
        "hit %",
        "wrong crossings %",
        "wrong points %",
    ];
    let mut table = Table::new(&headings, 1);
    for cell in cells {
        let figures = &cell.figures;
        let percent = |count: u64| figure(100.0 * count as f64 / figures.cases as f64);
        let shares = [figures.hits, figures.wrong_crossing, figures.wrong_point].map(percent);
        let named = [cell.family.name(), figures.cases.to_string()];
        table.push(named.into_iter().chain(shares).collect());
    }
    table
}

fn worst<'a>(cells: impl Iterator<Item = &'a Cell>) -> Table {
    let mut table = Table::new(&["family", "formulation", "in", "what", "case"], 5);
    for cell in cells {
        let Some(worst) = &cell.figures.worst else {
            continue;
        };
        let size = figure(worst.size);
        let what = match worst.class {
            3 => String::from("not finite"),
            2 => format!("wrong hit, gap {size}"),
            1 if is_composed(cell) => String::from("wrong part, crossing or point"),
            1 => format!("wrong part, gap {size}"),
            _ => format!("t off {size} ulp"),
        };
        table.push(vec![
            cell.family.name(),
            cell.formulation.to_owned(),
            cell.precision.name().to_owned(),
            what,
            worst_bits(cell).unwrap_or_default(),
        ]);
    }
    table
}

/// The worst case of a cell as a word for `--replay`.
pub fn worst_bits(cell: &Cell) -> Option<String> {
    let worst = cell.figures.worst.as_ref()?;
    Some(to_word(cell.family, cell.inputs, cell.seed, worst.index))
}
