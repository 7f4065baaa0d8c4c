//! The bindings for documentation have what the generated ones have.

use std::collections::BTreeSet;

/// The names of functions and constants; those of structures depend on Embree's version.
fn names(bindings: &str) -> BTreeSet<&str> {
    bindings
        .lines()
        .filter_map(|line| {
            let line = line.trim_start();
            let rest = line
                .strip_prefix("pub fn ")
                .or_else(|| line.strip_prefix("pub const "))?;
            rest.split(['(', ':']).next()
        })
        .collect()
}

#[test]
fn bindings_for_documentation_have_every_function_and_constant() {
    let generated = names(include_str!(concat!(env!("OUT_DIR"), "/embree.rs")));
    let documented = names(include_str!("../../build/docs_rs.rs"));
    assert!(generated.len() > 60, "{}", generated.len());
    assert_eq!(documented, generated);
}
