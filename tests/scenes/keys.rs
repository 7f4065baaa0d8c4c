//! Every key of `docs/scene-file.md` does what it says there.

use test_support::three_mf;

use std::fs;
use std::path::Path;

use cyltrace::scene::{
    Background, Frame, Integrator, Material, MaterialIndex, Placement, Projection, Prototype,
    Records, Scene, load,
};
use cyltrace::solid::Caps;
use glam::{DAffine3, DMat3, DVec3};

pub const SOLID: &str = "[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\n";
const TREE: &str = "[[prototype]]\nname = \"tree\"\n[[prototype.cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\n";
pub const BARK: &str = "[[material]]\nname = \"bark\"\ncolor = [0.1, 0.2, 0.3]\n";
const LATTICE: &str = "<resources><object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>\
     <vertex x=\"0\" y=\"0\" z=\"9\"/></vertices><b:beamlattice radius=\"1\" minlength=\"0\"><b:beams>\
     <b:beam v1=\"0\" v2=\"1\"/></b:beams></b:beamlattice></mesh></object></resources>\
     <build><item objectid=\"1\"/></build>";
const FILES: [(&str, &str); 5] = [
    (
        "tree.csv",
        "startX,startY,startZ,endX,endY,endZ,axisX,axisY,axisZ,length,radius,diameter\n\
         1,2,3,1,2,7,0,0,2.5,4,0.5,1\n1,2,3,1,2,3,1,1,1,0,0.5,1\n",
    ),
    (
        "placements.csv",
        "x,y,z,ax,ay,az,angle,s,qx,qy,qz,qw,sx,sy,sz\n\
         1,2,3,0,0,5,90,2,0,0,3,3,2,2,2\n4,5,6,1,0,0,180,-1,7,0,0,0,-1,-1,-1\n",
    ),
    (
        "matrices.csv",
        "xx,xy,xz,x,yx,yy,yz,y,zx,zy,zz,z\n0,-1,0,1,1,0,0.5,2,0,0,2,3\n1,0,0,0,0,1,0,0,0,0,-1,0\n",
    ),
    ("no_header.csv", "0;0;0;0;0;2,5;0,5\n"),
    (
        "neuron.swc",
        "# id type x y z radius parent\n2 3 0 0 5 0.5 1\n1 1 0 0 0 2 -1\n3 3 0 0 5 0.5 2\n4 3 0 4 5 0.25 2\n",
    ),
];

/// The scene of a text, with the tables beside it.
pub fn scene(text: &str) -> Scene {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in FILES {
        fs::write(folder.path().join(name), text).expect("writing a table");
    }
    let lattice = three_mf::three_mf(&three_mf::model("", LATTICE));
    fs::write(folder.path().join("lattice.3mf"), lattice).expect("writing a lattice");
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).expect("writing the scene");
    load(&path).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

#[test]
fn scene_stated_by_its_solids_alone_is_a_new_scene_of_them() {
    let stated = scene(SOLID);
    let new = Scene::new(stated.prototypes.clone());
    assert_eq!(stated.materials, new.materials);
    assert_eq!(stated.camera, new.camera);
    assert_eq!((stated.film, stated.render), (new.film, new.render));
    assert_eq!((stated.sun, stated.sky), (new.sun, new.sky));
    assert_eq!(stated.background, new.background);
    assert_eq!(stated.skipped_rows, new.skipped_rows);
}

/// Primitive number, ends and radius of every cylinder.
fn cylinders(prototype: &Prototype) -> Vec<(u32, [f64; 3], [f64; 3], f64)> {
    let record = |record: cyltrace::scene::CylinderRecord| {
        let cylinder = record.cylinder();
        (
            record.primitive(),
            cylinder.p0().to_array(),
            cylinder.p1().to_array(),
            cylinder.radius(),
        )
    };
    prototype.solids.cylinders.iter().map(record).collect()
}

fn placed(scene: &Scene) -> Vec<DAffine3> {
    scene.prototypes[0]
        .placements
        .iter()
        .map(|placement| placement.parent_from_child)
        .collect()
}

