//! The rules of the repository that the compiler does not check: who may use
//! whom, where `unsafe` and standard output are allowed, how long a file is.
//!
//! Every rule is a function from a file's name and text to complaints. It is
//! run over the whole repository, and over a planted sample that breaks it.

mod circles;
mod documents;
mod layers;
mod tokens;

use std::fs;
use std::path::{Path, PathBuf};

use layers::layers;
use tokens::tokens;

/// Lines that no file may exceed.
const LONGEST_FILE: usize = 600;

/// Functions whose last bit differs between platforms, in std or, for the
/// last row, in glam. `libm` has the same bits everywhere.
const INEXACT: &[&str] = &[
    "sin",
    "cos",
    "tan",
    "sin_cos",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sinh",
    "cosh",
    "tanh",
    "asinh",
    "acosh",
    "atanh",
    "exp",
    "exp2",
    "exp_m1",
    "ln",
    "ln_1p",
    "log",
    "log2",
    "log10",
    "powf",
    "powi",
    "cbrt",
    "hypot",
    "mul_add", //
    "from_axis_angle",
    "from_rotation_x",
    "from_rotation_y",
    "from_rotation_z",
    "from_euler",
    "from_scaled_axis",
    "from_angle",
    "to_axis_angle",
    "to_euler",
    "angle_between",
    "slerp",
];

/// Uses of [`INEXACT`] that are right: file, function, reason.
const INEXACT_ALLOWED: &[(&str, &str, &str)] = &[(
    "src/math/rounding.rs",
    "powi",
    "a test compares with powers of two, which are exact however they are multiplied",
)];

type Rule = fn(file: &str, source: &str) -> Vec<String>;

#[test]
fn layers_in_repository_use_only_layers_above() {
    hold("src", layers);
    hold("crates/check/src", layers);
}

#[test]
fn layers_planted_uses_are_found() {
    bites(layers, "src/math/ray.rs", "use crate::solid::Cylinder;");
    bites(layers, "src/math/mod.rs", "use super::solid::Cylinder;");
    bites(
        layers,
        "src/math/ray.rs",
        "fn f() { super::super::tracer::run() }",
    );
    bites(
        layers,
        "src/scene/load.rs",
        "use crate::{math::Ray, tracer};",
    );
    bites(
        layers,
        "src/scene/load.rs",
        "use {crate::math::Ray, crate::tracer::Hit};",
    );
    bites(layers, "src/embree/mod.rs", "use crate::solid::Cylinder;");
    bites(layers, "src/meshes/mod.rs", "use crate::tracer::Tracer;");
    bites(layers, "src/solid/mod.rs", "use crate as everything;");
    bites(layers, "src/solid/mod.rs", "use crate::*;");
    bites(layers, "src/unknown/mod.rs", "");
    bites(
        layers,
        "crates/check/src/bounding_meshes/meshes.rs",
        "use crate::verdict::sandwich::SolidBounds;",
    );
    bites(
        layers,
        "crates/check/src/verdict/truth.rs",
        "use crate::report::words::truth_text;",
    );
    bites(layers, "crates/check/src/tally.rs", "use super::run::plan;");
    spares(
        layers,
        "src/tracer/mod.rs",
        "use crate::{embree::Device, math::Ray, scene};",
    );
    spares(
        layers,
        "crates/check/src/run/compare.rs",
        "use crate::report::words;\nuse cyltrace::tracer::Tracer;",
    );
    spares(
        layers,
        "src/math/ray.rs",
        "/// See [`crate::tracer`].\npub(crate) fn f() {}",
    );
    spares(
        layers,
        "src/scene/load.rs",
        "use super::tracer_names;\nuse super::math;",
    );
}

#[test]
fn unsafe_in_repository_stands_in_its_layers() {
    hold_in_sources(unsafe_places);
}

#[test]
fn unsafe_planted_elsewhere_is_found() {
    bites(unsafe_places, "src/tracer/mod.rs", "unsafe fn f() {}");
    spares(unsafe_places, "src/embree/mod.rs", "unsafe fn f() {}");
    spares(
        unsafe_places,
        "src/tracer/mod.rs",
        "// unsafe\nconst A: &str = \"unsafe\";",
    );
}

#[test]
fn standard_output_in_repository_is_of_the_program() {
    hold_in_sources(standard_output);
}

#[test]
fn standard_output_planted_elsewhere_is_found() {
    bites(
        standard_output,
        "src/scene/mod.rs",
        "fn f() { println!(\"loaded\"); }",
    );
    bites(
        standard_output,
        "src/lib.rs",
        "fn f() { std::print!(\"loaded\"); }",
    );
    spares(
        standard_output,
        "crates/cli/src/main.rs",
        "fn main() { println!(\"done\"); }",
    );
}

#[test]
fn functions_in_repository_give_the_same_bits_everywhere() {
    hold_in_sources(functions);
}

#[test]
fn functions_planted_from_std_are_found() {
    bites(functions, "src/solid/side.rs", "let y = x.sin();");
    bites(functions, "src/solid/side.rs", "let y = f64::atan2(x, z);");
    bites(functions, "src/solid/side.rs", "let y = a.mul_add(b, c);");
    bites(
        functions,
        "src/solid/side.rs",
        "let y = angles.map(f64::cos);",
    );
    bites(
        functions,
        "src/scene/place.rs",
        "DQuat::from_axis_angle(a, b)",
    );
    spares(
        functions,
        "src/solid/side.rs",
        "let y = libm::sin(x).sqrt().abs();",
    );
    spares(
        functions,
        "src/solid/side.rs",
        "let (sin, cos) = libm::sincos(x);",
    );
}

