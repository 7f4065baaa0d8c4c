//! Tables whose header or rows are wrong.

use super::Case;

const POINTS: &str = r#"
[[cylinder_table]]
file = "tree.csv"
columns = { p0 = ["a", "b", "c"], p1 = ["d", "e", "f"], radius = "radius" }
"#;
const AXIS: &str = r#"
[[cylinder_table]]
file = "tree.csv"
columns = { start = ["a", "b", "c"], axis = ["d", "e", "f"], length = "length", diameter = "d m" }
"#;
const SWC: &str = "[[swc]]\nfile = \"neuron.swc\"\n";
const PLACEMENTS: &str = r#"
[[prototype]]
name = "a"
[[prototype.cylinder]]
p0 = [0, 0, 0]
p1 = [0, 0, 1]
radius = 1
[[instance_table]]
of = "a"
file = "places.csv"
columns = { position = ["x", "y", "z"] }
"#;

fn points(name: &'static str, rows: &'static str, message: &'static [&'static str]) -> Case {
    let text = format!("# a tree\na,b,c,d,e,f,radius\n0,0,0,0,0,1,1\n\n{rows}\n");
    Case::new(name, POINTS, message).with("tree.csv", text)
}

fn axis(name: &'static str, row: &'static str, message: &'static [&'static str]) -> Case {
    Case::new(name, AXIS, message).with("tree.csv", format!("a;b;c;d;e;f;length;d m\n{row}"))
}

fn swc(name: &'static str, rows: &'static str, message: &'static [&'static str]) -> Case {
    Case::new(name, SWC, message).with("neuron.swc", format!("# a neuron\n1 1 0 0 0 1 -1\n{rows}"))
}

fn places(
    name: &'static str,
    columns: &str,
    rows: &'static str,
    message: &'static [&'static str],
) -> Case {
    let scene = PLACEMENTS.replace(
        "[\"x\", \"y\", \"z\"]",
        &format!("[\"x\", \"y\", \"z\"]{columns}"),
    );
    Case::new(name, scene, message).with("places.csv", format!("x,y,z,i,j,k,w,s\n{rows}"))
}

