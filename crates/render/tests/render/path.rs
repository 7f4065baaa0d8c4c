//! Light of integrator `path` for which the answer is known: closed forms, and other integrators.

use std::f64::consts::PI;

use cyltrace::math::Orientation;
use cyltrace::scene::{
    Background, Color, Frame, Integrator, Light, LightShape, Material, MaterialIndex, MaterialKind,
    Projection, Scene, Sky, SolidRecord, Sun,
};
use cyltrace::solid::{AnySolid, Caps, Cuboid, Cylinder, Disk, Sphere};
use glam::DVec3;

use super::stage::{self, GROUND, mean, picture};

/// The reflectance of the ground.
const REFLECTANCE: DVec3 = DVec3::new(0.5, 0.25, 1.0);

/// A point of the ground, as a square of 2 mm shows it.
fn ground() -> Scene {
    let mut scene = stage::scene(&[GROUND]);
    scene.background = Background::Color(DVec3::ZERO);
    scene.render.integrator = Integrator::Path;
    scene.camera.projection = Projection::Orthographic {
        height: Some(0.002),
    };
    // Below the lights, so that they do not hide the ground.
    scene.camera.frame = Frame::LookAt {
        position: DVec3::new(0.0, 0.0, 0.1),
        look_at: DVec3::ZERO,
        up: DVec3::Y,
    };
    scene
}

fn material(kind: MaterialKind) -> Material {
    Material {
        name: format!("{kind:?}"),
        color: Color::Constant(DVec3::ONE),
        kind,
    }
}

/// Adds a solid of a material of its own.
fn add(scene: &mut Scene, solid: impl Into<AnySolid>, kind: MaterialKind) {
    let index = MaterialIndex(scene.materials.len() as u16);
    scene.materials.push(material(kind));
    let solids = &mut scene.prototypes[0].solids;
    let number = solids.len() as u32;
    let record = SolidRecord::new(solid.into(), number, index);
    solids.push(record).expect("a solid");
}

/// The mean of the picture, which must be the expected color within 4 standard deviations of the
/// mean of the pixels, or a relative 10^-6 where they are equal.
fn assert_mean(scene: Scene, spp: u32, expected: DVec3, what: &str) {
    let film = picture(scene, spp);
    let count = film.pixels().len() as f64;
    let found = mean(&film);
    let pixels = film.pixels().iter();
    let squares: DVec3 = pixels
        .map(|pixel| DVec3::from(pixel.map(f64::from)) - found)
        .map(|apart| apart * apart)
        .sum();
    let deviation = squares / count / (count - 1.0);
    let deviation = DVec3::from(deviation.to_array().map(f64::sqrt));
    let accepted = deviation * 4.0 + expected * 1e-6;
    let apart = (found - expected).abs();
    assert!(
        apart.cmple(accepted).all(),
        "{what}: {found}, not {expected} +- {deviation}"
    );
    // A wrong factor must not hide in noise.
    assert!(
        deviation.max_element() < 0.02 * expected.max_element(),
        "{what}: {deviation}"
    );
}

const PLACES: [(f64, f64); 3] = [(0.0, 0.0), (1.0, 0.5), (4.0, -2.0)];

/// A light shape at a place above the ground.
fn with_light(shape: LightShape) -> Scene {
    let mut scene = ground();
    scene.lights.push(Light {
        shape,
        color: DVec3::new(1.0, 0.5, 0.25),
        strength: 8.0,
    });
    scene
}

/// What the ground sends out under an irradiance of the light of `with_light` of strength 1.
fn reflected(irradiance: f64) -> DVec3 {
    REFLECTANCE * DVec3::new(8.0, 4.0, 2.0) * irradiance / PI
}

/// `E = I cos / d²`.
#[test]
fn point_light_falls_with_the_square_of_the_distance() {
    for (x, y) in PLACES {
        let position = DVec3::new(x, y, 2.0);
        let scene = with_light(LightShape::Point { position });
        let squared = position.length_squared();
        let expected = reflected(2.0 / (squared * squared.sqrt()));
        // The square seen is not a point.
        let film = picture(scene, 4);
        let apart = (mean(&film) - expected).abs() / expected;
        assert!(apart.max_element() < 1e-5, "{position}: {apart}");
    }
}

