//! The keys of materials, lights and cameras do what `docs/scene-file.md` says.

use std::fs;

use cyltrace::scene::{
    Axes, Clip, Color, Corner, DepthCue, Illustration, Inset, Integrator, Lens, Light, LightShape,
    MaterialIndex, MaterialKind, Outlines, Projection, ScaleBar, SceneFile,
};
use glam::DVec3;

use super::keys::{BARK, SOLID, scene};

#[test]
fn kinds_of_materials_have_the_documented_defaults() {
    let color = "color = [0.5, 0.25, 1]\n";
    let gold = Color::Constant(DVec3::new(0.5, 0.25, 1.0));
    let white = Color::Constant(DVec3::ONE);
    let (roughness, ior) = (0.25, 2.5);
    for (keys, color, kind) in [
        (color.to_owned(), &gold, MaterialKind::Diffuse),
        (
            format!("kind = \"metal\"\n{color}"),
            &gold,
            MaterialKind::Metal { roughness: 0.3 },
        ),
        (
            format!("kind = \"metal\"\n{color}roughness = 0.25"),
            &gold,
            MaterialKind::Metal { roughness },
        ),
        (
            format!("kind = \"plastic\"\n{color}"),
            &gold,
            MaterialKind::Plastic {
                roughness: 0.2,
                ior: 1.5,
            },
        ),
        (
            format!("kind = \"plastic\"\n{color}ior = 2.5\nroughness = 0.25"),
            &gold,
            MaterialKind::Plastic { roughness, ior },
        ),
        (
            "kind = \"glass\"".to_owned(),
            &white,
            MaterialKind::Glass {
                roughness: 0.0,
                ior: 1.5,
            },
        ),
        (
            format!("kind = \"glass\"\n{color}ior = 2.5\nroughness = 0.25"),
            &gold,
            MaterialKind::Glass { roughness, ior },
        ),
        (
            "kind = \"light\"".to_owned(),
            &white,
            MaterialKind::Light { strength: 1.0 },
        ),
        (
            format!("kind = \"light\"\n{color}strength = 40"),
            &gold,
            MaterialKind::Light { strength: 40.0 },
        ),
    ] {
        let scene = scene(&format!("{SOLID}[[material]]\nname = \"a\"\n{keys}\n"));
        assert_eq!(scene.materials[1].kind, kind, "{keys}");
        assert_eq!(scene.materials[1].color, *color, "{keys}");
    }
}

#[test]
fn lights_with_a_place_are_points_then_spheres_then_rectangles() {
    let scene = scene(&format!(
        "{SOLID}[[rectangle_light]]\ncorner = [1, 2, 3]\nedges = [[2, 0, 0], [1, 1, 0]]\nstrength = 4\n\
         [[sphere_light]]\ncenter = [4, 5, 6]\nradius = 0.5\ncolor = [3, 0, 1]\n\
         [[point_light]]\nposition = [7, 8, 9]\n[[point_light]]\nposition = [0, 0, 9]\nstrength = 0\n"
    ));
    let light = |shape, color, strength| Light {
        shape,
        color,
        strength,
    };
    let position = DVec3::new(7.0, 8.0, 9.0);
    let near = DVec3::new(0.0, 0.0, 9.0);
    let center = DVec3::new(4.0, 5.0, 6.0);
    let expected = [
        light(LightShape::Point { position }, DVec3::ONE, 1.0),
        light(LightShape::Point { position: near }, DVec3::ONE, 0.0),
        light(
            LightShape::Sphere {
                center,
                radius: 0.5,
            },
            DVec3::new(3.0, 0.0, 1.0),
            1.0,
        ),
        light(
            LightShape::Rectangle {
                corner: DVec3::new(1.0, 2.0, 3.0),
                edges: [DVec3::X * 2.0, DVec3::new(1.0, 1.0, 0.0)],
            },
            DVec3::ONE,
            4.0,
        ),
    ];
    assert_eq!(scene.lights, expected);
}

#[test]
fn integrator_by_default_shows_what_the_scene_states() {
    let light = "[[point_light]]\nposition = [0, 0, 9]\n";
    let glass = "[[material]]\nname = \"a\"\nkind = \"glass\"\n";
    for (keys, integrator) in [
        (BARK, Integrator::Sun),
        (light, Integrator::Path),
        (glass, Integrator::Path),
        (
            "[render]\nspp = 3\n[[material]]\nname = \"a\"\nkind = \"glass\"\n",
            Integrator::Path,
        ),
        (
            "[render]\nintegrator = \"sun\"\n[[point_light]]\nposition = [0, 0, 9]\n",
            Integrator::Sun,
        ),
    ] {
        assert_eq!(
            scene(&format!("{keys}{SOLID}")).render.integrator,
            integrator,
            "{keys}"
        );
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("scene.toml");
        fs::write(&path, format!("{keys}{SOLID}")).expect("writing the scene");
        let file = SceneFile::read(&path).expect("a scene file");
        let (_, render) = file.picture().expect("a picture");
        assert_eq!(render.integrator, integrator, "{keys}");
    }
}

