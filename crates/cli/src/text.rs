//! Figures as lines for people.

use std::fmt::Write;

use cyltrace::scene::{Records, Scene};
use cyltrace::solid::SolidKind;
use cyltrace::tracer::Statistics;
use glam::DVec3;

/// Appends the shortest text that reads back as the same f64: decimal, or
/// scientific where that would need many zeros.
pub fn push_number(text: &mut String, value: f64) {
    let start = text.len();
    write!(text, "{value:?}").expect("a String takes any text");
    if text[start..].ends_with(".0") {
        text.truncate(text.len() - 2);
    }
}

/// Three numbers in their shortest form.
pub fn point(point: DVec3) -> String {
    let mut text = String::from("(");
    for (axis, value) in point.to_array().into_iter().enumerate() {
        text += if axis == 0 { "" } else { ", " };
        push_number(&mut text, value);
    }
    text + ")"
}

/// A factor to two digits.
pub fn rounded(factor: f64) -> String {
    match factor {
        0.1..1000.0 => format!("{factor:.1}"),
        _ => format!("{factor:.1e}"),
    }
}

/// A kind of solids in words.
pub fn plural(kind: SolidKind) -> String {
    kind.plural().replace('_', " ")
}

/// A line for each kind of solids of a traced scene.
pub fn solids(statistics: &Statistics) -> String {
    let instances = statistics.instances;
    let lines = statistics.unique.iter().map(|(kind, unique)| {
        let solids = plural(kind);
        match instances {
            0 => format!("{solids}: {unique}, no instances\n"),
            u128::MAX => format!(
                "{solids}: {unique} unique, instances: {}\n",
                count(instances)
            ),
            _ => format!(
                "{solids}: {unique} unique, {} with the {instances} instances\n",
                count(statistics.instanced[kind])
            ),
        }
    });
    lines.collect()
}

/// A line about rounded cylinders, or nothing where none is.
pub fn records(scene: &Scene) -> String {
    match scene.records() {
        Records::F64 => String::new(),
        Records::F32 => format!(
            "records: rounded to f32, by at most {:.1e} (2^-24 of each number)\n",
            scene.rounding()
        ),
    }
}

/// A line about rows that were left out, or nothing when there are none: the
/// one that [`Statistics::skipped`] has.
pub fn skipped_rows(rows: u64) -> String {
    match rows {
        0 => String::new(),
        _ => format!("skipped: degenerate rows of tables: {rows}\n"),
    }
}

/// A count, as far as solids are counted: up to 2^128 - 2.
pub fn count(count: u128) -> String {
    match count {
        u128::MAX => "more than can be counted".to_owned(),
        count => count.to_string(),
    }
}

/// A line for each note on the files of a scene.
pub fn notes<'n>(notes: impl IntoIterator<Item = &'n String>) -> String {
    let notes = notes.into_iter();
    notes.map(|note| format!("note: {note}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_written_reads_back_and_is_short() {
        for (value, text) in [
            (1.0, "1"),
            (-0.0, "-0"),
            (0.1, "0.1"),
            (1e-300, "1e-300"),
            (1e300, "1e300"),
            (-2.5e17, "-2.5e17"),
            (1.0 / 3.0, "0.3333333333333333"),
            (5e-324, "5e-324"),
        ] {
            let mut written = String::new();
            push_number(&mut written, value);
            assert_eq!(written, text);
            let back: f64 = written.parse().expect("a number");
            assert_eq!(back.to_bits(), value.to_bits());
        }
    }

    #[test]
    fn point_rounded_outward_from_zero_stays_short() {
        assert_eq!(point(DVec3::new(-5e-324, 1.0, 2.5)), "(-5e-324, 1, 2.5)");
    }
}