/// A sphere that is all above the horizon gives `E = L π (r / d)² cos`.
#[test]
fn sphere_light_and_a_solid_sphere_of_light_give_what_their_solid_angle_does() {
    for (x, y) in PLACES {
        let (center, radius) = (DVec3::new(x, y, 2.0), 0.75);
        let squared = center.length_squared();
        let cosine = center.z / squared.sqrt();
        let expected = reflected(PI * radius * radius / squared * cosine);
        let scene = with_light(LightShape::Sphere { center, radius });
        assert_mean(scene, 64, expected, "sphere light");

        let mut scene = ground();
        let sphere = Sphere::new(center, radius).expect("a sphere");
        add(&mut scene, sphere, MaterialKind::Light { strength: 8.0 });
        let last = scene.materials.last_mut().expect("added");
        last.color = Color::Constant(DVec3::new(1.0, 0.5, 0.25));
        assert_mean(scene, 256, expected, "solid sphere");
    }
}

/// A parallel rectangle `a x b` with a corner above the point at the height `h` has the form
/// factor `(A atan B + C atan D) / 2π` with `A = a / √(a² + h²)`, `B = b / √(a² + h²)` and the
/// other two with a and b exchanged.
#[test]
fn rectangle_light_and_a_solid_box_of_light_have_the_form_factor_of_a_rectangle() {
    let (a, b, h) = (1.5_f64, 0.8_f64, 1.2_f64);
    let part = |a: f64, b: f64| {
        let root = (a * a + h * h).sqrt();
        a / root * libm::atan(b / root)
    };
    let factor = (part(a, b) + part(b, a)) / (2.0 * PI);
    let expected = reflected(PI * factor);
    let corner = DVec3::new(0.0, 0.0, h);
    // The cross product of the edges points down.
    let edges = [DVec3::Y * b, DVec3::X * a];
    let scene = with_light(LightShape::Rectangle { corner, edges });
    assert_mean(scene, 64, expected, "rectangle light");
    let turned = [edges[1], edges[0]];
    let scene = with_light(LightShape::Rectangle {
        corner,
        edges: turned,
    });
    assert_eq!(
        mean(&picture(scene, 4)),
        DVec3::ZERO,
        "it emits on one side"
    );

    // The lower face of a flat box is the same; its sides are as good as edge-on.
    let mut scene = ground();
    let half = DVec3::new(0.5 * a, 0.5 * b, 1e-6);
    let center = corner + half;
    let cuboid = Cuboid::new(center, half, Orientation::default()).expect("a box");
    add(&mut scene, cuboid, MaterialKind::Light { strength: 8.0 });
    let last = scene.materials.last_mut().expect("added");
    last.color = Color::Constant(DVec3::new(1.0, 0.5, 0.25));
    assert_mean(scene, 256, expected, "solid box");
}

/// A parallel disk above the point: `E = π L r² / (r² + h²)`.
#[test]
fn disk_of_light_has_the_form_factor_of_a_disk() {
    let (radius, height) = (1.0, 0.7);
    let mut scene = ground();
    let disk = Disk::new(DVec3::Z * height, DVec3::Z, radius).expect("a disk");
    add(&mut scene, disk, MaterialKind::Light { strength: 3.0 });
    let squared = radius * radius;
    let factor = squared / (squared + height * height);
    assert_mean(scene, 64, REFLECTANCE * 3.0 * factor, "disk");
}

/// A sun of any extent gives the irradiance `E cos` while all of it is above the horizon.
#[test]
fn sun_gives_its_irradiance_whatever_its_extent() {
    for angle_degrees in [0.0, 0.53, 20.0, 90.0] {
        let mut scene = ground();
        let elevation: f64 = 50.0_f64.to_radians();
        scene.sun = Some(Sun {
            direction: DVec3::new(libm::cos(elevation), 0.0, libm::sin(elevation)),
            color: DVec3::ONE,
            strength: 2.0,
            angle_degrees,
        });
        let expected = REFLECTANCE * 2.0 * libm::sin(elevation) / PI;
        scene.render.integrator = Integrator::Sun;
        assert_mean(scene.clone(), 64, expected, "sun");
        scene.render.integrator = Integrator::Path;
        assert_mean(scene, 64, expected, "path");
    }
}

