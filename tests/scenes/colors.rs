//! Colors of materials: what the keys of `docs/scene-file.md` state, the values of columns, and
//! the errors of either.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use cyltrace::scene::{
    Along, Color, ColorMap, Corner, DataColor, MaterialIndex, Scene, SceneFile, load,
};
use glam::DVec3;
use test_support::three_mf;

const TABLE: &str = "x0,y0,z0,x1,y1,z1,r,order,\"height, m\",part\n\
    0,0,0,0,0,1,0.5,2,1.5,stem\n0,0,1,0,0,2,0.5,,-2,branch\n0,0,2,0,0,2,0.5,99,99,twig\n\
    0,0,3,0,0,4,0.5,7,0.25,twig\n";

const PLACES: &str = "x,y,z,charge\n0,0,0,-1\n5,0,0,3\n9,0,0,NA\n";

const NEURON: &str = "1 1 0 0 0 1 -1\n2 3 0 0 2 0.5 1\n3 3 0 0 5 0.5 2\n4 4 0 4 5 0.25 3\n\
    5 4 3 0 5 0.125 3\n6 4 3 0 9 0.125 5\n7 2 0 -1 0 0.5 1\n";

const LATTICE: &str = "<resources><object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>\
     <vertex x=\"0\" y=\"0\" z=\"9\"/></vertices><b:beamlattice radius=\"1\" minlength=\"0\" cap=\"butt\"><b:beams>\
     <b:beam v1=\"0\" v2=\"1\" r1=\"1\" r2=\"2\"/></b:beams></b:beamlattice></mesh></object></resources>\
     <build><item objectid=\"1\"/></build>";

/// The cylinders of the table above, in a material.
const CYLINDERS: &str = "[[cylinder_table]]\nfile = \"t.csv\"\nmaterial = \"m\"\ndegenerate = \"skip\"\n\
    columns = { p0 = [\"x0\", \"y0\", \"z0\"], p1 = [\"x1\", \"y1\", \"z1\"], radius = \"r\" }\n";

fn folder(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, bytes: &[u8]| {
        fs::write(folder.path().join(name), bytes).expect("a file");
    };
    write("t.csv", TABLE.as_bytes());
    write("places.csv", PLACES.as_bytes());
    write("n.swc", NEURON.as_bytes());
    write("l.3mf", &three_mf::three_mf(&three_mf::model("", LATTICE)));
    write("scene.toml", text.as_bytes());
    folder
}

fn loaded(text: &str) -> Result<Scene, String> {
    let folder = folder(text);
    load(&folder.path().join("scene.toml")).map_err(|error| error.to_string())
}

