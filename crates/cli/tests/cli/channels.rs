//! Channels and opacity: what they contain, in whole pictures and from parts.

use std::collections::BTreeMap;
use std::path::Path;

use exr::image::FlatSamples;
use exr::image::read::read_first_flat_layer_from_file;
use serde_json::Value;

use crate::program::{cyltrace, folder_of, words};

/// Seen from above: instances of instances, two materials, misses at the rim. 32 x 24 units for
/// as many pixels, so that the ray of pixel (x, y) begins at (x - 15.5, 11.5 - y, 50).
const SCENE: &str = r#"
[camera]
type = "orthographic"
position = [0, 0, 50]
look_at = [0, 0, 0]
up = [0, 1, 0]
height = 24
[film]
width = 32
height = 24

[[material]]
name = "unused"
color = [0.1, 0.1, 0.1]
[[material]]
name = "red"
color = [0.75, 0.25, 0.125]

[[sphere]]
center = [-8, 0, 0]
radius = 5.3
material = "red"
[[instance]]
of = "pair"
translate = [5, 0, 0]
[[prototype]]
name = "pair"
[[prototype.instance]]
of = "rod"
translate = [0, 3, 0]
[[prototype.instance]]
of = "rod"
translate = [0, -3, 1]
[[prototype]]
name = "rod"
[[prototype.cylinder]]
p0 = [-6, 0, 0]
p1 = [6, 1, 0.5]
radius = 1.7
"#;

const ALL: &str = "depth,position,normal,albedo,uv,ids,variance,samples";

pub fn run(folder: &Path, line: &str) -> String {
    let (code, output, error) = cyltrace(folder, &words(line));
    assert_eq!(code, 0, "{line}: {output}{error}");
    output
}

/// The numbers of each channel of an EXR.
pub fn channels(path: &Path) -> BTreeMap<String, Vec<f64>> {
    let read = read_first_flat_layer_from_file(path).expect("an EXR");
    let list = read.layer_data.channel_data.list.into_iter();
    let numbers = |samples| match samples {
        FlatSamples::F32(values) => values.into_iter().map(f64::from).collect(),
        FlatSamples::U32(values) => values.into_iter().map(f64::from).collect(),
        FlatSamples::F16(_) => panic!("16 bits"),
    };
    list.map(|one| (one.name.to_string(), numbers(one.sample_data)))
        .collect()
}

/// `trace` is another path from a ray to its numbers.
#[test]
fn channels_are_the_columns_of_trace_for_the_middle_ray() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    let folder = folder.path();
    run(
        folder,
        &format!("render scene.toml -o a.exr --spp 1 --channels {ALL} -q"),
    );
    let found = channels(&folder.join("a.exr"));
    let mut rays = String::from("ox,oy,oz,dx,dy,dz\n");
    for (y, x) in (0..24).flat_map(|y| (0..32).map(move |x| (y, x))) {
        let (x, y) = (f64::from(x) - 15.5, 11.5 - f64::from(y));
        rays += &format!("{x},{y},50,0,0,-1\n");
    }
    std::fs::write(folder.join("rays.csv"), rays).expect("written");
    run(folder, "trace scene.toml --rays rays.csv -o hits.csv -q");
    let table = csv::Reader::from_path(folder.join("hits.csv"));
    let mut table = table.expect("a table");
    let header = table.headers().expect("a header").clone();
    let (mut hits, mut paths) = (0, std::collections::BTreeSet::new());
    for (pixel, row) in table.records().enumerate() {
        let row = row.expect("a row");
        let cell = |name: &str| {
            let place = header.iter().position(|one| one == name);
            &row[place.expect("a column")]
        };
        let is_hit = cell("hit") == "1";
        let number = |name: &str| match is_hit {
            true => f64::from(cell(name).parse::<f64>().expect("a number") as f32),
            false => 0.0,
        };
        let channel = |name: &str| found[name][pixel];
        for (name, column) in [
            ("P.X", "x"),
            ("P.Y", "y"),
            ("P.Z", "z"),
            ("N.X", "nx"),
            ("N.Y", "ny"),
            ("N.Z", "nz"),
            ("u", "u"),
            ("v", "v"),
        ] {
            assert_eq!(channel(name), number(column), "pixel {pixel}: {name}");
        }
        let none = f64::from(u32::MAX);
        let ids = ["Id.Primitive", "Id.Prototype", "Id.Instance", "Id.Material"].map(channel);
        if is_hit {
            hits += 1;
            assert_eq!(channel("Z"), number("t"), "pixel {pixel}");
            let (prototype, material) = match cell("prototype") {
                "" => (0.0, 2.0),
                "rod" => (2.0, 0.0),
                other => panic!("{other}"),
            };
            let outermost = cell("instance").split('/').next().expect("a part");
            let instance = outermost.parse().unwrap_or(none);
            assert_eq!(ids, [number("primitive"), prototype, instance, material]);
            let albedo = if material == 2.0 {
                [0.75, 0.25, 0.125]
            } else {
                [0.5; 3]
            };
            let names = ["Albedo.R", "Albedo.G", "Albedo.B"];
            assert_eq!(names.map(channel), albedo, "pixel {pixel}");
            paths.insert((cell("instance").to_owned(), channel("Id.Path") as u32));
        } else {
            assert_eq!((channel("Z"), ids), (f64::INFINITY, [none; 4]));
            assert_eq!((channel("Albedo.R"), channel("Id.Path")), (0.0, none));
        }
        assert_eq!((channel("Samples"), channel("Variance.G")), (1.0, 0.0));
    }
    assert!((100..600).contains(&hits), "{hits} hits");
    // One hash for each path: the root, and two rods.
    assert_eq!(paths.len(), 3, "{paths:?}");
}

