//! Prototypes that cannot be placed, and placements that are none.

use std::fmt::Write;

use super::Case;

/// A prototype `a` with a solid; more follows from line 6.
const A: &str = "[[prototype]]\nname = \"a\"\n[[prototype.cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\n";

fn with_a(name: &'static str, more: &str, message: &'static [&'static str]) -> Case {
    Case::new(name, format!("{A}{more}"), message)
}

/// Placements of `a` inside each other, `levels` deep, each with these keys.
fn nested(levels: usize, keys: &str) -> String {
    let mut text = A.to_owned();
    let mut inner = "a".to_owned();
    for level in 1..levels {
        let _ = write!(
            text,
            "[[prototype]]\nname = \"level {level}\"\n[[prototype.instance]]\nof = \"{inner}\"\n{keys}"
        );
        inner = format!("level {level}");
    }
    let _ = write!(text, "[[instance]]\nof = \"{inner}\"\n{keys}");
    text
}

pub fn cases() -> Vec<Case> {
    vec![
        with_a(
            "prototype_unknown",
            "[[prototype]]\nname = \"spruce\"\n[[instance]]\nof = \"sprucce\"\n",
            &[
                "scene.toml:10:6",
                "unknown prototype \"sprucce\"",
                "did you mean \"spruce\"?",
                "\"a\"",
            ],
        ),
        with_a(
            "prototype_never_placed",
            "",
            &[
                "the scene is empty",
                "place a prototype with an [[instance]]",
            ],
        ),
        with_a(
            "prototype_without_solids",
            "[[prototype]]\nname = \"b\"\n[[instance]]\nof = \"b\"\n",
            &["scene.toml:10:6", "\"b\" contains no solids"],
        ),
        with_a(
            "prototype_name_twice",
            "[[prototype]]\nname = \"a\"\n",
            &[
                "scene.toml:8:8",
                "the prototype \"a\" is already defined on line 2",
            ],
        ),
        with_a(
            "prototype_that_places_itself",
            "[[prototype.instance]]\nof = \"a\"\n",
            &["scene.toml:8:6", "in a cycle: \"a\" -> \"a\""],
        ),
        with_a(
            "prototypes_in_a_cycle",
            "[[prototype]]\nname = \"b\"\n[[prototype.instance]]\nof = \"c\"\n[[prototype]]\nname = \"c\"\n[[prototype.scatter]]\nof = \"b\"\npattern = \"grid\"\ncount = 1\nspacing = 1\n[[instance]]\nof = \"a\"\n",
            &["scene.toml:14:6", "in a cycle: \"b\" -> \"c\" -> \"b\""],
        ),
        Case::new(
            "nesting_of_65_levels",
            nested(65, ""),
            &["scene.toml:264:6", "nested 65 levels deep", "at most 64"],
        ),
        Case::new(
            "nesting_of_20000_levels",
            nested(20_000, ""),
            &["nested 65 levels deep", "at most 64"],
        ),
        Case::new(
            "nesting_that_grows_out_of_range",
            nested(4, "scale = 1e9\n"),
            &[
                "scale the content of \"level 2\" by factors from",
                "to 1.0e27",
                "scene.toml:20:6",
            ],
        ),
        Case::new(
            "nesting_that_shrinks_out_of_range",
            nested(4, "scale = 1e-9\n"),
            &["by factors from 1.0e-27", "scene.toml:20:6"],
        ),
        Case::new(
            "placement_that_takes_coordinates_out_of_range",
            nested(1, "scale = 1e2\n").replace("p0 = [0", "p0 = [1e44"),
            &[
                "placed here, \"a\" may reach coordinates of 2.0e46",
                "scene.toml:8:6",
            ],
        ),
        with_a(
            "scale_too_uneven",
            "[[instance]]\nof = \"a\"\nscale = [1e9, 1, 1]\n",
            &["scene.toml:9:9", "too unevenly", "at most 2^27"],
        ),
        with_a(
            "scale_zero",
            "[[instance]]\nof = \"a\"\nscale = [1, 0, 1]\n",
            &["scene.toml:9:9", "singular"],
        ),
        with_a(
            "scale_too_large",
            "[[instance]]\nof = \"a\"\nscale = 1e31\n",
            &["scene.toml:9:9", "at most 2^100"],
        ),
        with_a(
            "matrix_singular",
            "[[instance]]\nof = \"a\"\nmatrix = [[1, 2, 3, 0], [4, 5, 6, 0], [7, 8, 9, 0]]\n",
            &["scene.toml:9:10", "the placement is singular"],
        ),
        with_a(
            "matrix_of_three_columns",
            "[[instance]]\nof = \"a\"\nmatrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n",
            &[
                "scene.toml:9:11",
                "invalid length 3, expected an array of length 4",
            ],
        ),
        with_a(
            "matrix_and_scale",
            "[[instance]]\nof = \"a\"\nscale = 2\nmatrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]\n",
            &["scene.toml:10:10", "matrix excludes scale"],
        ),
        with_a(
            "rotation_axis_zero",
            "[[instance]]\nof = \"a\"\nrotate = [{ axis = [0, 0, 0], degrees = 30 }]\n",
            &["scene.toml:9:20", "the rotation axis is zero"],
        ),
        with_a(
            "scatter_of_none",
            "[[scatter]]\nof = \"a\"\npattern = \"grid\"\ncount = 0\nspacing = 1\n",
            &["scene.toml:10:9", "count is 0", "between 1 and"],
        ),
        with_a(
            "scatter_of_more_than_u32",
            "[[scatter]]\nof = \"a\"\npattern = \"grid\"\ncount = 4294967296\nspacing = 1\n",
            &[
                "scene.toml:10:9",
                "count is 4294967296",
                "between 1 and 4294967295",
            ],
        ),
        with_a(
            "scatter_beside_an_instance_of_more_than_u32",
            "[[instance]]\nof = \"a\"\n[[scatter]]\nof = \"a\"\npattern = \"grid\"\ncount = 4294967295\nspacing = 1\n",
            &["scene.toml:10:6", "this makes 4294967296 placements"],
        ),
        with_a(
            "scatter_spacing_zero",
            "[[scatter]]\nof = \"a\"\npattern = \"disc\"\ncount = 4\nspacing = 0\n",
            &["scene.toml:11:11", "spacing is 0"],
        ),
        with_a(
            "scatter_scale_reversed",
            "[[scatter]]\nof = \"a\"\npattern = \"disc\"\ncount = 4\nspacing = 1\nscale = [2, 1]\n",
            &[
                "scene.toml:12:9",
                "scale is [2, 1]",
                "the least and the greatest",
            ],
        ),
        with_a(
            "scatter_pattern_unknown",
            "[[scatter]]\nof = \"a\"\npattern = \"disks\"\ncount = 4\nspacing = 1\n",
            &[
                "scene.toml:9:11",
                "\"disks\" is not a value of pattern",
                "did you mean \"disk\"?",
            ],
        ),
    ]
}