pub fn cases() -> Vec<Case> {
    vec![
        Case::new(
            "column_missing",
            POINTS,
            &[
                "tree.csv has no column \"radius\"",
                "scene.toml:4:66",
                "did you mean \"Radius\"? the columns are \"a\", \"b\"",
            ],
        )
        .with("tree.csv", "a,b,c,d,e,f,Radius\n0,0,0,0,0,1,1\n"),
        Case::new(
            "row_that_is_no_cylinder_in_f32",
            format!("records = \"f32\"\n{POINTS}"),
            &[
                "tree.csv:3:",
                "this cylinder is invalid after rounding to f32",
                "0.0 apart",
                "records = \"f64\"",
            ],
        )
        .with(
            "tree.csv",
            "a,b,c,d,e,f,radius\n0,0,0,0,0,1,1\n0,0,1e6,0,0,1000000.001,1\n",
        ),
        Case::new(
            "cylinder_that_is_none_in_f32",
            "records = \"f32\"\n[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1e40]\nradius = 1\n",
            &[
                "scene.toml:3:6",
                "this cylinder is invalid after rounding to f32",
                "records = \"f64\"",
            ],
        ),
        Case::new(
            "sample_that_is_no_cylinder_in_f32",
            format!("records = \"f32\"\n{SWC}"),
            &["neuron.swc:2:", "this cylinder is invalid after rounding to f32"],
        )
        .with("neuron.swc", "1 1 0 0 0 1 -1\n2 1 0 0 1 1e39 1\n"),
        Case::new(
            "column_stated_twice",
            POINTS,
            &["more than one column \"b\"", "scene.toml:4:24"],
        )
        .with("tree.csv", "a,b,c,d,e,f,radius,b\n0,0,0,0,0,1,1,1\n"),
        Case::new(
            "header_missing",
            POINTS,
            &[
                "has no column \"a\"",
                "its first line contains numbers",
                "scene.toml:4:19",
            ],
        )
        .with("tree.csv", "0,0,0,0,0,1,1\n"),
        Case::new(
            "columns_with_p1_and_axis",
            AXIS.replace("length = ", "p1 = [\"d\", \"e\", \"f\"], length = "),
            &["either p1, or both axis and length", "scene.toml:4:11"],
        )
        .with("tree.csv", "a,b,c,d,e,f\n"),
        Case::new(
            "columns_without_radius",
            POINTS.replace(", radius = \"radius\"", ""),
            &["either radius or diameter", "scene.toml:4:11"],
        )
        .with("tree.csv", "a,b,c,d,e,f\n"),
        points(
            "cell_that_is_text",
            "0,0,0,0,0,1,thick",
            &["tree.csv:5: column \"radius\": \"thick\" is not a number"],
        ),
        points(
            "cell_that_is_empty",
            "0,,0,0,0,1,1",
            &["tree.csv:5: column \"b\": the cell is empty"],
        ),
        points(
            "cell_nan",
            "# next\n0,0,0,0,0,NaN,1",
            &["tree.csv:6: column \"f\": \"NaN\" is not a finite number"],
        ),
        points(
            "cell_infinite",
            "0,0,0,-inf,0,1,1",
            &["tree.csv:5: column \"d\": \"-inf\" is not a finite number"],
        ),
        points(
            "row_too_short",
            "0,0,0,0,0,1",
            &["tree.csv:5: the row has 6 cells, but the header has 7"],
        ),
        points(
            "row_too_long",
            "0,0,0,0,0,1,1,1",
            &["tree.csv:5: the row has 8 cells, but the header has 7"],
        ),
        points(
            "row_with_zero_radius",
            "0,0,0,0,0,1,0",
            &[
                "tree.csv:5: column \"radius\": radius is 0",
                "degenerate = \"skip\"",
            ],
        ),
        points(
            "row_with_zero_length",
            "0,0,1,0,0,1,1",
            &[
                "tree.csv:5: p0 and p1 are 0.0 apart",
                "degenerate = \"skip\"",
            ],
        ),
        points(
            "row_with_negative_radius",
            "0,0,0,0,0,1,-2",
            &[
                "tree.csv:5: column \"radius\": radius is -2",
                "must be a positive",
            ],
        ),
        Case::new(
            "row_with_negative_radius_though_skipping",
            format!("{POINTS}degenerate = \"skip\"\n"),
            &["tree.csv:2: column \"radius\": radius is -2"],
        )
        .with("tree.csv", "a,b,c,d,e,f,radius\n0,0,0,0,0,1,-2\n"),
        Case::new(
            "rows_all_skipped",
            format!("{POINTS}degenerate = \"skip\"\n"),
            &["the scene is empty", "all 2 rows were skipped as degenerate"],
        )
        .with(
            "tree.csv",
            "a,b,c,d,e,f,radius\n0,0,0,0,0,1,0\n0,0,0,0,0,0,1\n",
        ),
        Case::new(
            "rows_of_a_prototype_all_skipped",
            "[[instance]]\nof = \"a\"\n[[prototype]]\nname = \"a\"\n[[prototype.swc]]\nfile = \"n.swc\"\ndegenerate = \"skip\"\n",
            &["scene.toml:2:6", "\"a\" contains no solids", "all 1 rows were skipped"],
        )
        .with("n.swc", "1 1 0 0 0 1 -1\n2 1 0 0 0 1 1\n"),
        Case::new(
            "columns_with_radius_and_diameter",
            POINTS.replace("radius =", "diameter = \"d\", radius ="),
            &["radius or diameter, not both", "scene.toml:4:11"],
        )
        .with("tree.csv", "a,b,c,d,e,f,radius\n"),
        Case::new(
            "degenerate_unknown",
            format!("{POINTS}degenerate = \"ignore\"\n"),
            &[
                "scene.toml:5:14",
                "\"ignore\" is not a value of degenerate",
                "\"skip\"",
            ],
        )
        .with("tree.csv", "a,b,c,d,e,f,radius\n0,0,0,0,0,1,1\n"),
        axis(
            "row_with_zero_axis",
            "0;0;0;0;0;0;1;1",
            &[
                "tree.csv:2: column \"d\": the axis is zero",
                "degenerate = \"skip\"",
            ],
        ),
        axis(
            "row_with_negative_length",
            "0;0;0;0;0;1;-1;1",
            &["tree.csv:2: column \"length\": length is -1"],
        ),
        axis(
            "cell_with_a_decimal_comma",
            "0;0;0;0;0;1;1,5;1",
            &["tree.csv:2: column \"length\": \"1,5\" is not a number (such as 1.5"],
        ),
        swc(
            "sample_of_six_cells",
            "2 3 0 0 1 1\n",
            &["neuron.swc:3: the row has 6 cells: SWC has 7"],
        ),
        swc(
            "sample_with_a_broken_id",
            "2.5 3 0 0 1 1 1\n",
            &["neuron.swc:3: column \"id\": \"2.5\" is not a whole number"],
        ),
        swc(
            "sample_with_a_coordinate_nan",
            "2 3 0 nan 1 1 1\n",
            &["neuron.swc:3: column \"y\": \"nan\" is not a finite number"],
        ),
        swc(
            "sample_with_an_unknown_parent",
            "2 3 0 0 1 1 7\n",
            &[
                "neuron.swc:3: column \"parent\": no sample has the id 7",
                "-1",
            ],
        ),
        swc(
            "sample_that_is_its_own_parent",
            "2 3 0 0 1 1 2\n",
            &["neuron.swc:3: column \"parent\": the sample is its own parent"],
        ),
        swc(
            "samples_that_are_each_others_parents",
            "2 3 0 0 1 1 3\n3 3 0 0 2 1 2\n",
            &["neuron.swc:3: column \"parent\": the parents form a cycle: 2 -> 3 -> 2"],
        ),
        swc(
            "samples_in_a_long_cycle_that_others_hang_on",
            "9 3 0 0 9 1 6\n5 3 0 0 5 1 4\n4 3 0 0 4 1 7\n6 3 0 0 6 1 5\n7 3 0 0 7 1 6\n",
            &["neuron.swc:4: column \"parent\": the parents form a cycle: 5 -> 4 -> 7 -> 6 -> 5"],
        ),
        swc(
            "sample_with_an_id_used_before",
            "\n1 3 0 0 1 1 1\n",
            &["neuron.swc:4: column \"id\": the id 1 is already on line 2"],
        ),
        swc(
            "sample_with_zero_radius",
            "2 3 0 0 1 0 1\n",
            &[
                "neuron.swc:3: column \"radius\": radius is 0",
                "degenerate = \"skip\"",
            ],
        ),
        swc(
            "sample_at_its_parent",
            "2 3 0 0 0 1 1\n",
            &[
                "neuron.swc:3: p0 and p1 are 0.0 apart",
                "degenerate = \"skip\"",
            ],
        ),
        Case::new(
            "neuron_without_segments",
            format!("{SWC}soma = \"none\"\n"),
            &["the scene is empty"],
        )
        .with("neuron.swc", "1 1 0 0 0 1 -1\n"),
        places(
            "axis_without_degrees",
            ", axis = [\"i\", \"j\", \"k\"]",
            "0,0,0,0,0,1,1,1\n",
            &["scene.toml:11:11", "both axis and degrees, or quaternion"],
        ),
        places(
            "row_with_a_zero_rotation_axis",
            ", axis = [\"i\", \"j\", \"k\"], degrees = \"w\"",
            "0,0,0,0,0,0,1,1\n",
            &["places.csv:2: column \"i\": the rotation axis is zero"],
        ),
        places(
            "row_with_a_zero_quaternion",
            ", quaternion = [\"i\", \"j\", \"k\", \"w\"]",
            "0,0,0,0,0,0,1,1\n0,0,0,0,0,0,0,1\n",
            &["places.csv:3: column \"i\": the quaternion is zero"],
        ),
        places(
            "row_with_zero_scale",
            ", scale = \"s\"",
            "0,0,0,0,0,0,1,0\n",
            &["places.csv:2: the placement is singular"],
        ),
        places(
            "scale_column_missing",
            ", scale = \"size\"",
            "0,0,0,0,0,0,1,0\n",
            &["scene.toml:11:49", "no column \"size\"", "\"s\""],
        ),
    ]
}