#[test]
fn files_in_repository_open_with_prose_and_are_short() {
    for folder in ["src", "crates", "tests", "examples", "build.rs"] {
        hold(folder, opening);
        hold(folder, length);
    }
}

#[test]
fn files_planted_bare_or_long_are_found() {
    bites(opening, "src/math/ray.rs", "use glam::DVec3;\n//! Rays.\n");
    bites(opening, "src/math/ray.rs", "");
    spares(opening, "src/math/ray.rs", "//! Rays.\n");
    bites(length, "src/math/ray.rs", &"//\n".repeat(LONGEST_FILE + 1));
    spares(length, "src/math/ray.rs", &"//\n".repeat(LONGEST_FILE));
}

fn unsafe_places(file: &str, source: &str) -> Vec<String> {
    let places = [
        "src/embree/",
        "crates/capi/src/",
        "crates/cli/src/allocator.rs",
        "crates/denoise/src/library.rs",
    ];
    if places.iter().any(|place| file.starts_with(place)) {
        return Vec::new();
    }
    tokens(source)
        .iter()
        .filter(|token| token.text == "unsafe")
        .map(|token| {
            let line = token.line;
            format!("{file}:{line}: unsafe outside embree, capi, denoise and the allocator")
        })
        .collect()
}

/// Standard output belongs to the program.
fn standard_output(file: &str, source: &str) -> Vec<String> {
    let in_program = file.starts_with("crates/cli/");
    let tokens = tokens(source);
    let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    let mut complaints = Vec::new();
    for (index, token) in tokens.iter().enumerate() {
        let after = text(index + 1);
        let stray = match token.text.as_str() {
            "println" | "print" | "dbg" => after == "!" && !in_program,
            _ => false,
        };
        if stray {
            let line = token.line;
            complaints.push(format!(
                "{file}:{line}: {} does not belong here",
                token.text
            ));
        }
    }
    complaints
}

fn functions(file: &str, source: &str) -> Vec<String> {
    let tokens = tokens(source);
    let mut complaints = Vec::new();
    for window in tokens.windows(3) {
        let [owner, separator, name] = window else {
            continue;
        };
        let from_libm = separator.text == "::" && owner.text == "libm";
        let is_path = separator.text == "::" && !from_libm;
        let is_allowed = INEXACT_ALLOWED
            .iter()
            .any(|&(where_, what, _)| where_ == file && what == name.text);
        if (separator.text == "." || is_path)
            && INEXACT.contains(&name.text.as_str())
            && !is_allowed
        {
            let (line, name) = (name.line, &name.text);
            complaints.push(format!("{file}:{line}: {name} differs between platforms"));
        }
    }
    complaints
}

fn opening(file: &str, source: &str) -> Vec<String> {
    match source.starts_with("//! ") {
        true => Vec::new(),
        false => vec![format!("{file}: does not open with //! prose")],
    }
}

fn length(file: &str, source: &str) -> Vec<String> {
    let lines = source.lines().count();
    match lines <= LONGEST_FILE {
        true => Vec::new(),
        false => vec![format!("{file}: {lines} lines, at most {LONGEST_FILE}")],
    }
}

/// The folders of sources of the library and of the other crates.
fn members() -> Vec<String> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates");
    let members = fs::read_dir(crates).expect("the folder of the other crates");
    let names = members.map(|member| member.expect("a crate").file_name());
    let others = names.map(|name| format!("crates/{}/src", name.to_string_lossy()));
    std::iter::once("src".into()).chain(others).collect()
}

/// Applies a rule to the sources of the library and of the other crates.
fn hold_in_sources(rule: Rule) {
    for folder in members() {
        hold(&folder, rule);
    }
}

/// Applies a rule to every Rust file of a folder (or to one file).
fn hold(start: &str, rule: Rule) {
    let complaints = sources(start).into_iter();
    let complaints: Vec<String> = complaints
        .flat_map(|(name, source)| rule(&name, &source))
        .collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

/// The names and texts of all Rust files of a folder (or of one file).
fn sources(start: &str) -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    let mut open = vec![root.join(start)];
    while let Some(path) = open.pop() {
        if path.is_dir() {
            let entries = fs::read_dir(&path).expect("a folder of the repository can be read");
            open.extend(entries.map(|entry| entry.expect("its entries too").path()));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let source = fs::read_to_string(&path).expect("a Rust file is UTF-8");
            found.push((name(root, &path), source));
        }
    }
    assert!(!found.is_empty(), "no Rust file under {start}");
    found
}

/// The path from the repository's root, with forward slashes.
fn name(root: &Path, path: &Path) -> String {
    let relative: PathBuf = path.strip_prefix(root).unwrap_or(path).to_owned();
    relative.to_string_lossy().replace('\\', "/")
}

fn bites(rule: Rule, file: &str, source: &str) {
    let complaints = rule(file, source);
    assert!(!complaints.is_empty(), "not found in {file}: {source}");
}

fn spares(rule: Rule, file: &str, source: &str) {
    let complaints = rule(file, source);
    assert!(complaints.is_empty(), "wrongly found: {complaints:?}");
}
