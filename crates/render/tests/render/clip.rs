//! Clip planes: against set operations, which are other code, and closed forms.

use std::f64::consts::PI;
use std::fs;

use cyltrace::scene::{
    self, Background, Clip, Integrator, MaterialIndex, MaterialKind, Scene, Sky, SolidRecord, Sun,
};
use cyltrace::solid::{AnySolid, Sphere};
use cyltrace_output::Film;
use cyltrace_render::{ChannelGroup, Channels};
use glam::DVec3;

use super::illustration::{outlines, rendered};
use super::stage::{self, assert_all_pixels, mean, picture};

const VIEW: &str = r#"
background = [0.1, 0.2, 0.3]
[camera]
position = [5, -6, 7]
look_at = [0.3, 0, 0]
fov_degrees = 40
[film]
width = 48
height = 48
[sun]
direction = [1, -0.4, 1.2]
angle_degrees = 0
color = [1, 1, 1]
strength = 3
[sky]
color = [0.6, 0.8, 1]
"#;

/// Solids of all kinds with an inside, by their keys.
const SOLIDS: [(&str, &str); 6] = [
    (
        "cuboid",
        "center = [0, 0, -1.6], half_widths = [3, 3, 0.25]",
    ),
    ("sphere", "center = [-1, -1, 0], radius = 1.1"),
    (
        "cylinder",
        "p0 = [-1.5, 0.5, -1], p1 = [1.2, 1.6, 1.5], radius = 0.5",
    ),
    (
        "cone",
        "p0 = [1.2, -1, -1], p1 = [1.2, -1, 2], radius0 = 0.9, radius1 = 0.1",
    ),
    (
        "rounded_cone",
        "p0 = [-2, 1.8, 0], p1 = [1, 1.8, 0.3], radius0 = 0.3, radius1 = 0.6",
    ),
    // Overlaps the sphere.
    (
        "cuboid",
        "center = [-0.2, -1, 0.4], half_widths = [0.5, 0.4, 1]",
    ),
];

/// Loads a scene from text, after that of the view.
fn load(text: &str) -> Scene {
    load_text(&format!("{VIEW}{text}"))
}

fn load_text(text: &str) -> Scene {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).expect("a scene file");
    scene::load(&path).expect("a scene")
}

/// The solids below z = 0.2 and before x = 1.1, by planes and by intersections with a cuboid.
fn by_planes_and_by_operations(solids: &[(&str, &str)], shadows: bool) -> [Scene; 2] {
    let keys = |keys: &str| keys.replace("], ", "]\n").replace(", radius", "\nradius");
    let mut planes = format!(
        "[[clip]]\npoint = [9, 9, 0.2]\nnormal = [0, 0, 3]\nshadows = {shadows}\n\
         [[clip]]\npoint = [1.1, 0, 0]\nnormal = [1, 0, 0]\nshadows = {shadows}\n"
    );
    let mut operations = String::new();
    for (kind, list) in solids {
        planes += &format!("[[{kind}]]\n{}\n", keys(list));
        operations += &format!(
            "[[intersection]]\nof = [{{ {kind} = {{ {list} }} }}, {{ cuboid = {{ center = \
             [-98.9, 0, -99.8], half_widths = [100, 100, 100] }} }}]\n"
        );
    }
    [load(&planes), load(&operations)]
}

