//! `docs/accuracy.md` describes every family of hard cases.

use std::collections::BTreeSet;

use cyltrace_bench::stress::StressFamily;

const DOCUMENT: &str = include_str!("../../../../docs/accuracy.md");

#[test]
fn document_describes_every_family() {
    let (_, section) = DOCUMENT.split_once("\n## Families\n").expect("a section");
    let (section, _) = section.split_once("\n## ").expect("a section after it");
    let mut described = BTreeSet::new();
    for table in section.split("\n\n").filter(|text| text.starts_with('|')) {
        let mut rows = table.lines();
        // A heading has the first part of names, or none: that of cylinders.
        let parts = words(rows.next().expect("a heading"));
        let parts = if parts.is_empty() { vec![""] } else { parts };
        for name in rows.flat_map(words) {
            described.extend(parts.iter().map(|part| format!("{part}{name}")));
        }
    }
    let families = StressFamily::all().into_iter().map(StressFamily::name);
    assert_eq!(described, families.collect());
}

/// The words in backticks in the first cell of a row.
fn words(row: &str) -> Vec<&str> {
    let cell = row.split('|').nth(1).unwrap_or_default();
    cell.split('`').skip(1).step_by(2).collect()
}
