//! Scenes with colors of all kinds, and the values that they show, are saved as the same.

use std::fs::File;

use cyltrace::math::Random;
use cyltrace::scene::{
    Axes, Clip, Color, ColorMap, Corner, DataColor, DepthCue, Illustration, Inset, Legend, Listed,
    MaterialIndex, Outlines, PlacementValues, Prototype, ScaleBar, Scene, SolidList, ValueList,
    load,
};
use cyltrace::solid::SolidKind;
use cyltrace::with_solid_kind;
use glam::DVec3;

use super::random_scene::random_scene;
use super::{assert_same, saved};

fn data(column: &str, map: &str, range: [f64; 2], labels: &[&str]) -> Color {
    Color::Data(DataColor {
        column: column.to_owned(),
        map: ColorMap::named(map).expect("a map"),
        range,
        labels: labels.iter().map(|&label| label.to_owned()).collect(),
        missing: DVec3::new(1.0 / 3.0, 0.0, 1.0),
    })
}

/// The numbers and materials of all solids of a prototype.
fn solids(prototype: &Prototype) -> Vec<(u32, u16)> {
    let mut all = Vec::new();
    for &kind in SolidKind::LISTS {
        with_solid_kind!(kind, S => {
            let list = S::list(&prototype.solids);
            all.extend((0..list.len()).map(|at| (list.primitive(at), list.material(at).0)));
        });
    }
    all.sort_unstable();
    all
}

/// A random scene, two of whose materials show values of solids or placements.
fn with_values(seed: u64) -> Scene {
    let mut scene = random_scene(seed);
    // Columns with names of the tables' own columns, and with delimiters.
    scene.materials[1].color = data("radius", "rdylbu", [-1.0 / 3.0, 1e9], &[]);
    let labels = ["a \"label\"", "b\nc"];
    scene.legend = Some(Legend {
        material: MaterialIndex(1),
        title: "a \"title\"\nü".to_owned(),
        inset: inset([Corner::TopLeft, Corner::BottomRight][seed as usize % 2]),
    });
    let material = [None, Some(MaterialIndex(3))][seed as usize % 2];
    scene.clips = vec![Clip {
        point: DVec3::new(0.1, -1e40, 1.0 / 3.0),
        normal: DVec3::new(1.0, 2.0, -3.0).normalize(),
        material: material.filter(|_| scene.materials.len() > 3),
        casts_shadows: seed.is_multiple_of(3),
    }];
    scene.illustration = illustration(seed);
    scene.materials[2].color = data("x, y; z's", "tab10", [0.0, 1.0], &labels);
    let mut random = Random::new(seed, 2);
    for prototype in &mut scene.prototypes {
        let mut solid_values = ValueList::default();
        for (number, material) in solids(prototype) {
            match material {
                1 if random.below(4) > 0 => {
                    solid_values.push(number, random.uniform(-1e9, 1e9) as f32);
                }
                2 => solid_values.push(number, random.below(1 << 24) as f32),
                _ => {}
            }
        }
        prototype.solid_values = solid_values;
        for (column, share) in [("radius", 2), ("x, y; z's", 10)] {
            let mut values = ValueList::default();
            for number in 0..prototype.placements.len() as u32 {
                if random.below(share) == 0 {
                    values.push(number, random.below(1000) as f32);
                }
            }
            if !values.is_empty() {
                let column = column.to_owned();
                prototype
                    .placement_values
                    .push(PlacementValues { column, values });
            }
        }
    }
    scene
}

fn inset(corner: Corner) -> Inset {
    Inset {
        corner,
        size: 0.1 / 3.0,
        color: DVec3::X,
        background: DVec3::splat(1.0 / 3.0),
        opacity: 0.1,
    }
}

/// An illustration with all parts or some, and with all keys or some.
fn illustration(seed: u64) -> Illustration {
    let stated = |number: f64| (!seed.is_multiple_of(3)).then_some(number);
    let scale_bar = ScaleBar {
        length: stated(1.0 / 3.0),
        unit: "\"µm\"".to_owned(),
        inset: inset(Corner::TopRight),
    };
    let axes = Axes {
        labels: seed.is_multiple_of(2),
        inset: inset(Corner::BottomLeft),
    };
    let outlines = Outlines {
        width: 1.0 / 3.0,
        color: DVec3::splat(0.1),
        crease_degrees: 180.0,
        between_solids: !seed.is_multiple_of(2),
    };
    let depth_cue = DepthCue {
        color: stated(0.1).map(DVec3::splat),
        start: stated(1e-3),
        end: stated(1e9 / 3.0),
        strength: 1.0,
    };
    let is_stated = |part: u64| seed & part == 0;
    Illustration {
        scale_bar: is_stated(1).then_some(scale_bar),
        axes: is_stated(2).then_some(axes),
        outlines: is_stated(4).then_some(outlines),
        depth_cue: is_stated(8).then_some(depth_cue),
    }
}

#[test]
fn random_values_saved_are_the_same() {
    for seed in 0..30 {
        let scene = with_values(seed);
        assert_same(&scene, &saved(&scene), &format!("seed {seed}"));
    }
}

#[test]
fn patterns_and_images_saved_are_the_same() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, depth) in [
        ("8.png", png::BitDepth::Eight),
        ("16.png", png::BitDepth::Sixteen),
    ] {
        let file = File::create(folder.path().join(name)).expect("a file");
        let mut encoder = png::Encoder::new(file, 3, 2);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(depth);
        let bytes: Vec<u8> = (7..7 + 18 * (1 + u8::from(name == "16.png"))).collect();
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&bytes).expect("pixels");
    }
    let text = "[[material]]\nname = \"a\"\ncolor = { image = \"8.png\" }\n\
        [[material]]\nname = \"b\"\ncolor = { image = \"16.png\" }\n\
        [[material]]\nname = \"c\"\ncolor = { checker = [[0.1, 0, 1], [0, 0.3, 0]], count = [3, 5] }\n\
        [[material]]\nname = \"d\"\ncolor = { stripes = [[0.1, 0, 1], [0, 0.3, 0]], along = \"u\" }\n\
        [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, text).expect("a scene file");
    let scene = load(&path).expect("a scene");
    assert_eq!(scene.images_bytes(), 3 * 6 + 6 * 6);
    assert_eq!(scene.contents()[0].values_bytes, 3 * 6 + 6 * 6);
    assert_same(&scene, &saved(&scene), "patterns and images");
}