#[test]
fn least_scene_has_the_documented_defaults() {
    let scene = scene(SOLID);
    assert_eq!(
        scene.camera.projection,
        Projection::Perspective { fov_degrees: 40.0 }
    );
    assert_eq!(scene.camera.frame, Frame::Auto);
    assert_eq!((scene.film.width, scene.film.height), (1280, 720));
    assert_eq!(scene.render.integrator, Integrator::Sun);
    assert_eq!(scene.render.spp, 4);
    assert_eq!(
        scene.background,
        Background::Color(DVec3::new(0.8, 0.9, 1.0))
    );
    assert_eq!((scene.sun, scene.sky), (None, None));
    assert_eq!(scene.materials.len(), 1);
    assert_eq!(scene.prototypes.len(), 1);
    assert_eq!(scene.prototypes[0].name, "");
    assert_eq!(scene.skipped_rows, 0);
    let record = scene.prototypes[0].solids.cylinders.get(0);
    assert_eq!(record.cylinder().caps(), Caps::Both);
    assert_eq!(record.material(), MaterialIndex(0));
}

#[test]
fn records_in_f32_are_the_rounded_numbers_and_say_so() {
    let table = "[[cylinder_table]]\nfile = \"tree.csv\"\ndegenerate = \"skip\"\ncolumns = { p0 = [\"startX\", \"startY\", \"startZ\"], p1 = [\"endX\", \"endY\", \"endZ\"], radius = \"radius\" }\n";
    let thin = "[[cylinder]]\np0 = [0.1, 0, 0]\np1 = [0, 0, 1]\nradius = 0.3\n";
    let stated = scene(&format!("{thin}{table}{table}"));
    let rounded = scene(&format!("records = \"f32\"\n{thin}{table}{table}"));
    assert_eq!(
        scene(&format!("records = \"f64\"\n{thin}")).records(),
        Records::F64
    );
    assert_eq!((stated.records(), stated.rounding()), (Records::F64, 0.0));
    assert_eq!(rounded.records(), Records::F32);
    let off = |x: f64| (f64::from(x as f32) - x).abs();
    assert_eq!(rounded.rounding(), off(0.3).max(off(0.1)));
    let to_f32 = |point: [f64; 3]| point.map(|x| f64::from(x as f32));
    let expected: Vec<_> = cylinders(&stated.prototypes[0])
        .into_iter()
        .map(|(number, p0, p1, radius)| (number, to_f32(p0), to_f32(p1), f64::from(radius as f32)))
        .collect();
    assert_eq!(cylinders(&rounded.prototypes[0]), expected);
    // Each table has a row without length, which keeps its number.
    let numbers: Vec<u32> = expected.iter().map(|cylinder| cylinder.0).collect();
    assert_eq!(numbers, [0, 1, 3]);
}

#[test]
fn background_is_a_color_or_transparent() {
    let stated = |value: &str| scene(&format!("background = {value}\n{SOLID}")).background;
    assert_eq!(stated("\"transparent\""), Background::Transparent);
    assert_eq!(
        stated("[1, 0, 0.5]"),
        Background::Color(DVec3::new(1.0, 0.0, 0.5))
    );
}

#[test]
fn picture_keys_are_read() {
    let scene = scene(&format!(
        "background = [0, 0.5, 2]\n[camera]\ntype = \"perspective\"\nposition = [1, 2, 3]\nlook_at = [4, 5, 6]\n\
         up = [0, 1, 0]\nfov_degrees = 25.5\n[film]\nwidth = 65536\nheight = 1\n\
         [render]\nintegrator = \"normal\"\nspp = 9\n{SOLID}"
    ));
    assert_eq!(
        scene.background,
        Background::Color(DVec3::new(0.0, 0.5, 2.0))
    );
    assert_eq!(
        scene.camera.projection,
        Projection::Perspective { fov_degrees: 25.5 }
    );
    assert_eq!(
        scene.camera.frame,
        Frame::LookAt {
            position: DVec3::new(1.0, 2.0, 3.0),
            look_at: DVec3::new(4.0, 5.0, 6.0),
            up: DVec3::Y
        }
    );
    assert_eq!((scene.film.width, scene.film.height), (65_536, 1));
    assert_eq!(scene.render.integrator, Integrator::Normal);
    assert_eq!(scene.render.spp, 9);
}

