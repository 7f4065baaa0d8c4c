//! `info` names the outliers of a scene, with the files and rows that they come from.

use crate::program;

use std::fmt::Write;
use std::fs;

use program::{cyltrace, folder_of};
use serde_json::{Value, json};

const SCENE: &str = r#"
[[cylinder_table]]
file = "twigs.csv"
columns = { p0 = ["x", "y", "z"], p1 = ["x1", "y1", "z1"], radius = "r" }

[[prototype]]
name = "leaf"
[[prototype.sphere]]
center = [0, 0, 0]
radius = 0.01

[[prototype]]
name = "grove"
[[prototype.instance_table]]
of = "leaf"
file = "places.csv"
columns = { position = ["x", "y", "z"] }

[[instance]]
of = "grove"
translate = [500000, 5000000, 0]
"#;

/// Sixty-four points of a grid of a metre, moved.
fn grid(offset: [f64; 2]) -> impl Iterator<Item = [f64; 3]> {
    let [x, y] = offset;
    let at = |number: u32, step: u32| f64::from(number / step % 4) / 3.0;
    (0..64).map(move |number| [x + at(number, 16), y + at(number, 4), at(number, 1)])
}

#[test]
fn outliers_have_their_files_and_rows() {
    // The third row is of zeros, the others are UTM coordinates.
    let mut twigs = String::from("x,y,z,x1,y1,z1,r\n");
    for (number, [x, y, z]) in grid([500_000.0, 5_000_000.0]).enumerate() {
        if number == 2 {
            twigs += "0,0,0,0,0,0.1,0.001\n";
        }
        writeln!(twigs, "{x},{y},{z},{x},{y},{},0.001", z + 0.1).unwrap();
    }
    let mut places = String::from("x,y,z\n");
    for [x, y, z] in grid([0.0, 0.0]).chain([[7e6, 0.0, 0.0]]) {
        writeln!(places, "{x},{y},{z}").unwrap();
    }
    let directory = folder_of(&[
        ("scene.toml", SCENE),
        ("twigs.csv", twigs.as_str()),
        ("places.csv", places.as_str()),
    ]);
    let arguments = ["info", "scene.toml", "--json", "info.json"];
    let (_, out, error) = cyltrace(directory.path(), &arguments);
    println!("{out}{error}");
    assert!(
        out.contains("outlier: cylinder 2 (row 3 of twigs.csv) is "),
        "{out}"
    );
    let place = "outlier: placement 64 of prototype \"grove\" (row 65 of places.csv) is ";
    assert!(out.contains(place), "{out}");
    assert_eq!(out.matches("outlier").count(), 2, "{out}");

    let text = fs::read_to_string(directory.path().join("info.json")).unwrap();
    let figures: Value = serde_json::from_str(&text).unwrap();
    let outliers = figures["outliers"].as_array().unwrap();
    let stated = |number: usize| {
        let one = &outliers[number];
        ["prototype", "kind", "number", "file", "row"].map(|key| one[key].clone())
    };
    assert_eq!(
        stated(0),
        [
            json!("grove"),
            json!("placement"),
            json!(64),
            json!("places.csv"),
            json!(65)
        ]
    );
    assert_eq!(
        stated(1),
        [
            json!(""),
            json!("cylinder"),
            json!(2),
            json!("twigs.csv"),
            json!(3)
        ]
    );
    // 5 025 km from a metre's cube, whose half diagonal is nearly 0.9 m.
    let distance = outliers[1]["distance"].as_f64().unwrap();
    assert!((5e6..7e6).contains(&distance), "{distance}");
}