/// In a uniform surrounding, solids that lose no light cannot be seen.
#[test]
fn white_solids_of_every_material_vanish_in_a_uniform_sky() {
    let (rough, ior) = (0.5, 1.5);
    let kinds = [
        MaterialKind::Diffuse,
        MaterialKind::Metal { roughness: 0.0 },
        MaterialKind::Metal { roughness: rough },
        MaterialKind::Plastic {
            roughness: 0.0,
            ior,
        },
        MaterialKind::Plastic {
            roughness: rough,
            ior,
        },
        MaterialKind::Glass {
            roughness: 0.0,
            ior,
        },
    ];
    for kind in kinds {
        let mut scene = stage::scene(&[]);
        scene.render.integrator = Integrator::Path;
        scene.render.max_depth = 4000;
        scene.sky = Some(Sky {
            color: DVec3::ONE,
            strength: 2.0,
        });
        // Bodies that see each other, overlap and lie in each other.
        for (center, radius) in [
            (DVec3::new(0.0, 0.0, 0.0), 0.5),
            (DVec3::new(0.6, 0.0, 0.2), 0.4),
            (DVec3::new(-0.1, 0.0, 0.1), 0.2),
        ] {
            add(
                &mut scene,
                Sphere::new(center, radius).expect("a sphere"),
                kind,
            );
        }
        let (p0, p1) = (DVec3::new(-0.9, -0.6, 0.0), DVec3::new(0.9, 0.4, 0.3));
        let rod = Cylinder::new(p0, p1, 0.1, Caps::Both).expect("a rod");
        add(&mut scene, rod, kind);
        let film = picture(scene, 64);
        let found = mean(&film).x;
        // 10^-3 of the albedo's table at each reflection.
        assert!((found / 2.0 - 1.0).abs() < 3e-3, "{kind:?}: {found}");
    }
}

/// A slab of glass before a wide light lets `(1 - R) / (1 + R)` through, with the reflectance `R`
/// of one face, and so do slabs that overlap or touch. Two slabs apart let `(1 - R) / (1 + 3 R)`
/// through.
#[test]
fn slabs_of_glass_transmit_what_their_faces_do() {
    let glass = MaterialKind::Glass {
        roughness: 0.0,
        ior: 1.5,
    };
    let face: f64 = 0.04;
    let one = (1.0 - face) / (1.0 + face);
    let two = (1.0 - face) / (1.0 + 3.0 * face);
    let slab = |low: f64, high: f64| {
        Cylinder::new(DVec3::Z * low, DVec3::Z * high, 50.0, Caps::Both).expect("a slab")
    };
    type Slabs = &'static [(f64, f64)];
    let cases: [(Slabs, f64, &str); 6] = [
        (&[(0.0, 1.0)], one, "one slab"),
        (&[(0.0, 1.0), (0.5, 2.0)], one, "overlapping"),
        (&[(0.0, 3.0), (1.0, 2.0)], one, "one in the other"),
        (&[(0.0, 1.0), (1.0, 2.0)], one, "touching"),
        (&[(0.0, 1.0), (0.0, 1.0)], one, "the same twice"),
        (&[(0.0, 1.0), (1.5, 2.0)], two, "apart"),
    ];
    for (slabs, transmitted, what) in cases {
        let mut scene = stage::scene(&[]);
        scene.background = Background::Color(DVec3::ZERO);
        scene.render.integrator = Integrator::Path;
        scene.render.max_depth = 100;
        for &(low, high) in slabs {
            add(&mut scene, slab(low, high), glass);
        }
        let below = Cylinder::new(DVec3::Z * -3.0, DVec3::Z * -2.0, 50.0, Caps::Both);
        add(
            &mut scene,
            below.expect("a light"),
            MaterialKind::Light { strength: 1.0 },
        );
        assert_mean(scene, 256, DVec3::splat(transmitted), what);
    }
}

/// What a stack of faces between these indices transmits. Intensities of faces that reflect `R` and
/// `S` add up to the transmission `(1 - R) (1 - S) / (1 - R S)`, and a stack without losses reflects
/// what it does not transmit.
fn through(indices: &[f64]) -> f64 {
    indices.windows(2).fold(1.0, |through, pair| {
        let ratio = (pair[0] - pair[1]) / (pair[0] + pair[1]);
        let (one, other) = (1.0 - through, ratio * ratio);
        (1.0 - one) * (1.0 - other) / (1.0 - one * other)
    })
}

/// The light through slabs of glass, each with its ends and its index.
fn assert_through(slabs: &[(f64, f64, f64)], expected: f64, what: &str) {
    let mut scene = stage::scene(&[]);
    scene.background = Background::Color(DVec3::ZERO);
    scene.render.integrator = Integrator::Path;
    scene.render.max_depth = 100;
    let slab = |low: f64, high: f64| {
        Cylinder::new(DVec3::Z * low, DVec3::Z * high, 50.0, Caps::Both).expect("a slab")
    };
    for &(low, high, ior) in slabs {
        let roughness = 0.0;
        add(
            &mut scene,
            slab(low, high),
            MaterialKind::Glass { roughness, ior },
        );
    }
    add(
        &mut scene,
        slab(-3.0, -2.0),
        MaterialKind::Light { strength: 1.0 },
    );
    assert_mean(scene, 256, DVec3::splat(expected), what);
}