#[test]
fn orthographic_camera_takes_a_height_or_none() {
    for (key, height) in [("height = 12", Some(12.0)), ("frame = \"auto\"", None)] {
        let scene = scene(&format!(
            "{SOLID}[camera]\ntype = \"orthographic\"\n{key}\n"
        ));
        assert_eq!(scene.camera.projection, Projection::Orthographic { height });
        assert_eq!(scene.camera.frame, Frame::Auto);
    }
}

#[test]
fn sun_direction_comes_from_angles_or_a_vector() {
    let direction = |keys: &str| {
        let scene = scene(&format!("{SOLID}[sun]\n{keys}\n"));
        scene.sun.expect("a sun").direction
    };
    let angles = |elevation, azimuth| {
        direction(&format!(
            "elevation_degrees = {elevation}\nazimuth_degrees = {azimuth}"
        ))
    };
    assert_eq!(direction("direction = [0, 0, 7]"), DVec3::Z);
    assert_eq!(angles(90, 0), DVec3::Z);
    assert_eq!(angles(0, 0), DVec3::X);
    assert_eq!(angles(0, 90), DVec3::Y);
    assert_eq!(angles(0, -90), DVec3::NEG_Y);
    let lowered = angles(30, 45);
    let expected = DVec3::new(6_f64.sqrt() / 4.0, 6_f64.sqrt() / 4.0, 0.5);
    assert!((lowered - expected).length() < 1e-15, "{lowered:?}");
}

#[test]
fn lights_that_are_not_stated_are_not_there() {
    for (keys, sun, sky) in [
        ("", false, false),
        ("background = [1, 1, 1]\n", false, false),
        ("[sun]\nstrength = 2\n", true, false),
        ("[sky]\nstrength = 2\n", false, true),
        (
            "[sun]\ncolor = [1, 1, 0]\n[sky]\ncolor = [0, 0, 3]\n",
            true,
            true,
        ),
    ] {
        let scene = scene(&format!("{keys}{SOLID}"));
        assert_eq!(
            (scene.sun.is_some(), scene.sky.is_some()),
            (sun, sky),
            "{keys}"
        );
    }
}

#[test]
fn materials_and_caps_are_found_by_name() {
    let text = ["none", "p0", "p1", "both"]
        .map(|caps| format!("{SOLID}caps = \"{caps}\"\nmaterial = \"bark\"\n"))
        .concat();
    let scene = scene(&format!("{text}{BARK}kind = \"diffuse\"\n"));
    assert_eq!(scene.materials[1].name, "bark");
    assert_eq!(
        scene.materials[1],
        Material::diffuse("bark", DVec3::new(0.1, 0.2, 0.3))
    );
    let found: Vec<_> = scene.prototypes[0]
        .solids
        .cylinders
        .iter()
        .map(|record| (record.cylinder().caps(), record.material().0))
        .collect();
    let expected = [Caps::None, Caps::P0, Caps::P1, Caps::Both].map(|caps| (caps, 1));
    assert_eq!(found, expected);
}

#[test]
fn cylinder_table_layouts_give_the_same_cylinder() {
    let layouts = [
        r#"p0 = ["startX", "startY", "startZ"], p1 = ["endX", "endY", "endZ"], radius = "radius""#,
        r#"start = ["startX", "startY", "startZ"], p1 = ["endX", "endY", "endZ"], diameter = "diameter""#,
        r#"p0 = ["startX", "startY", "startZ"], axis = ["axisX", "axisY", "axisZ"], length = "length", radius = "radius""#,
    ];
    for columns in layouts {
        let scene = scene(&format!(
            "[[cylinder_table]]\nfile = \"tree.csv\"\ncolumns = {{ {columns} }}\ndegenerate = \"skip\"\n\
             caps = \"none\"\nmaterial = \"bark\"\n{BARK}"
        ));
        assert_eq!(
            cylinders(&scene.prototypes[0]),
            [(0, [1.0, 2.0, 3.0], [1.0, 2.0, 7.0], 0.5)],
            "{columns}"
        );
        let record = scene.prototypes[0].solids.cylinders.get(0);
        assert_eq!(record.cylinder().caps(), Caps::None);
        assert_eq!(record.material(), MaterialIndex(1));
        assert_eq!(scene.skipped_rows, 1);
    }
}

