//! The keys that state what others compute: `primitive`, `axes` and the columns `primitive`
//! and `matrix`.

use std::fs;

use cyltrace::math::Orientation;
use cyltrace::scene::{Scene, SceneError, load};
use glam::{DAffine3, DVec3};

const TABLE: &str = "x0,y0,z0,x1,y1,z1,r,n\n0,0,0,0,0,1,1,7\n0,0,0,0,0,2,1,8\n\
     0,0,0,0,0,3,0,2\n0,0,0,0,0,4,1,3\n";
const COLUMNS: &str = "p0 = [0, 1, 2], p1 = [3, 4, 5], radius = 6, primitive = 7";
const MATRICES: &str = "a,b,c,x,d,e,f,y,g,h,i,z\n0,-1,0,1,1,0,0.5,2,0,0,2,3\n";
const MATRIX: &str =
    r#"matrix = [["a", "b", "c", "x"], ["d", "e", "f", "y"], ["g", "h", "i", "z"]]"#;
const SPHERE: &str = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";

fn loaded(text: &str) -> Result<Scene, SceneError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("table.csv"), TABLE).expect("a table");
    fs::write(folder.path().join("matrices.csv"), MATRICES).expect("a table");
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).expect("a scene file");
    load(&path)
}

fn scene(text: &str) -> Scene {
    loaded(text).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

#[test]
fn numbers_continue_from_the_stated_one_in_any_order() {
    let union = "[[union]]\nof = [{ sphere = { center = [0, 0, 0], radius = 1 } }]\n";
    let difference = union.replace("union", "difference");
    let scene = scene(&format!(
        "{SPHERE}primitive = 10\n{SPHERE}{SPHERE}primitive = 4\n{union}{difference}primitive = 0\n\
         {union}primitive = 4294967294\n"
    ));
    let solids = &scene.prototypes[0].solids;
    let spheres: Vec<u32> = solids.spheres.iter().map(|one| one.primitive).collect();
    assert_eq!(spheres, [4, 10, 11]);
    let composed = solids.compositions.iter();
    let composed: Vec<u32> = composed.map(|one| one.primitive).collect();
    assert_eq!(composed, [0, 5, 4_294_967_294]);
    assert_eq!(solids.compositions[0].solid.kind().name(), "difference");
}

#[test]
fn rows_have_the_numbers_of_their_column() {
    let table = format!("file = \"table.csv\"\ncolumns = {{ {COLUMNS} }}\ndegenerate = \"skip\"");
    let scene = scene(&format!("[[cylinder_table]]\n{table}\n{SPHERE}"));
    let root = &scene.prototypes[0];
    let cylinders = root.solids.cylinders.iter();
    let cylinders: Vec<(u32, f64)> = cylinders
        .map(|record| (record.primitive(), record.cylinder().p1().z))
        .collect();
    assert_eq!(cylinders, [(7, 1.0), (8, 2.0), (3, 4.0)]);
    assert_eq!(root.solids.spheres[0].primitive, 4);
    let rows = [7, 8, 2, 3].map(|number| root.solid_origins.of(number).and_then(|one| one.row));
    assert_eq!(rows, [1, 2, 3, 4].map(Some));
    assert_eq!(root.solid_origins.of(4), None);
    assert_eq!(root.solid_origins.of(9), None);
}

#[test]
fn axes_are_the_orientation_before_the_pose() {
    let first = Orientation::IDENTITY.rotated(DVec3::new(1.0, 2.0, 3.0), 10.0);
    let axes = format!("{:?}", first.world_from_object().to_cols_array_2d());
    let cuboid = format!("[[cuboid]]\nhalf_widths = [1, 2, 3]\naxes = {axes}\n");
    let scene = scene(&format!("{cuboid}{cuboid}rotate_z = 20\n"));
    let found: Vec<Orientation> = scene.prototypes[0]
        .solids
        .cuboids
        .iter()
        .map(|record| record.solid.orientation())
        .collect();
    assert_eq!(found, [first, first.rotated_z(20.0)]);
}

#[test]
fn matrices_of_a_table_are_placements() {
    let of = "[[prototype]]\nname = \"p\"\n[[prototype.sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    let table = "[[instance_table]]\nof = \"p\"\nfile = \"matrices.csv\"\n";
    let scene = scene(&format!("{of}{table}columns = {{ {MATRIX} }}\n"));
    let placement = scene.prototypes[0].placements[0].parent_from_child;
    let expected = DAffine3::from_cols(
        DVec3::new(0.0, 1.0, 0.0),
        DVec3::new(-1.0, 0.0, 0.0),
        DVec3::new(0.0, 0.5, 2.0),
        DVec3::new(1.0, 2.0, 3.0),
    );
    assert_eq!(placement, expected);
}

#[test]
fn wrong_statements_are_errors_at_their_place() {
    let cuboid = "[[cuboid]]\nhalf_widths = [1, 1, 1]\naxes = ";
    let table = "[[cylinder_table]]\nfile = \"table.csv\"\ndegenerate = \"skip\"\ncolumns = ";
    let placed = "[[prototype]]\nname = \"p\"\n[[prototype.sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
         [[instance_table]]\nof = \"p\"\nfile = \"matrices.csv\"\ncolumns = ";
    let cases = [
        (
            format!("{SPHERE}{SPHERE}primitive = 0\n"),
            ["toml:7:13", "two solids have the primitive number 0"],
        ),
        (
            format!("{SPHERE}primitive = 4294967295\n"),
            ["toml:4:13", "at most 4294967294"],
        ),
        (
            format!("{SPHERE}primitive = 4294967294\n{SPHERE}"),
            ["toml:6:10", "at most 4294967295 primitives"],
        ),
        (
            "[[union]]\nof = [{ sphere = { center = [0, 0, 0], radius = 1, primitive = 1 } }]\n"
                .to_owned(),
            ["toml:2:", "one primitive number"],
        ),
        (
            format!("{table}{{ {} }}\n{SPHERE}primitive = 7\n", COLUMNS),
            ["toml:4:11", "number 7"],
        ),
        (
            format!(
                "{table}{{ {} }}\n",
                COLUMNS.replace("primitive = 7", "primitive = 3")
            ),
            ["two solids", "number 0"],
        ),
        (
            format!("{cuboid}[[1, 0, 0], [0, 1, 0], [0, 0, 1.001]]\n"),
            ["toml:3:8", "not orthonormal"],
        ),
        (
            format!("{cuboid}[[0, 1, 0], [1, 0, 0], [0, 0, 1]]\n"),
            ["toml:3:8", "right-handed"],
        ),
        (
            format!("{placed}{{ {MATRIX}, scale = \"a\" }}\n"),
            ["toml:9:11", "not both"],
        ),
        (
            format!("{placed}{{ scale = \"a\" }}\n"),
            ["toml:9:11", "either position or matrix"],
        ),
    ];
    for (text, expected) in cases {
        let error = loaded(&text).expect_err("a wrong scene").to_string();
        for part in expected {
            assert!(error.contains(part), "{text}\n{error}\nis not: {part}");
        }
    }
}

#[test]
fn numbers_of_rows_that_are_not_whole_are_errors() {
    for (number, expected) in [
        ("1.5", "primitive is 1.5"),
        ("-1", "whole number"),
        (
            "5e9",
            "primitive is 5000000000: it must be at most 4294967294",
        ),
        ("", "the cell is empty"),
    ] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let table = format!("x0,y0,z0,x1,y1,z1,r,n\n0,0,0,0,0,1,1,{number}\n");
        fs::write(folder.path().join("table.csv"), table).expect("a table");
        let text = format!(
            "[[cylinder_table]]\nfile = \"table.csv\"\ndegenerate = \"skip\"\ncolumns = {{ {COLUMNS} }}\n"
        );
        let path = folder.path().join("scene.toml");
        fs::write(&path, text).expect("a scene file");
        let error = load(&path).expect_err("a wrong row").to_string();
        assert!(error.contains("table.csv:2"), "{error}");
        assert!(error.contains(expected), "{error}\nis not: {expected}");
    }
}