#[test]
fn colors_and_requested_channels_do_not_depend_on_other_channels() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    let folder = folder.path();
    run(folder, "render scene.toml -o plain.exr --spp 3 -q");
    run(
        folder,
        &format!("render scene.toml -o all.exr --spp 3 --channels {ALL} -q"),
    );
    let all = channels(&folder.join("all.exr"));
    let plain = channels(&folder.join("plain.exr"));
    assert_eq!(plain.keys().collect::<Vec<_>>(), ["B", "G", "R"]);
    for (name, values) in plain {
        assert!(all[&name] == values, "{name}");
    }
    run(
        folder,
        "render scene.toml -o some.exr --spp 3 --channels ids,depth -q",
    );
    let some = channels(&folder.join("some.exr"));
    assert_eq!(some.len(), 3 + 6);
    for (name, values) in some {
        assert!(all[&name] == values, "{name}");
    }
}

/// The variance of samples that are 0 or 1 follows from their mean.
#[test]
fn variance_is_that_of_the_samples() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    let folder = folder.path();
    run(
        folder,
        "render scene.toml -o a.exr --integrator ao --spp 8 --channels variance,samples -q",
    );
    let found = channels(&folder.join("a.exr"));
    let mut least = f64::INFINITY;
    for (mean, variance) in found["R"].iter().zip(&found["Variance.R"]) {
        let expected = mean * (1.0 - mean) * 8.0 / 7.0;
        assert!((variance - expected).abs() < 1e-6, "{mean}: {variance}");
        least = least.min(*mean);
    }
    assert!(least < 0.9, "some pixels have variance");
    assert!(found["Samples"].iter().all(|&samples| samples == 8.0));
}

/// Samples of `normal` that miss are black, so its opaque colors are the ones with opacity.
#[test]
fn transparent_background_gives_the_part_of_the_samples_that_hit() {
    let clear = format!("background = \"transparent\"\n{SCENE}");
    let folder = folder_of(&[("opaque.toml", SCENE), ("scene.toml", clear.as_str())]);
    let folder = folder.path();
    let line = "--integrator normal --spp 16 -q";
    run(folder, &format!("render opaque.toml -o opaque.exr {line}"));
    run(folder, &format!("render scene.toml -o clear.exr {line}"));
    run(folder, &format!("render scene.toml -o clear.png {line}"));
    let opaque = channels(&folder.join("opaque.exr"));
    let found = channels(&folder.join("clear.exr"));
    for name in ["R", "G", "B"] {
        assert!(found[name] == opaque[name], "{name}");
    }
    let opacity = &found["A"];
    let sixteenths = opacity.iter().map(|value| value * 16.0);
    assert!(sixteenths.clone().all(|value| value.fract() == 0.0));
    let partly = sixteenths
        .filter(|value| (1.0..16.0).contains(value))
        .count();
    assert!(partly > 20 && opacity.contains(&0.0) && opacity.contains(&1.0));
    let png = image::open(folder.join("clear.png"))
        .expect("a PNG")
        .into_rgba8();
    for (pixel, opacity) in png.pixels().zip(opacity) {
        assert_eq!(f64::from(pixel.0[3]), (opacity * 255.0 + 0.5).floor());
    }

    // The sky is behind the scene, and is not in the picture.
    let sky = format!("{clear}\n[sky]\n");
    std::fs::write(folder.join("scene.toml"), sky).expect("written");
    run(folder, "render scene.toml -o sky.exr -q");
    let found = channels(&folder.join("sky.exr"));
    assert_eq!((found["A"][0], found["B"][0]), (0.0, 0.0));
}