#[test]
fn primitives_count_cylinders_then_table_rows_then_segments() {
    let table = "[[cylinder_table]]\nfile = \"tree.csv\"\ndegenerate = \"skip\"\n\
         columns = { p0 = [\"startX\", \"startY\", \"startZ\"], p1 = [\"endX\", \"endY\", \"endZ\"], radius = \"radius\" }\n";
    let swc = "[[swc]]\nfile = \"neuron.swc\"\ndegenerate = \"skip\"\n";
    // The order of the kinds in the file changes nothing.
    let root = format!("{swc}{SOLID}{table}{SOLID}{table}");
    let scene = scene(
        &format!("{root}{}", root.replace("[[", "[[prototype.")).replacen(
            "[[prototype.swc",
            "[[prototype]]\nname = \"a\"\n[[prototype.swc",
            1,
        ),
    );
    let unit = ([0.0; 3], [0.0, 0.0, 1.0], 1.0);
    let row = ([1.0, 2.0, 3.0], [1.0, 2.0, 7.0], 0.5);
    let expected = [
        (0, unit),
        (1, unit),
        (2, row),
        (4, row),
        (6, ([0.0; 3], [0.0, 0.0, 5.0], 0.5)),
        (8, ([0.0, 0.0, 5.0], [0.0, 4.0, 5.0], 0.25)),
    ]
    .map(|(number, (p0, p1, radius))| (number, p0, p1, radius));
    assert_eq!(scene.prototypes.len(), 2);
    for prototype in &scene.prototypes {
        assert_eq!(cylinders(prototype), expected, "{:?}", prototype.name);
    }
    assert_eq!(scene.skipped_rows, 6);
}

#[test]
fn instance_applies_scale_then_rotations_then_translation() {
    let scene = scene(&format!(
        "{TREE}[[instance]]\nof = \"tree\"\nscale = [2, 3, 4]\n\
         rotate = [{{ axis = [0, 0, 9], degrees = 90 }}, {{ axis = [1, 0, 0], degrees = -270.0 }}]\n\
         translate = [10, 20, 30]\n\
         [[instance]]\nof = \"tree\"\nmatrix = [[1, 2, 3, 4], [0, 1, 5, 6], [0, 0, -1, 7]]\n\
         [[instance]]\nof = \"tree\"\nscale = -0.5\n[[instance]]\nof = \"tree\"\n"
    ));
    let placements = placed(&scene);
    // x to 2x, to 2y, to 2z; y to 3y, to -3x; z to 4z, to -4y.
    assert_eq!(
        placements[0],
        DAffine3::from_cols(
            DVec3::new(0.0, 0.0, 2.0),
            DVec3::new(-3.0, 0.0, 0.0),
            DVec3::new(0.0, -4.0, 0.0),
            DVec3::new(10.0, 20.0, 30.0),
        )
    );
    assert_eq!(
        placements[1].transform_point3(DVec3::new(1.0, 10.0, 100.0)),
        DVec3::new(325.0, 516.0, -93.0)
    );
    assert_eq!(placements[2], DAffine3::from_scale(DVec3::splat(-0.5)));
    assert_eq!(placements[3], DAffine3::IDENTITY);
}

