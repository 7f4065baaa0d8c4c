//! `--frames` and `--orbit`: a picture for each position of the camera.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::program::{cyltrace, folder_of, words};

/// A ball beside the axis of the orbit, seen from the side of the negative y axis.
const SCENE: &str = "[film]\nwidth = 20\nheight = 16\n[axes]\n[camera]\nposition = [0, -9, 0]\n\
    look_at = [0, 0, 0]\n[[sphere]]\ncenter = [2, 0, 0]\nradius = 1\n";

fn run(folder: &Path, line: &str) -> String {
    let (code, output, error) = cyltrace(folder, &words(line));
    assert_eq!(code, 0, "{line}: {error}");
    output
}

#[test]
fn frames_are_the_pictures_of_cameras_on_a_circle() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    let folder = folder.path();
    let bytes = |name: &str| fs::read(folder.join(name)).expect("a picture");
    for (picture, options) in [("turn.png", ""), ("turn.exr", "--channels depth,ids")] {
        let line = format!("render scene.toml -o {picture} {options}");
        let turn = format!("{line} --frames 4 --orbit --json -");
        let figures: Value = serde_json::from_str(&run(folder, &turn)).expect("JSON");
        run(folder, &line);
        let frame = |number: u32| picture.replace('.', &format!("_{number:04}."));
        assert!(bytes(picture) == bytes(&frame(0)), "{picture}");
        assert!(bytes(picture) != bytes(&frame(2)), "{picture}");
        let frames = figures["frames"].as_array().expect("an array");
        for (number, stated) in (0..4).zip(frames) {
            assert_eq!(stated["output"], frame(number).as_str());
            assert_eq!(stated["degrees"], 90.0 * f64::from(number));
        }
        let rays = figures["rays"].as_object().expect("counts").values();
        let rays: u64 = rays.filter_map(Value::as_u64).sum();
        let sum: u64 = frames.iter().filter_map(|one| one["rays"].as_u64()).sum();
        assert_eq!((frames.len(), rays), (4, sum));
    }
    // A quarter of a turn counterclockwise: from the side of the positive x axis, by normals,
    // which have no noise.
    let moved = SCENE.replace("[0, -9, 0]", "[9, 0, 0]");
    fs::write(folder.join("moved.toml"), moved).expect("written");
    run(folder, "render moved.toml -o moved.png --integrator normal");
    run(
        folder,
        "render scene.toml -o arc.png --integrator normal --frames 2 --orbit=90",
    );
    assert!(bytes("moved.png") == bytes("arc_0001.png"));
}

#[test]
fn frames_that_cannot_be_are_refused() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    for (options, expected) in [
        ("--frames 4", "--orbit"),
        ("--orbit", "--frames"),
        ("--frames 4 --orbit --part 1/2", "cannot be used with"),
        ("--frames 4 --orbit --workers 2", "cannot be used with"),
        ("--frames 0 --orbit", "a whole number from 1 to 100000"),
        ("--frames 4 --orbit=0", "other than 0"),
        ("--frames 4 --orbit=nan", "other than 0"),
    ] {
        let line = format!("render scene.toml -o turn.png {options}");
        let (code, _, error) = cyltrace(folder.path(), &words(&line));
        assert!(code == 2 && error.contains(expected), "{options}: {error}");
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
}
