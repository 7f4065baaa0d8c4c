//! A scene that is saved loads to the same scene: to the last bit of every number, with the
//! same numbers of solids and placements, and with the same hits.

mod colors;
mod errors;
mod random_scene;
mod same;

use std::fs::{self, File};
use std::path::Path;
use std::sync::Arc;

use cyltrace::math::{Bounds, Orientation, Random, Ray, power_of_two};
use cyltrace::scene::{
    Background, Camera, ClearSky, Environment, Film, Frame, Integrator, Lens, Light, LightShape,
    Material, MaterialIndex, MaterialKind, Projection, Prototype, RenderSettings, Sampler, Scene,
    Sky, SolidRecord, Sun, load, save,
};
use cyltrace::solid::{AnySolid, Caps, Cone, Cuboid, Cylinder, Disk, RoundedCone, Sphere};
use cyltrace::tracer::{Options, Tracer};
use glam::DVec3;

use self::random_scene::random_scene;
use self::same::assert_same;

/// The scene that the files of a saved scene state.
fn saved(scene: &Scene) -> Scene {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let create = |name: &str| File::create_new(folder.path().join(name));
    save(scene, "a \"copy\"", create, |_| Ok(())).unwrap_or_else(|error| panic!("{error}"));
    let path = folder.path().join("a \"copy\".toml");
    load(&path).unwrap_or_else(|error| {
        let text = fs::read_to_string(&path).expect("the scene file");
        panic!("{error}\n{}", text.chars().take(4000).collect::<String>())
    })
}

/// A scene with one solid of any kind in its root.
fn of_solids(solids: impl IntoIterator<Item = AnySolid>) -> Scene {
    let mut root = Prototype::default();
    for (primitive, solid) in (0..).zip(solids) {
        let record = SolidRecord::new(solid, primitive, MaterialIndex(0));
        root.solids.push(record).expect("f64 records");
    }
    Scene::new(vec![root])
}

/// Compares the hits of rays through both scenes.
fn assert_same_hits(scene: Scene, copy: Scene, rays: usize) {
    let [one, other] = [scene, copy].map(|scene| {
        Tracer::new(Arc::new(scene), &Options::default()).unwrap_or_else(|error| panic!("{error}"))
    });
    let bounds = one.bounds();
    let mut random = Random::new(17, 0);
    let mut hits = 0;
    for case in 0..rays {
        let ray = ray_through(&bounds, &mut random);
        let hit = one.closest(&ray);
        assert_eq!(hit, other.closest(&ray), "ray {case}: {ray:?}");
        hits += usize::from(hit.is_some());
    }
    assert!(hits > rays / 20, "only {hits} hits of {rays} rays");
}

/// A ray between two points of a box.
fn ray_through(bounds: &Bounds, random: &mut Random) -> Ray {
    let mut point = || {
        let share = DVec3::from_array(std::array::from_fn(|_| random.unit()));
        bounds.lower + bounds.extent() * share
    };
    let origin = point();
    Ray::new(origin, point() - origin)
}

