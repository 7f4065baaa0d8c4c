//! Files that are missing, are no text, or are no TOML.

use super::Case;

const TABLE: &str = r#"
[[cylinder_table]]
file = "tree.csv"
columns = { p0 = ["a", "b", "c"], p1 = ["d", "e", "f"], radius = "r" }
"#;

const SWC: &str = r#"
[[swc]]
file = "neuron.swc"
"#;

pub fn cases() -> Vec<Case> {
    vec![
        Case::new(
            "scene_that_is_blank",
            "",
            &["the scene is empty", "scene.toml:1:1", "add a [[cylinder]]"],
        ),
        Case::new(
            "scene_with_settings_only",
            "[film]\nwidth = 3\n",
            &["the scene is empty", "scene.toml:1:1"],
        ),
        Case::new(
            "scene_of_broken_toml",
            "[film]\nwidth = 3\nheight = = 4\n",
            &["scene.toml:3:10", "3 | height = = 4"],
        ),
        Case::new(
            "scene_with_a_key_stated_twice",
            "[film]\nwidth = 3\nwidth = 4\n",
            &["scene.toml:3:1", "duplicate key"],
        ),
        Case::of_bytes(
            "scene_in_latin_1",
            &b"[film]\nwidth = 3 # gr\xf6sse\n"[..],
            &["scene.toml:2:15", "not UTF-8", "save the file as UTF-8"],
        ),
        Case::of_bytes(
            "scene_in_utf_16",
            &b"\xff\xfe[\0f\0"[..],
            &["scene.toml:1:1", "looks like UTF-16"],
        ),
        Case::new(
            "scene_with_a_mark_and_a_wrong_key",
            "\u{feff}\n[film]\nwidht = 3\n",
            &[
                "scene.toml:3:1",
                "unknown key \"widht\"",
                "did you mean \"width\"?",
            ],
        ),
        Case::new(
            "scene_with_a_line_of_10_mb",
            format!("[film]\nwidth = \"{}\"\n", "x".repeat(10_000_000)),
            &["scene.toml:2:9", "a whole number, 0 or more"],
        ),
        Case::new(
            "scene_with_a_key_of_10_mb",
            format!("[film]\n{} = 3\n", "x".repeat(10_000_000)),
            &["scene.toml:2:1", "unknown key \"xxxx"],
        ),
        Case::new(
            "scene_with_arrays_a_million_deep",
            format!("background = {}", "[".repeat(1_000_000)),
            &["scene.toml:1:"],
        ),
        Case::new(
            "table_that_is_missing",
            TABLE,
            &[
                "tree.csv: the file does not exist",
                "scene.toml:3:8",
                "relative to the folder",
            ],
        ),
        Case::new(
            "table_that_is_a_folder",
            TABLE.replace("tree.csv", "."),
            &["it is a directory", "scene.toml:3:8"],
        ),
        Case::new(
            "table_that_is_blank",
            TABLE,
            &["tree.csv:1", "the table is empty"],
        )
        .with("tree.csv", ""),
        Case::new(
            "table_of_comments",
            TABLE,
            &["tree.csv:3", "the table is empty"],
        )
        .with("tree.csv", "# a,b,c\n\n"),
        Case::new(
            "table_without_rows",
            TABLE,
            &["a header but no rows", "scene.toml:3:8"],
        )
        .with("tree.csv", "a,b,c,d,e,f,r\n# nothing\n"),
        Case::new("table_in_latin_1", TABLE, &["tree.csv:4", "not UTF-8"]).with_bytes(
            "tree.csv",
            b"a,b,c,d,e,f,r,name\n0,0,0,0,0,1,1,oak\n# \xe9\n0,0,0,0,0,1,1,ch\xeane\n",
        ),
        Case::new(
            "table_in_utf_16",
            TABLE,
            &["tree.csv:1", "looks like UTF-16"],
        )
        .with_bytes("tree.csv", b"\xff\xfea\0,\0b\0\r\0\n\0"),
        Case::new(
            "table_with_a_line_of_10_mb",
            TABLE,
            &["tree.csv:2: column \"r\"", "is not a number", "..."],
        )
        .with(
            "tree.csv",
            format!("a,b,c,d,e,f,r\n0,0,0,0,0,1,{}\n", "x".repeat(10_000_000)),
        ),
        Case::new(
            "table_with_a_header_of_10_mb",
            TABLE,
            &["has no column \"a\"", "scene.toml:4:"],
        )
        .with("tree.csv", "x".repeat(10_000_000)),
        Case::new(
            "neuron_that_is_missing",
            SWC,
            &["neuron.swc: the file does not exist", "scene.toml:3:8"],
        ),
        Case::new(
            "neuron_that_is_blank",
            SWC,
            &["neuron.swc:1", "contains no samples"],
        )
        .with("neuron.swc", "# nothing\n"),
        Case::new("neuron_in_latin_1", SWC, &["neuron.swc:2", "not UTF-8"]).with_bytes(
            "neuron.swc",
            b"# \xe9 is welcome in a comment\n1 1 0 0 0 1 -1 \xe9\n",
        ),
        Case::new(
            "neuron_with_a_line_of_10_mb",
            SWC,
            &[
                "neuron.swc:1",
                "the row has more than 16384 cells: SWC has 7",
            ],
        )
        .with("neuron.swc", "1 ".repeat(5_000_000)),
    ]
}