#[test]
fn camera_has_a_lens_if_it_states_an_aperture() {
    let camera = |keys: &str| scene(&format!("{SOLID}[camera]\n{keys}\n")).camera;
    assert_eq!(camera("").lens, None);
    assert_eq!(camera("focus = 3").lens, None);
    assert_eq!(camera("aperture = 0").lens, None);
    let aperture = 0.25;
    let lens = |focus| Some(Lens { aperture, focus });
    assert_eq!(camera("aperture = 0.25").lens, lens(None));
    assert_eq!(camera("aperture = 0.25\nfocus = 3").lens, lens(Some(3.0)));
    let flat = camera("type = \"orthographic\"\naperture = 0.25");
    assert_eq!(flat.lens, lens(None));
}

#[test]
fn panorama_is_a_type_of_camera() {
    let scene = scene(&format!("{SOLID}[camera]\ntype = \"panorama\"\n"));
    assert_eq!(scene.camera.projection, Projection::Panorama);
}

#[test]
fn clear_sky_has_the_sun_that_belongs_to_it() {
    let clear = scene(&format!("{SOLID}[sky]\nmodel = \"clear\"\n"));
    let sky = clear.clear_sky.expect("a clear sky");
    assert_eq!((sky.turbidity, sky.strength), (3.0, 1.0));
    assert_eq!(sky.ground, DVec3::splat(0.2));
    assert_eq!(clear.sky, None);
    assert_eq!(clear.render.integrator, Integrator::Path);
    let sun = clear.sun.expect("a sun");
    let expected = sky.sun_irradiance(sun.direction);
    assert!((sun.color * sun.strength - expected).length() < 1e-14);
    assert!((2.0..4.0).contains(&sun.strength), "{}", sun.strength);

    let stated = scene(&format!(
        "{SOLID}[sun]\nstrength = 0\nelevation_degrees = 10\n\
         [sky]\nmodel = \"clear\"\nturbidity = 6\nstrength = 2\nground = [0, 0.5, 1]\n"
    ));
    let sky = stated.clear_sky.expect("a clear sky");
    assert_eq!((sky.turbidity, sky.strength), (6.0, 2.0));
    assert_eq!(sky.ground, DVec3::new(0.0, 0.5, 1.0));
    let sun = stated.sun.expect("a sun");
    assert_eq!(sun.strength, 0.0);
    assert!(sun.color.x == 1.0 && sun.color.z < 0.5, "{}", sun.color);

    let constant = scene(&format!("{SOLID}[sky]\nmodel = \"constant\"\n"));
    assert!(constant.sky.is_some() && constant.clear_sky.is_none() && constant.sun.is_none());
}

#[test]
fn clip_planes_are_read_and_cut_faces_have_one_color() {
    let clips = |keys: &str| scene(&format!("{SOLID}{BARK}{keys}")).clips;
    assert_eq!(clips(""), []);
    let both = clips(
        "[[clip]]\npoint = [1, 2, 3]\nnormal = [0, 0, 2]\n\
         [[clip]]\npoint = [0, 0, 0]\nnormal = [0, 3, 4]\nmaterial = \"bark\"\nshadows = false\n",
    );
    let expected = [
        Clip {
            point: DVec3::new(1.0, 2.0, 3.0),
            normal: DVec3::Z,
            material: None,
            casts_shadows: true,
        },
        Clip {
            point: DVec3::ZERO,
            normal: DVec3::new(0.0, 0.6, 0.8),
            material: Some(MaterialIndex(1)),
            casts_shadows: false,
        },
    ];
    assert_eq!(both, expected);
    let checker = "[[material]]\nname = \"a\"\ncolor = { checker = [[0, 0, 0], [1, 1, 1]] }\n";
    for (keys, expected) in [
        ("point = [0, 0, 0]", "missing field `normal`"),
        ("point = [0, 0, 0]\nnormal = [0, 0, 0]", "normal is zero"),
        (
            "point = [1e300, 0, 0]\nnormal = [0, 0, 1]",
            "at most 1.4e45",
        ),
        (
            "point = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"a\"",
            "same color everywhere",
        ),
        (
            "point = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"b\"",
            "unknown material \"b\"",
        ),
        (
            "point = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"g\"\n\
             [[material]]\nname = \"g\"\nkind = \"glass\"",
            "the material \"g\" is glass",
        ),
    ] {
        let message = failure(&format!("{SOLID}{checker}[[clip]]\n{keys}\n"));
        assert!(message.contains(expected), "{keys}: {message}");
    }
}