fn sample(name: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    load(&folder.join(name)).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn sample_scenes_saved_are_the_same() {
    for name in [
        "minimal.toml",
        "pathological.toml",
        "set_operations.toml",
        "lattice.toml",
        "forest.toml",
    ] {
        let scene = sample(name);
        let copy = saved(&scene);
        assert_same(&scene, &copy, name);
        assert_same_hits(scene, copy, 3_000);
    }
}

#[test]
fn a_million_placements_saved_are_the_same() {
    let scene = sample("forest_huge.toml");
    assert_same(&scene, &saved(&scene), "forest_huge.toml");
}

#[test]
fn random_scenes_of_all_kinds_saved_are_the_same() {
    for seed in 0..40 {
        let scene = random_scene(seed);
        let copy = saved(&scene);
        assert_same(&scene, &copy, &format!("seed {seed}"));
        assert_same_hits(scene, copy, 300);
    }
}

/// What is saved once more is the same text.
#[test]
fn saved_scenes_saved_again_are_the_same_bytes() {
    let files = |scene: &Scene| {
        let mut files = Vec::new();
        save(
            scene,
            "x",
            |_| Ok(Vec::new()),
            |file| {
                files.push(file);
                Ok(())
            },
        )
        .expect("saved");
        files
    };
    for seed in [3, 4] {
        let scene = random_scene(seed);
        let first = files(&scene);
        assert!(first.len() > 1, "no table");
        assert_eq!(first, files(&saved(&scene)), "seed {seed}");
    }
}

#[test]
fn extreme_numbers_saved_are_the_same() {
    let (least, greatest) = (power_of_two(-150), power_of_two(150));
    let tiny = f64::from_bits(1);
    let far = DVec3::new(greatest, -greatest, -0.0);
    let near = DVec3::new(-0.0, tiny, -least);
    let turned = Orientation::IDENTITY.rotated(DVec3::new(1.0, 2.0, 3.0), 33.3);
    let negative = Orientation::IDENTITY.rotated_x(180.0).rotated_z(90.0);
    let cuboid = |center, widths, orientation| {
        AnySolid::from(Cuboid::new(center, widths, orientation).expect("a cuboid"))
    };
    let sizes = DVec3::new(least, 1.0 / 3.0, greatest);
    let solids = [
        Cylinder::new(near, far, least, Caps::None)
            .expect("a cylinder")
            .into(),
        Cylinder::new(far, near, greatest, Caps::P1)
            .expect("a cylinder")
            .into(),
        Sphere::new(near, greatest).expect("a sphere").into(),
        Sphere::new(far, least).expect("a sphere").into(),
        cuboid(near, sizes, Orientation::IDENTITY),
        cuboid(far, sizes, turned),
        cuboid(near, sizes, negative),
        cuboid(near, sizes, turned.inverse()),
        Cone::new(near, far, 0.0, least, Caps::P0)
            .expect("a cone")
            .into(),
        RoundedCone::new(near, near, -0.0, 1e-20)
            .expect("a rounded cone")
            .into(),
        Disk::new(near, DVec3::new(tiny, -0.0, least), 0.1 + 0.2)
            .expect("a disk")
            .into(),
        Disk::new(far, DVec3::new(-1e-310, greatest, 5.0), least)
            .expect("a disk")
            .into(),
    ];
    let mut scene = of_solids(solids);
    scene.camera = Camera {
        projection: Projection::Orthographic {
            height: Some(f64::MIN_POSITIVE),
        },
        frame: Frame::LookAt {
            position: DVec3::new(-0.0, tiny, 1.0),
            look_at: far,
            up: DVec3::new(-0.0, 1e-310, 1e300),
        },
        lens: Some(Lens {
            aperture: tiny,
            focus: Some(greatest),
        }),
    };
    scene.background = Background::Color(DVec3::new(-0.0, f64::MAX, tiny));
    assert_same(&scene, &saved(&scene), "extreme numbers");
    scene.background = Background::Transparent;
    assert_same(&scene, &saved(&scene), "transparent");
}

#[test]
fn pictures_and_names_saved_are_the_same() {
    let mut scene = sample("minimal.toml");
    let mut random = Random::new(18, 0);
    let names = [
        "bark",
        " ",
        "a\nb\r\n\t\"c\" 'd' \\",
        "\"\"\"",
        "'''\n'''",
        "\u{0}\u{1f}\u{7f}\u{85}",
        "\u{feff}木 🌲",
        "\n",
        "[[x]] # = {}",
        "C:\\",
    ];
    let kinds = [
        MaterialKind::Diffuse,
        MaterialKind::Metal { roughness: 1.0 },
        MaterialKind::Plastic {
            roughness: 0.1 + 0.2,
            ior: 10.0,
        },
        MaterialKind::Glass {
            roughness: -0.0,
            ior: 1.0,
        },
        MaterialKind::Light { strength: 1e300 },
    ];
    let material = |(index, name)| Material {
        kind: kinds[index % kinds.len()],
        ..Material::diffuse(name, DVec3::new(-0.0, 1.0, random.unit()))
    };
    scene
        .materials
        .extend(names.into_iter().enumerate().map(material));
    for (case, integrator) in Integrator::ALL.into_iter().enumerate() {
        scene.render = RenderSettings {
            integrator,
            spp: 1 + case as u32,
            sampler: Sampler::ALL[case % 2],
            max_depth: 1 + case as u32,
            ao_distance: [f64::INFINITY, 0.5, 1e90, 7.0][case],
        };
        scene.film = Film {
            width: 65_536,
            height: 1 + case as u32,
        };
        scene.camera.projection = match case {
            0 => Projection::Orthographic { height: None },
            1 => Projection::Perspective { fov_degrees: 1e-7 },
            2 => Projection::Panorama,
            _ => Projection::Perspective { fov_degrees: 179.9 },
        };
        if case == 1 {
            scene.camera.frame = Frame::Auto;
            scene.camera.lens = Some(Lens {
                aperture: 0.1,
                focus: None,
            });
        }
        if case == 2 {
            scene.camera.lens = None;
        }
        scene.sky = (case == 1).then_some(Sky {
            color: DVec3::new(0.1, 0.0, 7e100),
            strength: 0.3,
        });
        assert_same(&scene, &saved(&scene), "picture");
    }
}

#[test]
fn lights_with_a_place_saved_are_the_same() {
    let mut scene = sample("minimal.toml");
    let mut random = Random::new(20, 0);
    let mut point = || random.direction() * random.log_uniform(1e-30, 1e30);
    let mut shapes = Vec::new();
    for _ in 0..3 {
        shapes.push(LightShape::Point { position: point() });
    }
    for _ in 0..3 {
        let radius = point().length();
        let center = point();
        shapes.push(LightShape::Sphere { center, radius });
    }
    for _ in 0..3 {
        let corner = point();
        let edges = [point(), point()];
        shapes.push(LightShape::Rectangle { corner, edges });
    }
    scene.lights = shapes
        .into_iter()
        .map(|shape| Light {
            shape,
            color: point().abs(),
            strength: point().length(),
        })
        .collect();
    assert_same(&scene, &saved(&scene), "lights");
}

#[test]
fn clear_skies_saved_are_the_same() {
    let mut scene = sample("minimal.toml");
    scene.sky = None;
    scene.clear_sky = Some(ClearSky {
        turbidity: 2.0 + 0.1,
        ground: DVec3::new(0.0, 1.0, 0.3),
        strength: 0.7,
    });
    scene.sun = Some(Sun {
        direction: DVec3::Z,
        color: DVec3::ONE,
        strength: 0.0,
        angle_degrees: 0.0,
    });
    assert_same(&scene, &saved(&scene), "clear sky");
}

#[test]
fn environments_saved_are_the_same() {
    let mut scene = sample("minimal.toml");
    let mut random = Random::new(21, 0);
    scene.sky = None;
    for (width, height) in [(1, 1), (7, 3), (200, 130)] {
        let mut component = || match random.below(20) {
            0 => 0.0,
            1 => f32::MAX,
            2 => f32::from_bits(1),
            _ => random.log_uniform(1e-30, 1e30) as f32,
        };
        let pixels = (0..width * height).map(|_| [component(), component(), component()]);
        let pixels = pixels.collect();
        let mut environment = Environment::new(width, height, pixels).expect("radiance");
        environment.strength = 0.1 + 0.2;
        environment.rotate_degrees = -370.25;
        scene.environment = Some(environment);
        assert_same(&scene, &saved(&scene), "environment");
    }
}

/// The direction of a light is normalized when it is stated, and not again when it is saved.
#[test]
fn directions_of_the_sun_saved_are_the_same() {
    let mut scene = sample("minimal.toml");
    let mut random = Random::new(19, 0);
    let mut direct = Vec::new();
    for _ in 0..300 {
        direct.push(random.direction());
    }
    for degrees in 0..300 {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("sun.toml");
        let (elevation, azimuth) = (0.3 * f64::from(degrees), 7.7 * f64::from(degrees));
        let angles = format!("elevation_degrees = {elevation}\nazimuth_degrees = {azimuth}");
        let solid = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1";
        fs::write(&path, format!("[sun]\n{angles}\n{solid}\n")).expect("a scene file");
        let stated = load(&path).unwrap_or_else(|error| panic!("{error}"));
        direct.push(stated.sun.expect("a sun").direction);
    }
    for direction in direct {
        scene.sun = Some(Sun {
            direction,
            color: DVec3::ONE,
            strength: 2.5,
            angle_degrees: 0.25,
        });
        assert_same(&scene, &saved(&scene), &format!("{direction:?}"));
    }
}

/// A file of each kind of solid, from formats that scenes name.
#[test]
fn neurons_with_gaps_in_their_numbers_saved_are_the_same() {
    let swc = "1 1 0 0 0 2 -1\n2 3 0 0 5 0.5 1\n3 3 0 0 5 0.5 2\n4 3 0 4 5 0.25 3\n5 3 0 9 5 0 4\n";
    for joints in ["", "joints = \"flat\"\n", "joints = \"round\"\n"] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("neuron.swc"), swc).expect("a neuron");
        let path = folder.path().join("neuron.toml");
        let text = format!("[[swc]]\nfile = \"neuron.swc\"\ndegenerate = \"skip\"\n{joints}");
        fs::write(&path, text).expect("a scene file");
        let scene = load(&path).unwrap_or_else(|error| panic!("{error}"));
        let copy = saved(&scene);
        assert_same(&scene, &copy, joints);
        assert_same_hits(scene, copy, 500);
    }
}