fn greatest_difference(one: &Film, other: &Film) -> f32 {
    let pixels = one.pixels().as_flattened().iter();
    let pairs = pixels.zip(other.pixels().as_flattened());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// What removes a part for all rays is an intersection with a cuboid.
#[test]
fn cuts_are_those_of_intersections() {
    let scenes = by_planes_and_by_operations(&SOLIDS, false);
    for integrator in Integrator::ALL {
        let [planes, operations] = scenes.clone().map(|mut scene| {
            scene.render.integrator = integrator;
            stage::film_of(scene, 4)
        });
        let apart = greatest_difference(&planes, &operations);
        assert!(apart < 1e-5, "{integrator:?}: {apart}");
    }
}

/// Planes that keep the shadows leave the same surfaces, and other light.
#[test]
fn planes_with_shadows_change_light_alone() {
    let [mut planes, mut operations] = by_planes_and_by_operations(&SOLIDS, true);
    for scene in [&mut planes, &mut operations] {
        scene.render.integrator = Integrator::Normal;
    }
    let normals = [&planes, &operations].map(|scene| stage::film_of(scene.clone(), 4));
    assert!(greatest_difference(&normals[0], &normals[1]) < 1e-5);
    for scene in [&mut planes, &mut operations] {
        scene.render.integrator = Integrator::Sun;
    }
    let light = [planes, operations].map(|scene| stage::film_of(scene, 4));
    assert!(greatest_difference(&light[0], &light[1]) > 0.1);
    assert!(mean(&light[0]).element_sum() < mean(&light[1]).element_sum());
}

/// A block that is cut at half its height, under a roof that is removed.
fn block_under_a_roof(casts_shadows: bool, height: f64) -> Film {
    let block = |z: f64, top: f64| {
        (
            DVec3::new(0.0, 0.0, z),
            DVec3::new(0.0, 0.0, top),
            50.0,
            cyltrace::solid::Caps::Both,
        )
    };
    let mut scene = stage::scene(&[block(-1.0, height), block(2.0, 3.0)]);
    scene.sun = Some(Sun {
        angle_degrees: 0.0,
        ..sun()
    });
    scene.render.integrator = Integrator::Sun;
    scene.clips = vec![Clip {
        point: DVec3::ZERO,
        normal: DVec3::Z,
        material: None,
        casts_shadows,
    }];
    picture(scene, 1)
}

fn sun() -> Sun {
    Sun {
        direction: DVec3::new(0.6, 0.0, 0.8),
        color: DVec3::ONE,
        strength: 2.0,
        angle_degrees: 0.0,
    }
}

/// The light of the sun on the material of the stage.
fn sunlit() -> DVec3 {
    DVec3::new(0.5, 0.25, 1.0) * 2.0 * 0.8 / PI
}

#[test]
fn cut_faces_are_lit_and_other_surfaces_keep_shadows_if_requested() {
    for casts_shadows in [false, true] {
        assert_all_pixels(&block_under_a_roof(casts_shadows, 1.0), sunlit());
    }
    assert_all_pixels(&block_under_a_roof(false, -0.5), sunlit());
    assert_all_pixels(&block_under_a_roof(true, -0.5), DVec3::ZERO);
}

/// A tube that is cut along its axis shows its inside, a rod a face.
#[test]
fn tubes_stay_open_where_they_are_cut() {
    let up = |caps| {
        let along = (DVec3::NEG_X * 60.0, DVec3::X * 60.0, 20.0, caps);
        let mut scene = stage::scene(&[along]);
        scene.render.integrator = Integrator::Normal;
        scene.clips = vec![Clip {
            point: DVec3::ZERO,
            normal: DVec3::Z,
            material: None,
            casts_shadows: true,
        }];
        picture(scene, 1)
    };
    let color = |normal: DVec3| 0.5 * normal + 0.5;
    assert_all_pixels(&up(cyltrace::solid::Caps::Both), color(DVec3::Z));
    let inside = up(cyltrace::solid::Caps::None);
    // The picture is 2 wide, so that the wall's normals there are within 1/20 of -z.
    let apart = (mean(&inside) - color(DVec3::NEG_Z)).abs().max_element();
    assert!(apart < 1e-3, "{:?}", mean(&inside));
}

/// A cut ball of glass without color vanishes in a sky that is the same everywhere, if what is
/// removed is removed for all rays. Otherwise paths from the cut face would be caught by total
/// reflection in the ball, which is still round for them.
#[test]
fn cut_glass_loses_no_light() {
    let radiance = DVec3::new(0.5, 0.75, 1.0);
    let mut scene = stage::scene(&[]);
    scene.background = Background::Color(DVec3::ZERO);
    scene.sky = Some(Sky {
        color: radiance,
        strength: 1.0,
    });
    scene.render.integrator = Integrator::Path;
    scene.render.max_depth = 200;
    scene.materials[0].kind = MaterialKind::Glass {
        roughness: 0.0,
        ior: 1.5,
    };
    scene.materials[0].color = scene::Color::Constant(DVec3::ONE);
    let ball: AnySolid = Sphere::new(DVec3::ZERO, 0.9).expect("a ball").into();
    let record = SolidRecord::new(ball, 0, MaterialIndex(0));
    scene.prototypes[0].solids.push(record).expect("pushed");
    scene.clips = vec![Clip {
        point: DVec3::new(0.0, 0.0, 0.3),
        normal: DVec3::new(0.6, 0.0, 0.8),
        material: None,
        casts_shadows: false,
    }];
    let film = picture(scene, 64);
    let apart = (mean(&film) / radiance - 1.0).abs().max_element();
    assert!(apart < 2e-3, "{apart}");
}

/// The material of a plane colors its faces.
#[test]
fn cut_faces_have_the_material_of_the_plane() {
    let scene = load(
        "[[material]]\nname = \"red\"\ncolor = [0.8, 0.1, 0.1]\n[[clip]]\npoint = [0, 0, 0]\n\
         normal = [0, 0, 1]\nmaterial = \"red\"\n[[cuboid]]\nhalf_widths = [200, 200, 1]\n",
    );
    let cosine = 1.2 / DVec3::new(1.0, -0.4, 1.2).length();
    let sky = DVec3::new(0.6, 0.8, 1.0);
    let expected = DVec3::new(0.8, 0.1, 0.1) * (3.0 * cosine / PI + sky);
    assert_all_pixels(&stage::film_of(scene, 1), expected);
}

/// Channels and outlines are of what planes leave, too.
#[test]
fn channels_and_outlines_are_those_of_intersections() {
    let groups = [
        ChannelGroup::Depth,
        ChannelGroup::Position,
        ChannelGroup::Normal,
        ChannelGroup::Albedo,
    ];
    let scenes = by_planes_and_by_operations(&SOLIDS[..5], false);
    let [planes, operations] = scenes.map(|mut scene| {
        scene.illustration.outlines = Some(outlines(1.0));
        scene.render.integrator = Integrator::Ao;
        rendered(scene, |settings| {
            settings.channels = Channels::new(groups, false);
        })
    });
    assert!(greatest_difference(&planes.film, &operations.film) < 1e-5);
    assert_eq!(planes.words.len(), operations.words.len());
    let numbers = planes.words.iter().zip(&operations.words);
    for (place, (&one, &other)) in numbers.enumerate() {
        let [one, other] = [one, other].map(f32::from_bits);
        assert!(
            one == other || (one - other).abs() < 1e-5,
            "{place}: {one} {other}"
        );
    }
}

/// Where cut solids overlap, the first one shows, but glass only if there is nothing else.
#[test]
fn first_of_overlapping_solids_shows_its_cut_face() {
    let face = |first: &str, second: &str| {
        let block = |material: &str| {
            format!("[[cuboid]]\nhalf_widths = [200, 200, 1]\nmaterial = \"{material}\"\n")
        };
        let materials = "[[material]]\nname = \"red\"\ncolor = [0.8, 0.1, 0.1]\n\
                         [[material]]\nname = \"green\"\ncolor = [0.1, 0.8, 0.1]\n\
                         [[material]]\nname = \"glass\"\nkind = \"glass\"\n";
        let plane = "[[clip]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n";
        let scene = load(&format!(
            "{materials}{}{}{plane}",
            block(first),
            block(second)
        ));
        rendered(scene, |settings| {
            settings.integrator = Integrator::Sun;
            settings.spp = 1;
        })
        .film
    };
    let is_red = |film: &Film| film.pixels().iter().all(|pixel| pixel[0] > 2.0 * pixel[1]);
    let is_green = |film: &Film| film.pixels().iter().all(|pixel| pixel[1] > pixel[0]);
    assert!(is_red(&face("red", "green")));
    assert!(is_green(&face("green", "red")));
    assert!(is_red(&face("glass", "red")));
    assert!(is_red(&face("red", "glass")));
}

/// A camera within the glass that is left sees the cut face from inside; within the glass that is
/// removed, from outside.
#[test]
fn cut_face_of_glass_around_the_camera_is_that_of_an_intersection() {
    for (eye, plane, normal, middle) in [(0.0, 0.5, 1.0, -9.5), (-0.8, -0.5, -1.0, 9.5)] {
        let view = format!(
            "[camera]\nposition = [0, {eye}, 0]\nlook_at = [0.2, 1, 0.1]\nfov_degrees = 60\n\
             [film]\nwidth = 24\nheight = 24\n[sky]\ncolor = [0.6, 0.8, 1]\n\
             [[material]]\nname = \"g\"\nkind = \"glass\"\n\
             [[sphere]]\ncenter = [1, {}, 0]\nradius = 2\n",
            -4.0 * normal
        );
        let planes = format!(
            "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"g\"\n\
             [[clip]]\npoint = [0, {plane}, 0]\nnormal = [0, {normal}, 0]\nshadows = false\n"
        );
        let operation = format!(
            "[[intersection]]\nmaterial = \"g\"\nof = [{{ sphere = {{ center = [0, 0, 0], \
             radius = 1 }} }}, {{ cuboid = {{ center = [0, {middle}, 0], \
             half_widths = [20, 10, 20] }} }}]\n"
        );
        let [planes, operation] = [planes, operation].map(|text| {
            let scene = load_text(&format!("{view}{text}"));
            stage::film_of(scene, 64)
        });
        let apart = greatest_difference(&planes, &operation);
        assert!(apart < 1e-5, "eye at {eye}: {apart}");
    }
}