/// The message of a scene that cannot be loaded.
fn failure(text: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).expect("written");
    let loaded = SceneFile::read(&path).and_then(SceneFile::load);
    loaded.expect_err(text).to_string()
}

/// The look of what is in a corner if nothing is stated.
fn plain(corner: Corner) -> Inset {
    Inset {
        corner,
        size: 0.03,
        color: DVec3::ZERO,
        background: DVec3::ONE,
        opacity: 0.8,
    }
}

#[test]
fn illustrations_have_the_documented_defaults() {
    assert_eq!(scene(SOLID).illustration, Illustration::default());
    let bare = scene(&format!(
        "{SOLID}[scale_bar]\n[axes]\n[outlines]\n[depth_cue]\n"
    ));
    let expected = Illustration {
        scale_bar: Some(ScaleBar {
            length: None,
            unit: String::new(),
            inset: plain(Corner::BottomLeft),
        }),
        axes: Some(Axes {
            labels: true,
            inset: plain(Corner::TopLeft),
        }),
        outlines: Some(Outlines {
            width: 1.0,
            color: DVec3::ZERO,
            crease_degrees: 30.0,
            between_solids: true,
        }),
        depth_cue: Some(DepthCue {
            color: None,
            start: None,
            end: None,
            strength: 0.8,
        }),
    };
    assert_eq!(bare.illustration, expected);
    let stated = scene(&format!(
        "{SOLID}[scale_bar]\nlength = 20\nunit = \"µm\"\ncorner = \"top right\"\nsize = 0.05\n\
         [axes]\nlabels = false\ncolor = [1, 0, 0]\nbackground = [0, 0, 1]\nopacity = 0\n\
         [outlines]\nwidth = 32\ncolor = [0, 1, 0]\ncrease_degrees = 180\nbetween_solids = false\n\
         [depth_cue]\ncolor = [1, 1, 0]\nstart = 2\nend = 3\nstrength = 1\n"
    ));
    let expected = Illustration {
        scale_bar: Some(ScaleBar {
            length: Some(20.0),
            unit: "µm".to_owned(),
            inset: Inset {
                size: 0.05,
                ..plain(Corner::TopRight)
            },
        }),
        axes: Some(Axes {
            labels: false,
            inset: Inset {
                color: DVec3::X,
                background: DVec3::Z,
                opacity: 0.0,
                ..plain(Corner::TopLeft)
            },
        }),
        outlines: Some(Outlines {
            width: 32.0,
            color: DVec3::Y,
            crease_degrees: 180.0,
            between_solids: false,
        }),
        depth_cue: Some(DepthCue {
            color: Some(DVec3::new(1.0, 1.0, 0.0)),
            start: Some(2.0),
            end: Some(3.0),
            strength: 1.0,
        }),
    };
    assert_eq!(stated.illustration, expected);
}

#[test]
fn illustrations_that_cannot_be_drawn_are_errors_with_help() {
    for (keys, text) in [
        (
            "[scale_bar]\nlength = 0",
            "length is 0: it must be a positive number",
        ),
        ("[scale_bar]\nunit = \"a\\nb\"", "one line of text"),
        ("[scale_bar]\nsize = 1", "between 0.005 and 0.2"),
        (
            "[scale_bar]\n[camera]\ntype = \"panorama\"",
            "choose another type of [camera]",
        ),
        (
            "[axes]\ncorner = \"bottom left\"\n[scale_bar]",
            "[scale_bar] and [axes] are both in the corner \"bottom left\"",
        ),
        (
            "[scale_bar]\ncorner = \"top left\"\n[axes]",
            "free corners: \"top right\", \"bottom left\", \"bottom right\"",
        ),
        (
            "[outlines]\nwidth = 0",
            "width is 0: it must be greater than 0",
        ),
        (
            "[outlines]\nwidth = 33",
            "width is 33: it must be between 0 and 32",
        ),
        ("[outlines]\ncrease_degrees = 181", "crease_degrees is 181"),
        ("[outlines]\ncolor = [0, 0, 2]", "must be in [0, 1]"),
        ("[depth_cue]\nstrength = 1.5", "strength is 1.5"),
        ("[depth_cue]\nstart = -1", "start is -1"),
        (
            "[depth_cue]\nstart = 3\nend = 3",
            "end is 3: it must be greater than start, which is 3",
        ),
        ("[[axes]]", "axes must be a single table"),
        ("[depth_cues]", "depth_cue"),
    ] {
        let error = failure(&format!("{keys}\n{SOLID}"));
        assert!(error.contains(text), "{keys}: {error}");
    }
}
