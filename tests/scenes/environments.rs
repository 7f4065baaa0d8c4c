//! Environments of scene files.

use std::fs;
use std::path::Path;

use cyltrace::scene::{Environment, Integrator, SceneFile, load};

use super::keys::SOLID;

/// A picture in Radiance HDR without compression: a pixel `[r, g, b, e]` is the color
/// `(r, g, b) 2^(e - 136)`.
fn radiance_hdr(width: u32, height: u32, pixels: &[[u8; 4]]) -> Vec<u8> {
    let header = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n");
    [header.as_bytes(), pixels.as_flattened()].concat()
}

fn state(folder: &Path, keys: &str) -> std::path::PathBuf {
    let path = folder.join("scene.toml");
    fs::write(&path, format!("{SOLID}[environment]\n{keys}\n")).expect("writing the scene");
    path
}

#[test]
fn environment_in_hdr_is_read_by_rows_from_the_top() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let bytes = radiance_hdr(
        2,
        2,
        &[
            [128, 0, 64, 129],
            [128, 0, 0, 130],
            [0, 0, 0, 0],
            [1, 2, 3, 136],
        ],
    );
    fs::write(folder.path().join("light.HDR"), bytes).expect("writing the picture");
    let path = state(
        folder.path(),
        "file = \"light.HDR\"\nstrength = 2.5\nrotate_degrees = 30",
    );
    let scene = load(&path).unwrap_or_else(|error| panic!("{error}"));
    let environment = scene.environment.expect("an environment");
    assert_eq!((environment.width(), environment.height()), (2, 2));
    assert_eq!(
        environment.pixels()[..],
        [
            [1.0, 0.0, 0.5],
            [2.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [1.0, 2.0, 3.0]
        ]
    );
    assert_eq!(
        (environment.strength, environment.rotate_degrees),
        (2.5, 30.0)
    );
    assert_eq!(scene.render.integrator, Integrator::Path);

    let file = SceneFile::read(&path).expect("a scene file");
    assert_eq!(file.files(), [folder.path().join("light.HDR")]);
    assert!(file.reading_bytes(1) > 4 * 12, "{}", file.reading_bytes(1));
}

#[test]
fn environment_that_cannot_be_light_is_an_error_at_its_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let exr = |name: &str, color: [f32; 3]| {
        let channels =
            exr::image::SpecificChannels::rgb(move |place: exr::math::Vec2<usize>| {
                match (place.x(), place.y()) {
                    (1, 2) => (color[0], color[1], color[2]),
                    _ => (0.5, 0.5, 0.5),
                }
            });
        let image = exr::image::Image::from_channels((4, 3), channels);
        let path = folder.path().join(name);
        exr::image::write::WritableImage::write(&image)
            .to_file(path)
            .expect("writing the picture");
    };
    exr("negative.exr", [1.0, -0.25, 0.0]);
    exr("nan.exr", [f32::NAN, 0.0, 0.0]);
    exr("good.exr", [1.0, 0.25, 0.0]);
    fs::write(folder.path().join("cut.exr"), [0x76, 0x2f, 0x31, 0x01, 2]).expect("written");
    fs::write(folder.path().join("text.hdr"), "a text").expect("written");
    let path = state(folder.path(), "file = \"good.exr\"");
    let scene = load(&path).unwrap_or_else(|error| panic!("{error}"));
    let pixels = scene.environment.as_ref().map(Environment::pixels);
    assert_eq!(pixels.expect("pixels")[9], [1.0, 0.25, 0.0]);
    for (file, text) in [
        (
            "negative.exr",
            "column 1 and row 2, counted from 0, is [1.0, -0.25, 0.0]",
        ),
        ("nan.exr", "must be finite and not negative"),
        ("cut.exr", "cannot decode"),
        ("text.hdr", "cannot decode"),
        (".", "not the name of such a picture"),
    ] {
        let path = state(folder.path(), &format!("file = \"{file}\""));
        let message = load(&path).expect_err("no environment").to_string();
        assert!(message.contains("scene.toml:6:8"), "{message}");
        assert!(message.contains(text), "{message}\nis not: {text}");
    }
}
