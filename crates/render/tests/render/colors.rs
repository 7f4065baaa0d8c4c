//! Colors of surfaces in pictures: a surface under a white sky of radiance 1 has its color.

use std::fs;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cyltrace::scene::load;
use cyltrace::tracer::{Options, Tracer, workers};
use cyltrace_output::{Film, srgb_encode};
use cyltrace_render::{Settings, render};

/// A white sky, and the z axis towards the viewer in a square of 8 x 8.
const VIEW: &str = "[film]\nwidth = 8\nheight = 8\n[sky]\ncolor = [1, 1, 1]\n\
    [camera]\ntype = \"orthographic\"\nheight = 8\nposition = [0, 0, 50]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n";

/// The picture of a scene file with tables beside it.
fn picture(text: &str, tables: &[(&str, &str)]) -> Film {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in tables {
        fs::write(folder.path().join(name), text).expect("a table");
    }
    let path = folder.path().join("scene.toml");
    fs::write(&path, format!("{VIEW}{text}")).expect("a scene file");
    let scene = load(&path).unwrap_or_else(|error| panic!("{error}"));
    let tracer = Tracer::new(Arc::new(scene), &Options::default()).expect("built");
    let settings = Settings::of(tracer.scene());
    let pool = workers(None).expect("threads");
    let picture = render(&tracer, &settings, &pool, &|_| {}, &AtomicBool::new(false));
    picture.expect("rendered").film
}

/// The sRGB codes of the pixel at a point of the x-y plane.
fn codes(film: &Film, [x, y]: [i32; 2]) -> [u8; 3] {
    let (column, row) = ((x + 4) as usize, (3 - y) as usize);
    film.pixels()[8 * row + column].map(srgb_encode)
}

/// Cylinders whose ends cover a pixel, 2 apart along x.
const CYLINDERS: &str = "x,y,z0,z1,r,order\n-2.5,0.5,-1,0,0.8,0\n-0.5,0.5,-1,0,0.8,7\n\
    1.5,0.5,-1,0,0.8,3.5\n3.5,0.5,-1,0,0.8,\n";

fn of_table(color: &str) -> String {
    format!(
        "[[material]]\nname = \"m\"\ncolor = {color}\n[[cylinder_table]]\nfile = \"t.csv\"\nmaterial = \"m\"\n\
         columns = {{ p0 = [\"x\", \"y\", \"z0\"], p1 = [\"x\", \"y\", \"z1\"], radius = \"r\" }}\n"
    )
}

#[test]
fn pixels_have_the_colors_of_the_map() {
    let color = "{ column = \"order\", map = \"viridis\", range = [0, 7], missing = [1, 0, 0] }";
    let film = picture(&of_table(color), &[("t.csv", CYLINDERS)]);
    // viridis at 0, 1 and 1/2, as matplotlib has them.
    assert_eq!(codes(&film, [-3, 0]), [0x44, 0x01, 0x54]);
    assert_eq!(codes(&film, [-1, 0]), [0xfd, 0xe7, 0x25]);
    // matplotlib takes the next of 256 colors at 1/2, a code apart at most.
    let middle = codes(&film, [1, 0]);
    let apart = middle
        .iter()
        .zip([0x21, 0x91, 0x8c])
        .map(|(code, known)| code.abs_diff(known));
    assert!(apart.max() <= Some(1), "{middle:?}");
    assert_eq!(codes(&film, [3, 0]), [255, 0, 0]);
}

/// A value of the solid itself comes before that of the innermost placement, and that before
/// outer ones.
#[test]
fn placements_give_values_to_solids_without_one() {
    let text = "[[material]]\nname = \"m\"\ncolor = { column = \"part\", map = \"tab10\" }\n\
        [[prototype]]\nname = \"inner\"\n\
        [[prototype.disk]]\ncenter = [0.5, 0.5, 0]\nnormal = [0, 0, 1]\nradius = 0.8\nmaterial = \"m\"\n\
        [[prototype.disk]]\ncenter = [0.5, 2.5, 0]\nnormal = [0, 0, 1]\nradius = 0.8\nmaterial = \"m\"\nvalues = { part = 5 }\n\
        [[prototype]]\nname = \"outer\"\n\
        [[prototype.instance]]\nof = \"inner\"\n\
        [[prototype.instance]]\nof = \"inner\"\ntranslate = [2, 0, 0]\nvalues = { part = 3 }\n\
        [[instance_table]]\nof = \"outer\"\nfile = \"p.csv\"\ncolumns = { position = [\"x\", \"y\", \"z\"] }\n";
    let film = picture(
        text,
        &[("p.csv", "x,y,z,part\n-4,0,0,1\n0,0,0,2\n0,-4,0,\n")],
    );
    const TAB10: [[u8; 3]; 6] = [
        [0x1f, 0x77, 0xb4],
        [0xff, 0x7f, 0x0e],
        [0x2c, 0xa0, 0x2c],
        [0xd6, 0x27, 0x28],
        [0x94, 0x67, 0xbd],
        [0x8c, 0x56, 0x4b],
    ];
    assert_eq!(codes(&film, [-4, 0]), TAB10[1], "the outer placement");
    assert_eq!(codes(&film, [0, 0]), TAB10[2], "the outer placement");
    assert_eq!(codes(&film, [-2, 0]), TAB10[3], "the inner placement");
    assert_eq!(codes(&film, [2, 0]), TAB10[3], "the inner placement");
    assert_eq!(codes(&film, [0, 2]), TAB10[5], "the solid");
    assert_eq!(codes(&film, [2, 2]), TAB10[5], "the solid");
    assert_eq!(codes(&film, [0, -4]), [188; 3], "no value");
}

/// On the upper face of a cuboid, `u` and `v` are the positions along x and y.
#[test]
fn patterns_follow_the_parameters_of_the_surface() {
    let face = |color: &str| {
        let text = format!(
            "[[material]]\nname = \"m\"\ncolor = {color}\n[[cuboid]]\ncenter = [0, 0, -1]\n\
             half_widths = [4, 4, 1]\nmaterial = \"m\"\n"
        );
        picture(&text, &[])
    };
    let stripes = face("{ stripes = [[1, 0, 0], [0, 0, 1]], count = 8, along = \"u\" }");
    let checker = face("{ checker = [[1, 0, 0], [0, 0, 1]], count = [8, 8] }");
    for x in -4..4 {
        for y in -4..4 {
            let alternate = |number: i32| match number.rem_euclid(2) {
                0 => [255, 0, 0],
                _ => [0, 0, 255],
            };
            let place = [x, y];
            assert_eq!(codes(&checker, place), alternate(x + y), "{x} {y}");
            let (along, across) = (codes(&stripes, place), codes(&stripes, [x, -1 - y]));
            assert_eq!(along, across, "{x} {y}");
            assert_eq!(codes(&stripes, [x, 0]), alternate(x), "{x} {y}");
        }
    }
}