#[test]
fn channels_opacity_and_error_from_parts_and_workers_have_the_bytes_of_one_process() {
    let clear = format!("background = \"transparent\"\n{SCENE}");
    let folder = folder_of(&[("scene.toml", clear)]);
    let folder = folder.path();
    let size = "render scene.toml --size 75x50";
    for (options, name) in [
        (format!("--spp 3 --channels {ALL}"), "a.exr"),
        (format!("--error 0.2 --spp 64 --channels {ALL}"), "a.exr"),
        (
            "--error 0.2 --spp 64 --exposure 1 --tonemap agx".to_owned(),
            "a.png",
        ),
    ] {
        let line = format!("{size} {options}");
        run(folder, &format!("{line} -o {name} --threads 1 -q"));
        let whole = std::fs::read(folder.join(name)).expect("a picture");
        let same = |what: &str| {
            let made = std::fs::read(folder.join(name)).expect("a picture");
            assert!(made == whole, "{line}: {what}");
        };
        run(folder, &format!("{line} -o {name} --threads 3 -q"));
        same("threads");
        for part in 1..=7 {
            run(folder, &format!("{line} --part {part}/7 -o part{part} -q"));
        }
        let parts: Vec<_> = (1..=7).map(|part| format!("part{part}")).collect();
        run(folder, &format!("merge {} -o {name} -q", parts.join(" ")));
        same("parts");
        for part in parts {
            std::fs::remove_file(folder.join(part)).expect("removed");
        }
        run(
            folder,
            &format!("{line} --workers 2 --parts 5 -o {name} -q"),
        );
        same("workers");
    }
}

#[test]
fn error_that_is_reached_is_in_the_json_of_every_way_to_render() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    let folder = folder.path();
    let line = "render scene.toml --error 0.1 --json - -o a.png";
    let reached = |line: &str| {
        let figures: Value = serde_json::from_str(&run(folder, line)).expect("JSON");
        figures["reached"].clone()
    };
    let whole = reached(line);
    let error = whole["error"].as_f64().expect("a number");
    assert!(error > 0.0 && error < 0.2, "{error}");
    let samples = whole["samples"].as_u64().expect("a number");
    assert!(
        (32 * 24 * 8..32 * 24 * 16384).contains(&samples),
        "{samples}"
    );
    assert_eq!(reached(&format!("{line} --workers 2")), whole);
    run(folder, "render scene.toml --error 0.1 --part 1/2 -o one -q");
    run(folder, "render scene.toml --error 0.1 --part 2/2 -o two -q");
    assert_eq!(reached("merge one two -o a.png --json -"), whole);
    let text = run(folder, "render scene.toml --error 0.1 -o a.png");
    assert!(
        text.contains("samples per pixel") && text.contains("error: "),
        "{text}"
    );
}

#[test]
fn time_ends_a_rendering_that_would_go_on() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    let line = "render scene.toml --time 0.2 --spp 1048576 --json - -o a.png";
    let figures: Value = serde_json::from_str(&run(folder.path(), line)).expect("JSON");
    let samples = figures["reached"]["samples"].as_u64().expect("a number");
    assert!(samples >= 32 * 24 * 8, "{samples}");
    assert!(figures["reached"]["error"].as_f64().expect("a number") > 0.0);
}

#[test]
fn options_of_a_picture_that_do_not_fit_are_refused() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    for (options, expected) in [
        ("--channels depth -o a.png", "a PNG cannot have channels"),
        ("--channels deep -o a.exr", "'deep'"),
        ("--tonemap agx -o a.exr", "of a .png"),
        ("--exposure 1 -o a.exr", "of a .png"),
        ("--exposure 1e9 -o a.png", "from -64 to 64"),
        ("--tonemap filmic -o a.png", "pbr-neutral"),
        ("--error 0 -o a.png", "above 0"),
        ("--error -1 -o a.png", "above 0"),
        ("--error 0.1 --spp 1 -o a.png", "allow at least 2"),
        ("--time 0 -o a.png", "above 0"),
        ("--time 1 --part 1/2 -o a", "cannot be used with"),
        ("--time 1 --workers 2 -o a.png", "cannot be used with"),
    ] {
        let line = format!("render scene.toml {options}");
        let (code, _, error) = cyltrace(folder.path(), &words(&line));
        assert!(code == 2 && error.contains(expected), "{options}: {error}");
    }
}

/// Exposure and tone maps would change the colors of a legend. Normals and occlusion have none.
#[test]
fn legends_keep_their_colors_or_are_refused() {
    let scene = "[film]\nwidth = 40\nheight = 30\n[legend]\nmaterial = \"m\"\n\
        [[material]]\nname = \"m\"\ncolor = { column = \"r\" }\n\
        [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\nvalues = { r = 2 }\n";
    let bare = scene.replace("[legend]\nmaterial = \"m\"\n", "");
    let folder = folder_of(&[("scene.toml", scene), ("bare.toml", &bare)]);
    for option in ["--exposure 1", "--tonemap agx"] {
        let line = format!("render scene.toml -o a.png {option}");
        let (code, _, error) = cyltrace(folder.path(), &words(&line));
        assert_eq!(code, 2, "{error}");
        assert!(error.contains("has a [legend]"), "{error}");
        assert!(!folder.path().join("a.png").exists());
    }
    let picture = |name: &str, options: &str| {
        run(folder.path(), &format!("render {name} -o a.png {options}"));
        std::fs::read(folder.path().join("a.png")).expect("a picture")
    };
    assert_ne!(picture("scene.toml", ""), picture("bare.toml", ""));
    for integrator in ["ao", "normal"] {
        let options = format!("--integrator {integrator} --exposure 1");
        let (with, without) = (
            picture("scene.toml", &options),
            picture("bare.toml", &options),
        );
        assert!(with == without, "{integrator}");
    }
}
