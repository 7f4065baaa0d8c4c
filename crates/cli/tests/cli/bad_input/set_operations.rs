//! Set operations that are wrong.

use super::Case;

const BALL: &str = "{ sphere = { center = [0, 0, 0], radius = 1 } }";

/// A difference of a ball and `operand`, which stands on the third line.
fn minus(name: &'static str, operand: &str, message: &'static [&'static str]) -> Case {
    Case::new(
        name,
        format!("[[difference]]\nof = [{BALL},\n{operand}]\n"),
        message,
    )
}

pub fn cases() -> Vec<Case> {
    vec![
        Case::new(
            "operation_without_operands",
            "[[union]]\nof = []\n",
            &["scene.toml:2:6", "of is empty", "cuboid"],
        ),
        Case::new(
            "operation_without_of",
            "[[intersection]]\nmaterial = \"a\"\n",
            &["scene.toml:1:1", "missing field `of`"],
        ),
        Case::new(
            "operation_stated_as_one_table",
            "[union]\nof = []\n",
            &["scene.toml:1:1", "write [[union]]"],
        ),
        minus(
            "operand_of_unknown_kind",
            "{ torus = { radius = 1 } }",
            &["scene.toml:3:3", "unknown key \"torus\"", "\"cuboid\""],
        ),
        minus(
            "operand_of_no_kind",
            "{ }",
            &[
                "scene.toml:3:1",
                "an operand must be one solid, but this has 0",
            ],
        ),
        minus(
            "operand_of_two_kinds",
            "{ sphere = { center = [0, 0, 0], radius = 1 }, union = { of = [] } }",
            &["scene.toml:3:1", "but this has 2", "each in its own braces"],
        ),
        minus(
            "operand_without_an_inside",
            "{ disk = { center = [0, 0, 0], normal = [0, 0, 1], radius = 1 } }",
            &["scene.toml:3:10", "a disk has no inside"],
        ),
        minus(
            "operand_that_is_open",
            "{ cylinder = { p0 = [0, 0, 0], p1 = [0, 0, 1], radius = 1, caps = \"p0\" } }",
            &["scene.toml:3:67", "must be closed", "\"both\""],
        ),
        minus(
            "operand_that_is_an_open_cone",
            "{ cone = { p0 = [0, 0, 0], p1 = [0, 0, 1], radius0 = 1, radius1 = 2, caps = \"none\" } }",
            &["scene.toml:3:77", "must be closed"],
        ),
        minus(
            "operand_of_wrong_numbers",
            "{ sphere = { center = [0, 0, 0], radius = -1 } }",
            &["scene.toml:3:43", "radius is -1.0"],
        ),
        minus(
            "operand_with_a_material",
            "{ sphere = { center = [0, 0, 0], radius = 1, material = \"a\" } }",
            &["scene.toml:3:57", "one material", "next to the key of"],
        ),
        minus(
            "operation_within_with_a_material",
            "{ union = { of = [{ sphere = { center = [0, 0, 0], radius = 1 } }], material = \"a\" } }",
            &["scene.toml:3:80", "one material"],
        ),
        minus(
            "operation_within_without_operands",
            "{ union = { of = [] } }",
            &["scene.toml:3:18", "of is empty"],
        ),
        minus(
            "operation_with_an_unknown_key",
            "{ union = { off = [] } }",
            &[
                "scene.toml:3:13",
                "unknown key \"off\"",
                "did you mean \"of\"?",
            ],
        ),
        Case::new(
            "operation_moved_beyond_all_numbers",
            format!("[[union]]\ntranslate = [1e60, 0, 0]\nof = [{BALL}]\n"),
            &[
                "scene.toml:2:13",
                "after the solid is rotated and translated",
                "1e60",
            ],
        ),
        Case::new(
            "operations_within_each_other_without_end",
            format!(
                "[[union]]\nof = [{}{}\n",
                "{ union = { of = [".repeat(5_000),
                "] } }".repeat(5_000)
            ),
            &["scene.toml:2", "nested too deeply"],
        ),
    ]
}
