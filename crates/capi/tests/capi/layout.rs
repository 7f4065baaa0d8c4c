//! That the header and Rust mean the same structures and constants.

use std::collections::BTreeMap;
use std::mem::{offset_of, size_of};
use std::process::Command;

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
        tells,
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
        CYLTRACE_OK,
        CYLTRACE_VIOLATIONS,
        CYLTRACE_ERROR,
        CYLTRACE_GREATEST_DEPTH,
        CYLTRACE_TELLS_NORMAL,
        CYLTRACE_TELLS_PLACE,
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
        CYLTRACE_SOLID_CYLINDER,
        CYLTRACE_SOLID_CONE,
        CYLTRACE_SOLID_ROUNDED_CONE,
        CYLTRACE_SOLID_SPHERE,
        CYLTRACE_SOLID_CUBOID,
        CYLTRACE_SOLID_DISK,
        CYLTRACE_SOLID_UNION,
        CYLTRACE_SOLID_INTERSECTION,
        CYLTRACE_SOLID_DIFFERENCE,
        CYLTRACE_ENTER,
        CYLTRACE_LEAVE,
        CYLTRACE_CAMERA,
        CYLTRACE_SPHERE,
        CYLTRACE_INSIDE,
        CYLTRACE_GRAZING,
        CYLTRACE_AXIAL
    );
    numbers
}

#[test]
fn structures_and_constants_of_the_header_are_those_of_rust() {
    let folder = tempfile::tempdir().expect("directory");
    let program = folder.path().join("layout");
    super::compile("tests/capi/layout.c", &program, &[]);
    let output = super::succeed(&mut Command::new(&program));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let in_c: BTreeMap<String, u64> = text
        .lines()
        .map(|line| line.split_once(' ').expect("a name and a number"))
        .map(|(name, number)| (name.to_owned(), number.parse().expect("a number")))
        .collect();
    assert_eq!(in_c, in_rust());
    // Nothing that the header defines is left out of the comparison.
    let header = include_str!("../../include/cyltrace.h");
    let defined = header
        .lines()
        .filter_map(|line| line.strip_prefix("#define ")?.split_once(' '));
    for (name, _) in defined {
        assert!(in_c.contains_key(name), "{name}");
    }
}