fn scene(text: &str) -> Scene {
    loaded(text).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// The scene file of a material with a color, followed by solids.
fn with_color(color: &str, solids: &str) -> String {
    let sphere = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    let solids = if solids.is_empty() { sphere } else { solids };
    format!("[[material]]\nname = \"m\"\ncolor = {color}\n{solids}")
}

fn color(scene: &Scene) -> &Color {
    &scene.materials[1].color
}

fn data(scene: &Scene) -> &DataColor {
    match color(scene) {
        Color::Data(data) => data,
        other => panic!("{other:?}"),
    }
}

fn values(scene: &Scene, numbers: std::ops::Range<u32>) -> Vec<Option<f32>> {
    let list = &scene.prototypes[0].solid_values;
    numbers.map(|number| list.get(number)).collect()
}

#[test]
fn patterns_are_as_stated() {
    let checker = scene(&with_color(
        "{ checker = [[1, 0, 0], [0, 0, 1]], count = [4, 2] }",
        "",
    ));
    let Color::Checker(checker) = color(&checker) else {
        panic!("no checker");
    };
    assert_eq!(
        (checker.colors, checker.count),
        ([DVec3::X, DVec3::Z], [4, 2])
    );
    let stripes = "{ stripes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], count = 9, along = \"u\" }";
    let stripes = scene(&with_color(stripes, ""));
    let Color::Stripes(stripes) = color(&stripes) else {
        panic!("no stripes");
    };
    assert_eq!(stripes.colors, [DVec3::X, DVec3::Y, DVec3::Z]);
    assert_eq!((stripes.count, stripes.along), (9, Along::U));
    let default = scene(&with_color("{ stripes = [[1, 0, 0], [0, 1, 0]] }", ""));
    let Color::Stripes(default) = color(&default) else {
        panic!("no stripes");
    };
    assert_eq!((default.count, default.along), (2, Along::V));
}

#[test]
fn columns_of_tables_are_values_of_solids() {
    let text = with_color("{ column = \"order\" }", CYLINDERS);
    let order = scene(&text);
    // The second cell is empty, the third row is skipped.
    assert_eq!(
        values(&order, 0..5),
        [Some(2.0), None, None, Some(7.0), None]
    );
    let shown = data(&order);
    assert_eq!(shown.map, ColorMap::named("viridis").expect("a map"));
    // The skipped row has 99.
    assert_eq!(
        (shown.range, shown.missing),
        ([2.0, 7.0], DVec3::splat(0.5))
    );
    let folder = folder(&text);
    let file = SceneFile::read(&folder.path().join("scene.toml")).expect("a scene file");
    let expected = file.contents()[0].values_bytes;
    let loaded = order.contents()[0].values_bytes;
    assert_eq!(loaded, 4 * 4 + 8);
    // The end of the last line counts as one more.
    assert_eq!(expected, loaded + 4);

    let height = "{ column = \"height, m\", map = \"rdbu\", range = [-3, 3], missing = [1, 0, 0] }";
    let height = scene(&with_color(height, CYLINDERS));
    assert_eq!(
        values(&height, 0..4),
        [Some(1.5), Some(-2.0), None, Some(0.25)]
    );
    assert_eq!(
        (data(&height).range, data(&height).missing),
        ([-3.0, 3.0], DVec3::X)
    );

    let part = "{ column = \"part\", map = \"tab10\", labels = [\"stem\", \"branch\", \"twig\"] }";
    let part = scene(&with_color(part, CYLINDERS));
    assert_eq!(values(&part, 0..4), [Some(0.0), Some(1.0), None, Some(2.0)]);

    let constant = scene(&with_color("[1, 0, 0]", CYLINDERS));
    assert_eq!(constant.prototypes[0].values_bytes(), 0);
}

#[test]
fn columns_are_shared_by_materials_with_the_same_column() {
    let text = "[[material]]\nname = \"m\"\ncolor = { column = \"order\" }\n\
        [[material]]\nname = \"other\"\ncolor = { column = \"order\", map = \"plasma\" }\n\
        [[material]]\nname = \"fixed\"\ncolor = { column = \"order\", range = [0, 1] }\n\
        [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"other\"\nvalues = { order = 100, x = 7 }\n\
        [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"fixed\"\nvalues = { order = -5 }\n";
    let scene = scene(&format!("{text}{CYLINDERS}"));
    let ranges = scene
        .materials
        .iter()
        .filter_map(|material| match &material.color {
            Color::Data(data) => Some(data.range),
            _ => None,
        });
    let ranges: Vec<_> = ranges.collect();
    assert_eq!(ranges, [[-5.0, 100.0], [-5.0, 100.0], [0.0, 1.0]]);
}

#[test]
fn placements_have_values_of_tables_and_keys() {
    let text = "[[material]]\nname = \"m\"\ncolor = { column = \"charge\" }\n\
        [[prototype]]\nname = \"p\"\n[[prototype.sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\n\
        [[instance]]\nof = \"p\"\nvalues = { charge = 12 }\n[[instance]]\nof = \"p\"\n\
        [[instance_table]]\nof = \"p\"\nfile = \"places.csv\"\ncolumns = { position = [\"x\", \"y\", \"z\"] }\n";
    let scene = scene(text);
    let [shown] = scene.prototypes[0].placement_values.as_slice() else {
        panic!("one column");
    };
    assert_eq!(shown.column, "charge");
    let values: Vec<_> = (0..6).map(|number| shown.values.get(number)).collect();
    assert_eq!(
        values,
        [Some(12.0), None, Some(-1.0), Some(3.0), None, None]
    );
    assert_eq!(data(&scene).range, [-1.0, 12.0]);
}

#[test]
fn columns_of_neurons_follow_the_tree() {
    let swc = "[[swc]]\nfile = \"n.swc\"\nmaterial = \"m\"\n";
    // Segments of the samples 2 to 7, and the ball of the soma.
    for (column, expected) in [
        ("type", [3.0, 3.0, 4.0, 4.0, 4.0, 2.0, 1.0]),
        ("radius", [0.5, 0.5, 0.25, 0.125, 0.125, 0.5, 1.0]),
        ("path_length", [2.0, 5.0, 9.0, 8.0, 12.0, 1.0, 0.0]),
        // The soma branches, but is no branch point; sample 3 is one.
        ("depth", [0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0]),
    ] {
        let scene = scene(&with_color(&format!("{{ column = \"{column}\" }}"), swc));
        assert_eq!(values(&scene, 0..7), expected.map(Some), "{column}");
    }
}

#[test]
fn radius_of_lattices_is_the_mean_of_both_ends() {
    let lattice = "[[beam_lattice]]\nfile = \"l.3mf\"\nmaterial = \"m\"\n";
    let scene = scene(&with_color("{ column = \"radius\" }", lattice));
    assert_eq!(values(&scene, 0..1), [Some(1.5)]);
}

#[test]
fn wrong_colors_are_errors_at_their_key() {
    let swc = "[[swc]]\nfile = \"n.swc\"\nmaterial = \"m\"\n";
    for (color, solids, texts) in [
        (
            "{ count = 3 }",
            "",
            &["exactly one of the keys checker"][..],
        ),
        (
            "{ image = \"a.png\", column = \"x\" }",
            "",
            &["exactly one"],
        ),
        (
            "{ checker = [[1, 0, 0], [0, 0, 2]] }",
            "",
            &["[0, 0, 2]", "in [0, 1]"],
        ),
        (
            "{ checker = [[1, 0, 0], [0, 0, 1]], along = \"u\" }",
            "",
            &["checker has no key along"],
        ),
        (
            "{ checker = [[1, 0, 0], [0, 0, 1]], count = 3 }",
            "",
            &["two whole numbers"],
        ),
        (
            "{ checker = [[1, 0, 0], [0, 0, 1]], count = [0, 3] }",
            "",
            &["two whole numbers"],
        ),
        ("{ stripes = [] }", "", &["at least one color"]),
        (
            "{ stripes = [[1, 1, 1]], count = -1 }",
            "",
            &["a whole number from 1"],
        ),
        (
            "{ stripes = [[1, 1, 1]], along = \"w\" }",
            "",
            &["\"w\" is not a value of along"],
        ),
        (
            "{ image = \"none.png\" }",
            "",
            &["none.png", "relative to the folder"],
        ),
        (
            "{ image = \"t.csv\" }",
            "",
            &["cannot read", "opaque PNG file"],
        ),
        (
            "{ colunm = \"x\" }",
            "",
            &["unknown key \"colunm\"", "\"column\""],
        ),
        (
            "{ column = \"order\", map = \"virids\" }",
            CYLINDERS,
            &["unknown color map \"virids\"", "did you mean \"viridis\"?"],
        ),
        (
            "{ column = \"order\", range = [7, 0] }",
            CYLINDERS,
            &["range is [7, 0]", "less than"],
        ),
        (
            "{ column = \"order\", range = \"all\" }",
            CYLINDERS,
            &["\"all\"", "\"auto\""],
        ),
        (
            "{ column = \"part\", map = \"tab10\", range = [0, 1] }",
            CYLINDERS,
            &["categories, which have no range"],
        ),
        (
            "{ column = \"oder\" }",
            CYLINDERS,
            &[
                "scene.toml:3:",
                "column \"oder\"",
                "did you mean \"order\"?",
            ],
        ),
        (
            "{ column = \"pathlength\" }",
            swc,
            &["column \"pathlength\"", "did you mean \"path_length\"?"],
        ),
        ("{ column = \"x\" }", "", &["no solid with this material"]),
        ("{ column = \" \" }", "", &["not the name of a column"]),
        (
            "{ column = \"part\" }",
            CYLINDERS,
            &["t.csv:2", "\"stem\" is not a number"],
        ),
        (
            "{ column = \"part\", map = \"tab10\", labels = [\"stem\"] }",
            CYLINDERS,
            &[
                "t.csv:3",
                "\"branch\" is neither a whole number nor a label",
            ],
        ),
        (
            "{ column = \"part\", labels = [\"7\"] }",
            CYLINDERS,
            &["the label \"7\" must not be empty or a number"],
        ),
        (
            "{ column = \"height, m\", map = \"tab10\" }",
            CYLINDERS,
            &["t.csv:2", "1.5 is not a category"],
        ),
    ] {
        let text = with_color(color, solids);
        let error = loaded(&text).expect_err(color);
        for text in texts {
            assert!(error.contains(text), "{color}: {error}\nlacks: {text}");
        }
    }
    let labels = "[[material]]\nname = \"a\"\ncolor = { column = \"part\", labels = [\"stem\"] }\n\
        [[material]]\nname = \"m\"\ncolor = { column = \"part\", labels = [\"twig\"] }\n";
    let error = loaded(labels).expect_err("two lists of labels");
    assert!(
        error.contains("labels of the column \"part\" differ"),
        "{error}"
    );
}

/// The distances from the root of the segments of a neuron, from the text of its file: each is
/// followed from the sample to the root.
fn path_lengths(text: &str) -> Vec<f64> {
    let samples: Vec<Vec<f64>> = text
        .lines()
        .map(|line| line.split('#').next().unwrap_or_default())
        .map(|line| {
            line.split_whitespace()
                .map(|cell| cell.parse().expect("a number"))
                .collect()
        })
        .filter(|cells: &Vec<f64>| !cells.is_empty())
        .collect();
    let by_id: HashMap<i64, &Vec<f64>> = samples
        .iter()
        .map(|sample| (sample[0] as i64, sample))
        .collect();
    let length = |sample: &Vec<f64>| {
        let (mut sum, mut sample) = (0.0, sample);
        while let Some(parent) = by_id.get(&(sample[6] as i64)) {
            let squares = (2..5).map(|axis| (sample[axis] - parent[axis]).powi(2));
            sum += squares.sum::<f64>().sqrt();
            sample = parent;
        }
        sum
    };
    let segments = samples.iter().filter(|sample| sample[6] >= 0.0);
    segments.map(length).collect()
}

#[test]
fn path_lengths_of_a_neuron_are_those_of_its_file() {
    let path: PathBuf =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/neurom_Neuron.swc");
    let Ok(text) = fs::read_to_string(&path) else {
        println!("skipped: there is no {}", path.display());
        return;
    };
    let swc = format!(
        "[[swc]]\nfile = '{}'\nmaterial = \"m\"\ndegenerate = \"skip\"\nsoma = \"none\"\n",
        path.display()
    );
    let scene = scene(&with_color("{ column = \"path_length\" }", &swc));
    let expected = path_lengths(&text);
    let cylinders = &scene.prototypes[0].solids.cylinders;
    assert!(cylinders.len() > 800);
    let mut greatest = 0.0_f64;
    for record in cylinders {
        assert_eq!(record.material(), MaterialIndex(1));
        let value = scene.prototypes[0].solid_values.get(record.primitive());
        let value = f64::from(value.expect("a value"));
        let exact = expected[record.primitive() as usize];
        assert!((value - exact).abs() <= 1e-7 * exact, "{value} {exact}");
        greatest = greatest.max(exact);
    }
    assert!((data(&scene).range[1] - greatest).abs() < 1e-6 * greatest);
}

#[test]
fn legend_is_of_a_data_color() {
    let data = |legend: &str| {
        let sphere =
            "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\nvalues = { x = 1 }\n";
        with_color("{ column = \"x\" }", &format!("{sphere}[legend]\n{legend}"))
    };
    let legend = scene(&data("material = \"m\"")).legend.expect("a legend");
    assert_eq!(
        (legend.material, legend.title.as_str()),
        (MaterialIndex(1), "x")
    );
    assert_eq!(
        (legend.inset.corner, legend.inset.size, legend.inset.opacity),
        (Corner::BottomRight, 0.03, 0.8)
    );
    let keys = "material = \"m\"\ntitle = \"\"\ncorner = \"top left\"\nsize = 0.1\n\
        color = [1, 0, 0]\nbackground = [0, 0, 1]\nopacity = 0";
    let legend = scene(&data(keys)).legend.expect("a legend");
    assert_eq!(
        (legend.title.as_str(), legend.inset.corner),
        ("", Corner::TopLeft)
    );
    let inset = legend.inset;
    assert_eq!((inset.size, inset.opacity), (0.1, 0.0));
    assert_eq!((inset.color, inset.background), (DVec3::X, DVec3::Z));
    for (keys, text) in [
        ("", "missing field `material`"),
        ("material = \"n\"", "unknown material \"n\""),
        (
            "material = \"m\"\ncorner = \"left\"",
            "\"left\" is not a value of corner",
        ),
        (
            "material = \"m\"\nsize = 1",
            "size is 1: it must be between 0.005 and 0.2",
        ),
        ("material = \"m\"\nopacity = -1", "opacity is -1"),
        ("material = \"m\"\ncolor = [0, 0, 2]", "must be in [0, 1]"),
    ] {
        let error = loaded(&data(keys)).expect_err(keys);
        assert!(error.contains(text), "{keys}: {error}");
    }
    let constant = with_color(
        "[1, 0, 0]",
        "[legend]\nmaterial = \"m\"\n[[disk]]\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1\n",
    );
    let error = loaded(&constant).expect_err("no data");
    assert!(error.contains("shows no data"), "{error}");
}