#[test]
fn instance_table_layouts_give_the_same_placements() {
    let layouts = [
        (
            r#"axis = ["ax", "ay", "az"], degrees = "angle", scale = "s""#,
            0.0,
        ),
        (
            r#"quaternion = ["qx", "qy", "qz", "qw"], scale = ["sx", "sy", "sz"]"#,
            1e-15,
        ),
    ];
    let quarter = DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z) * 2.0;
    let half = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    for (columns, tolerance) in layouts {
        let scene = scene(&format!(
            "{TREE}[[instance_table]]\nof = \"tree\"\nfile = \"placements.csv\"\n\
             columns = {{ position = [\"x\", \"y\", \"z\"], {columns} }}\n"
        ));
        let placements = placed(&scene);
        assert_eq!(placements.len(), 2);
        for (found, expected) in placements.iter().zip([quarter, half]) {
            let error = (found.matrix3 - expected).abs() * DVec3::ONE;
            assert!(error.max_element() <= tolerance, "{columns}: {found:?}");
        }
        assert_eq!(placements[0].translation, DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(placements[1].translation, DVec3::new(4.0, 5.0, 6.0));
    }
}

#[test]
fn placements_count_instances_then_table_rows_then_scattered_ones() {
    let lists = "[[scatter]]\nof = \"tree\"\npattern = \"grid\"\ncount = 1\nspacing = 1\nscale = 5\n\
         [[instance_table]]\nof = \"tree\"\nfile = \"placements.csv\"\ncolumns = { position = [\"x\", \"y\", \"z\"] }\n\
         [[instance]]\nof = \"tree\"\ntranslate = [7, 7, 7]\n\
         [[scatter]]\nof = \"tree\"\npattern = \"disc\"\ncount = 2\nspacing = 1\nyaw = \"random\"\nscale = [6, 7]\nseed = 3\n";
    let scene = scene(&format!(
        "{lists}{TREE}[[prototype]]\nname = \"grove\"\n{}[[instance]]\nof = \"grove\"\n",
        lists.replace("[[", "[[prototype.")
    ));
    let describe = |placement: &Placement| {
        let affine = placement.parent_from_child;
        (
            placement.of.0,
            affine.matrix3.z_axis.z.floor(),
            affine.translation.z,
        )
    };
    let expected = [
        (1, 1.0, 7.0),
        (1, 1.0, 3.0),
        (1, 1.0, 6.0),
        (1, 5.0, 0.0),
        (1, 6.0, 0.0),
        (1, 6.0, 0.0),
    ];
    let grove: Vec<_> = scene.prototypes[2]
        .placements
        .iter()
        .map(describe)
        .collect();
    assert_eq!(grove, expected);
    let root: Vec<_> = scene.prototypes[0]
        .placements
        .iter()
        .map(describe)
        .collect();
    assert_eq!(root[..1], expected[..1]);
    assert_eq!(root[1], (2, 1.0, 0.0));
    assert_eq!(root[2..], expected[1..]);
}

#[test]
fn scatter_in_a_disk_has_two_spellings() {
    let placements = |pattern: &str| {
        let scene = scene(&format!(
            "{TREE}[[scatter]]\nof = \"tree\"\npattern = \"{pattern}\"\ncount = 9\nspacing = 2\n"
        ));
        placed(&scene)
    };
    let [disk, disc, grid] = ["disk", "disc", "grid"].map(placements);
    assert_eq!(disk, disc);
    assert_ne!(disk, grid);
}

#[test]
fn nesting_of_64_levels_is_accepted() {
    let mut text = TREE.to_owned();
    let mut inner = "tree".to_owned();
    for level in 1..64 {
        text += &format!(
            "[[prototype]]\nname = \"{level}\"\n[[prototype.instance]]\nof = \"{inner}\"\n"
        );
        inner = level.to_string();
    }
    let scene = scene(&format!("{text}[[instance]]\nof = \"{inner}\"\n"));
    assert_eq!(scene.scene_stats().depth, 64);
}

#[test]
fn documented_examples_load() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene-file.md");
    let text = fs::read_to_string(path).expect("the documentation");
    let mut count = 0;
    for block in text.split("```toml\n").skip(1) {
        let mut example = block.split("```").next().expect("a block").to_owned();
        if example.contains("\"tree\"") {
            example += TREE;
        }
        // The examples that state no degenerate policy meet a table with a
        // row that needs one.
        let example = example.replace(
            "radius = \"radius\" }",
            "radius = \"radius\" }\ndegenerate = \"skip\"",
        );
        scene(&format!("{example}{SOLID}"));
        count += 1;
    }
    assert!(count >= 10, "{count} examples");
}