/// Two indices that touch have the faces of 1 to 1.5, 1.5 to 1.25 and 1.25 to 1.
#[test]
fn touching_glasses_of_two_indices_have_three_faces() {
    let expected = through(&[1.0, 1.5, 1.25, 1.0]);
    assert_through(
        &[(0.0, 1.0, 1.25), (1.0, 2.0, 1.5)],
        expected,
        "two glasses",
    );
}

/// Where glasses overlap, the one that comes later counts.
#[test]
fn nested_glasses_have_the_faces_of_the_later_one() {
    let (inner, outer) = ((1.0, 2.0, 2.5), (0.0, 3.0, 1.5));
    let four = through(&[1.0, 1.5, 2.5, 1.5, 1.0]);
    assert_through(&[outer, inner], four, "the inner later");
    assert_through(
        &[inner, outer],
        through(&[1.0, 1.5, 1.0]),
        "the outer later",
    );
    let three = through(&[1.0, 2.5, 1.5, 1.0]);
    assert_through(&[(0.0, 2.0, 1.5), (1.0, 3.0, 2.5)], three, "overlapping");
}

/// Within a hollow sphere of the reflectance ρ, light that was reflected once gives every place of
/// the wall the same irradiance. So a lamp of the intensity `I` gives `I cos / d²` and
/// `I ρ / (R² (1 - ρ))`.
#[test]
fn light_in_a_hollow_sphere_is_the_sum_of_all_reflections() {
    let (reflectance, radius, intensity) = (DVec3::new(0.5, 0.25, 0.8), 2.0, 3.0);
    let mut scene = ground();
    scene.prototypes[0] = Default::default();
    scene.render.max_depth = 400;
    let wall = Sphere::new(DVec3::ZERO, radius).expect("a sphere");
    add(&mut scene, wall, MaterialKind::Diffuse);
    let last = scene.materials.last_mut().expect("added");
    last.color = Color::Constant(reflectance);
    let position = DVec3::new(0.6, 0.0, 0.2);
    scene.lights.push(Light {
        shape: LightShape::Point { position },
        color: DVec3::ONE,
        strength: intensity,
    });
    scene.camera.frame = Frame::LookAt {
        position: DVec3::ZERO,
        look_at: DVec3::NEG_Z,
        up: DVec3::Y,
    };
    let to_light = position - DVec3::NEG_Z * radius;
    let squared = to_light.length_squared();
    let direct = intensity * to_light.z / (squared * squared.sqrt());
    let indirect = intensity / (radius * radius) * reflectance / (DVec3::ONE - reflectance);
    let expected = reflectance / PI * (indirect + direct);
    assert_mean(scene, 64, expected, "hollow sphere");
}

/// With two rays, a path is what the integrator `sun` computes.
#[test]
fn paths_of_one_reflection_are_sun_and_sky() {
    let roof = (
        DVec3::new(0.3, 0.2, 0.5),
        DVec3::new(-0.8, 0.1, 0.7),
        0.2,
        Caps::None,
    );
    let mut scene = stage::scene(&[GROUND, roof]);
    scene.sun = Some(Sun {
        direction: DVec3::new(0.6, 0.0, 0.8),
        color: DVec3::ONE,
        strength: 2.0,
        angle_degrees: 3.0,
    });
    scene.sky = Some(Sky {
        color: DVec3::new(0.2, 0.4, 0.6),
        strength: 1.0,
    });
    scene.render.integrator = Integrator::Sun;
    let expected = picture(scene.clone(), 1024);
    scene.render.integrator = Integrator::Path;
    scene.render.max_depth = 2;
    let found = picture(scene, 1024);
    // Pixels of half a shadow are noisiest: 0.5 of the sun's light, over the root of the samples.
    let deviation = 2.0 / PI * 0.5 / 1024.0_f64.sqrt();
    for (number, (one, other)) in found.pixels().iter().zip(expected.pixels()).enumerate() {
        let apart = (DVec3::from(one.map(f64::from)) - DVec3::from(other.map(f64::from))).abs();
        assert!(
            apart.max_element() < 5.0 * 1.5 * deviation,
            "pixel {number}: {one:?} {other:?}"
        );
    }
    let apart = (mean(&found) - mean(&expected)).abs().max_element();
    assert!(
        apart < 5.0 * deviation / f64::from(stage::SIZE),
        "means differ by {apart}"
    );
}
