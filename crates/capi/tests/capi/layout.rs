//! That the header and Rust mean the same structures and constants.

use std::collections::BTreeMap;
use std::mem::{offset_of, size_of};
use std::process::Command;

use cyltrace::solid::SolidKind;
use cyltrace_c::*;

/// `name` and its fields by their offsets in a Rust type.
macro_rules! layout {
    ($numbers:ident, $name:literal, $type:ident, $($field:ident),*) => {
        $numbers.insert($name.to_owned(), size_of::<$type>() as u64);
        $($numbers.insert(
            format!("{}.{}", $name, stringify!($field)),
            offset_of!($type, $field) as u64,
        );)*
    };
}

/// Constants by their names.
macro_rules! constants {
    ($numbers:ident, $($name:ident),*) => {
        $($numbers.insert(stringify!($name).to_owned(), $name as u64);)*
    };
}

fn in_rust() -> BTreeMap<String, u64> {
    let mut numbers = BTreeMap::new();
    layout!(
        numbers,
        "cyltrace_layout",
        CyltraceLayout,
        size,
        version,
        ray,
        hit,
        check_settings,
        check_outcome
    );
    layout!(
        numbers,
        "cyltrace_ray",
        CyltraceRay,
        origin,
        direction,
        t_min,
        t_max
    );
    layout!(
        numbers,
        "cyltrace_hit",
        CyltraceHit,
        t,
        point,
        normal,
        error,
        u,
        v,
        is_hit,
        valid_fields,
        prototype,
        primitive,
        part,
        crossing,
        material,
        instance_count,
        instance,
        solid
    );
    layout!(
        numbers,
        "cyltrace_check_settings",
        CyltraceCheckSettings,
        rays,
        seed,
        max_memory,
        most_listed,
        segments,
        segment_count,
        classes,
        threads
    );
    layout!(
        numbers,
        "cyltrace_check_outcome",
        CyltraceCheckOutcome,
        rays,
        violations,
        unwitnessed_rows,
        text,
        json
    );
    constants!(
        numbers,
        CYLTRACE_VERSION,
        CYLTRACE_OK,
        CYLTRACE_VIOLATIONS,
        CYLTRACE_ERROR,
        CYLTRACE_GREATEST_DEPTH,
        CYLTRACE_VALID_NORMAL,
        CYLTRACE_VALID_PLACE,
        CYLTRACE_FIELD_POINT,
        CYLTRACE_FIELD_NORMAL,
        CYLTRACE_FIELD_UV,
        CYLTRACE_FIELD_ERROR,
        CYLTRACE_FIELD_PATH,
        CYLTRACE_FIELD_ALL,
        CYLTRACE_SIDE,
        CYLTRACE_CAP0,
        CYLTRACE_CAP1,
        CYLTRACE_X_MIN,
        CYLTRACE_X_MAX,
        CYLTRACE_Y_MIN,
        CYLTRACE_Y_MAX,
        CYLTRACE_Z_MIN,
        CYLTRACE_Z_MAX,
        CYLTRACE_ENTER,
        CYLTRACE_LEAVE,
        CYLTRACE_CAMERA,
        CYLTRACE_SPHERE,
        CYLTRACE_INSIDE,
        CYLTRACE_GRAZING,
        CYLTRACE_AXIAL
    );
    // From the registry of kinds, so that a new kind is missing in the header.
    for kind in SolidKind::all() {
        let name = format!("CYLTRACE_SOLID_{}", kind.name().to_uppercase());
        numbers.insert(name, kind.code().into());
    }
    numbers
}

/// A C program that prints the names with the numbers that the C compiler gives them, which
/// are offsets of fields (`structure.field`), sizes of structures and constants.
fn program(names: impl Iterator<Item = String>) -> String {
    let lines = names.map(|name| {
        let value = match name.split_once('.') {
            Some((structure, field)) => format!("offsetof(struct {structure}, {field})"),
            None if name.starts_with("CYLTRACE_") => name.clone(),
            None => format!("sizeof(struct {name})"),
        };
        format!("    printf(\"{name} %lu\\n\", (unsigned long)({value}));\n")
    });
    let lines: String = lines.collect();
    format!(
        "#include <stdio.h>\n#include \"cyltrace.h\"\nint main(void) {{\n{lines}    return 0;\n}}\n"
    )
}

#[test]
fn structures_and_constants_of_the_header_are_those_of_rust() {
    let in_rust = in_rust();
    let folder = tempfile::tempdir().expect("directory");
    let (source, binary) = (folder.path().join("layout.c"), folder.path().join("layout"));
    std::fs::write(&source, program(in_rust.keys().cloned())).expect("written");
    super::compile(source.to_str().expect("UTF-8"), &binary, &[]);
    let output = super::succeed(&mut Command::new(&binary));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let in_c: BTreeMap<String, u64> = text
        .lines()
        .map(|line| line.split_once(' ').expect("a name and a number"))
        .map(|(name, number)| (name.to_owned(), number.parse().expect("a number")))
        .collect();
    assert_eq!(in_c, in_rust);
}

/// Nothing that the header defines is left out of the comparison.
#[test]
fn rust_has_every_structure_and_constant_of_the_header() {
    let in_rust = in_rust();
    let header = include_str!("../../include/cyltrace.h");
    let constant = |line: &str| Some(line.strip_prefix("#define ")?.split_once(' ')?.0.to_owned());
    let structure = |line: &str| Some(line.strip_prefix("struct ")?.strip_suffix(" {")?.to_owned());
    let names: Vec<String> = header
        .lines()
        .filter_map(|line| constant(line).or_else(|| structure(line)))
        .collect();
    assert!(names.len() > 40, "{names:?}");
    for name in names {
        assert!(in_rust.contains_key(&name), "{name}");
    }
}
