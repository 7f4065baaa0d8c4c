//! `cyltrace bench`, as users run it. Nothing here depends on how long anything
//! takes.

mod accuracy;
use crate::program;
mod image;
mod scale;
mod traversal;

use std::fs;
use std::path::Path;

use serde_json::Value;

fn bench(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    program::cyltrace(folder, &[&["bench"], arguments].concat())
}

/// The figures that a run writes to standard output.
fn figures(folder: &Path, arguments: &[&str]) -> Value {
    let (code, out, err) = bench(folder, &[arguments, &["--json", "-"]].concat());
    assert_eq!(code, 0, "{err}");
    serde_json::from_str(&out).expect("nothing but JSON")
}

/// Has a report written; answers with what the run prints and the report's
/// files, sorted. The page has to stand by itself.
fn report(folder: &Path, arguments: &[&str]) -> (String, Vec<String>) {
    let (code, out, err) = bench(folder, &[arguments, &["--report", "new/report"]].concat());
    assert_eq!(code, 0, "{err}");
    let directory = folder.join("new/report");
    let entries = fs::read_dir(&directory).expect("the directory is made");
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let page = fs::read_to_string(directory.join("index.html")).unwrap();
    for foreign in ["src=", "href=", "@import", "url(", "<script"] {
        assert!(!page.contains(foreign), "the page has {foreign}");
    }
    (out, names)
}

fn keys(value: &Value) -> Vec<&str> {
    let object = value.as_object().expect("an object");
    object.keys().map(String::as_str).collect()
}
