//! `--denoise`, with the library or without.

use serde_json::Value;

use crate::channels::{channels, run};
use crate::program::{cyltrace, folder_of, words};

const SCENE: &str = "[film]\nwidth = 40\nheight = 30\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
                     [[sphere]]\ncenter = [0.5, 0.5, 1]\nradius = 0.5\n";

/// Without the library nothing is rendered, and the message says what is missing. With it, the
/// picture has other colors, the channels that were requested, and their values of before.
#[test]
fn noise_is_removed_where_the_library_is_installed() {
    let folder = folder_of(&[("scene.toml", SCENE)]);
    let folder = folder.path();
    let line = "render scene.toml -o clean.exr --spp 4 --integrator ao --channels depth,albedo \
                --denoise --json clean.json";
    let (code, output, error) = cyltrace(folder, &words(line));
    if code != 0 {
        assert_eq!(code, 2, "{output}{error}");
        assert!(
            error.contains("Open Image Denoise 2 cannot be loaded"),
            "{error}"
        );
        assert!(error.contains("LD_LIBRARY_PATH"), "{error}");
        assert_eq!(error.matches("cannot open").count(), 1, "{error}");
        assert!(!folder.join("clean.exr").exists());
        eprintln!("skipped: {error}");
        return;
    }
    assert!(output.contains("denoise"), "{output}");
    run(
        folder,
        "render scene.toml -o noisy.exr --spp 4 --integrator ao --channels depth,albedo",
    );
    let [clean, noisy] = ["clean.exr", "noisy.exr"].map(|name| channels(&folder.join(name)));
    assert!(clean.keys().eq(noisy.keys()), "{:?}", clean.keys());
    for (name, values) in &noisy {
        let is_color = ["R", "G", "B"].contains(&name.as_str());
        assert_eq!(clean[name] != *values, is_color, "{name}");
    }
    let json = std::fs::read(folder.join("clean.json")).expect("figures");
    let json: Value = serde_json::from_slice(&json).expect("JSON");
    assert!(json["denoise_s"].as_f64().expect("seconds") > 0.0);
    assert_eq!(json["channels"].as_array().expect("names").len(), 4);
}
