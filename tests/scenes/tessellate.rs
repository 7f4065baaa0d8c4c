//! Scenes as meshes, read back from OBJ and PLY files by parsers of this test's
//! own, and held against the solids that the scene describes.

use std::collections::HashSet;
use std::ops::ControlFlow;

use cyltrace::math::{ChildFromParent, PlacementErrors, Random, UNIT_ROUNDOFF};
use cyltrace::meshes::{Format, MeshFileError, Plan};
use cyltrace::scene::{
    CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, Solids,
};
use cyltrace::solid::tessellation::{Fit, prism_size};
use cyltrace::solid::{Caps, Cylinder, Part, surface_point};
use glam::{DAffine3, DMat3, DVec3};
use test_support::random_rotation;

/// A mesh as read back; of OBJ with the names of its groups.
#[derive(Debug, Default, PartialEq)]
struct Mesh {
    vertices: Vec<DVec3>,
    triangles: Vec<[usize; 3]>,
    comments: Vec<String>,
    groups: Vec<String>,
}

fn read_obj(bytes: &[u8]) -> Mesh {
    let mut mesh = Mesh::default();
    for line in std::str::from_utf8(bytes).expect("OBJ is text").lines() {
        let (key, rest) = line.split_once(' ').expect("a key");
        let mut words = rest.split(' ');
        let mut word = || words.next().expect("three words");
        match key {
            "#" => mesh.comments.push(rest.into()),
            "g" => mesh.groups.push(rest.into()),
            "v" => {
                let vertex = [(); 3].map(|()| word().parse().expect("a number"));
                mesh.vertices.push(vertex.into());
            }
            "f" => {
                let corner = |word: &str| word.parse::<usize>().expect("a number") - 1;
                mesh.triangles.push([(); 3].map(|()| corner(word())));
            }
            _ => panic!("{line}"),
        }
    }
    mesh
}

fn read_ply(bytes: &[u8]) -> Mesh {
    let end = b"end_header\n";
    let start = bytes.windows(end.len()).position(|w| w == end).unwrap() + end.len();
    let header = std::str::from_utf8(&bytes[..start]).unwrap();
    let after = |key: &'static str| header.lines().filter_map(move |l| l.strip_prefix(key));
    let count = |key| after(key).next().unwrap().parse::<usize>().unwrap();
    let without: Vec<&str> = header
        .lines()
        .filter(|line| !line.starts_with("comment ") && !line.starts_with("element "))
        .collect();
    let properties = [
        "property double x",
        "property double y",
        "property double z",
        "property list uchar uint vertex_indices",
    ];
    assert_eq!(without[..2], ["ply", "format binary_little_endian 1.0"]);
    assert_eq!(without[2..], [&properties[..], &["end_header"]].concat());
    let (vertices, faces) = bytes[start..].split_at(24 * count("element vertex "));
    assert_eq!(faces.len(), 13 * count("element face "));
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().unwrap());
    let corner = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap()) as usize;
    Mesh {
        vertices: vertices
            .chunks(24)
            .map(|v| DVec3::new(number(&v[..8]), number(&v[8..16]), number(&v[16..])))
            .collect(),
        triangles: faces
            .chunks(13)
            .map(|face| {
                assert_eq!(face[0], 3);
                [&face[1..5], &face[5..9], &face[9..]].map(corner)
            })
            .collect(),
        comments: after("comment ").map(String::from).collect(),
        groups: Vec::new(),
    }
}

fn written(scene: &Scene, plan: &Plan, format: Format) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut items = 0;
    format
        .write(scene, plan, "a scene", &mut bytes, &mut |more| {
            items += more;
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(u128::from(items), plan.vertices() + plan.triangles());
    bytes
}

fn records(random: &mut Random, count: u32) -> Vec<CylinderRecord> {
    (0..count)
        .map(|primitive| {
            let p0 = random.direction() * random.log_uniform(1e-2, 1e2);
            let p1 = p0 + random.direction() * random.log_uniform(1e-2, 1e1);
            let caps = [Caps::Both, Caps::P0, Caps::P1, Caps::None][primitive as usize % 4];
            let cylinder = Cylinder::new(p0, p1, random.log_uniform(1e-2, 1e1), caps).unwrap();
            CylinderRecord::new(&cylinder, primitive, MaterialIndex(0))
        })
        .collect()
}

/// A placement that turns, stretches unevenly, and mirrors every other time.
fn placement(random: &mut Random, of: u32) -> Placement {
    let mut factor = || random.log_uniform(0.2, 5.0);
    let factors = DVec3::new(factor(), factor(), factor());
    let mirror = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let matrix = random_rotation(random)
        * DMat3::from_diagonal(factors * DVec3::new(1.0, mirror, 1.0))
        * random_rotation(random);
    let translation = random.direction() * random.log_uniform(1e-2, 1e2);
    Placement {
        of: PrototypeIndex(of),
        parent_from_child: DAffine3::from_mat3_translation(matrix, translation),
    }
}

/// A root with solids that places two prototypes, one of which places the other.
fn random_scene(seed: u64) -> Scene {
    let mut random = Random::new(seed, 0);
    let mut prototype = |name: &str, cylinders, places: &[u32]| Prototype {
        name: name.into(),
        solids: Solids::of_cylinders(records(&mut random, cylinders)),
        placements: places
            .iter()
            .map(|&of| placement(&mut random, of))
            .collect(),
        ..Prototype::default()
    };
    let root = prototype("", 4, &[1, 2, 1]);
    let tree = prototype("my tree/1", 3, &[2, 2]);
    let leaf = prototype("leaf", 5, &[]);
    Scene::new(vec![root, tree, leaf])
}

/// A solid, where it is placed, and the name of its group.
struct Placed {
    cylinder: Cylinder,
    world_from_solid: DAffine3,
    group: String,
}

/// All solids of a scene in the order of the file.
fn placed(scene: &Scene, index: u32, world_from_here: DAffine3, path: &str) -> Vec<Placed> {
    let here = &scene.prototypes[index as usize];
    let name = here.name.replace([' ', '/'], "_");
    let name = if index == 0 { "scene" } else { &name };
    let own = here.solids.cylinders.iter().map(|record| Placed {
        cylinder: record.cylinder(),
        world_from_solid: world_from_here,
        group: format!("{name}{path}"),
    });
    let mut all: Vec<Placed> = own.collect();
    for (number, placement) in here.placements.iter().enumerate() {
        let map = world_from_here * placement.parent_from_child;
        all.extend(placed(
            scene,
            placement.of.0,
            map,
            &format!("{path}/{number}"),
        ));
    }
    all
}

/// Whether the triangles are a closed surface of one piece without holes: every
/// edge is met once in each direction, and corners - edges + faces is 2.
fn is_sphere(corners: usize, triangles: &[[usize; 3]]) -> bool {
    let edges: HashSet<[usize; 2]> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .collect();
    edges.len() == 3 * triangles.len()
        && edges.iter().all(|&[a, b]| edges.contains(&[b, a]))
        && corners + triangles.len() == edges.len() / 2 + 2
}

/// Holds the prism of one solid against the solid.
fn judge(solid: &Placed, vertices: &[DVec3], triangles: &[[usize; 3]], plan: &Plan, what: &str) {
    let (cylinder, map) = (&solid.cylinder, solid.world_from_solid);
    let back = ChildFromParent::new(&map);
    let errors = PlacementErrors::new(&map, &back);
    let (p0, a) = (cylinder.p0(), cylinder.p1() - cylinder.p0());
    let radius = cylinder.radius();
    let into_solid = |point: DVec3| back.vector(point - back.translation());
    // What the way back adds here: this map is composed of two and inverted,
    // each with some 20 roundings of the sizes involved.
    let size = vertices.iter().fold(
        map.translation.length() + errors.stretch * (p0.length() + a.length() + radius),
        |size, vertex| size.max(vertex.length()),
    );
    let own = 64.0 * UNIT_ROUNDOFF * errors.condition * size;
    let slack = (plan.rounding() + own) / errors.shrink;

    for (number, vertex) in vertices.iter().enumerate() {
        let from_p0 = into_solid(*vertex) - p0;
        let along = from_p0.dot(a) / a.length();
        let across = (from_p0 - a * (from_p0.dot(a) / a.length_squared())).length();
        assert!(
            (-slack..=a.length() + slack).contains(&along),
            "{what}: vertex {number} at {along}"
        );
        let is_corner = number < 2 * plan.segments() as usize;
        let (low, high) = match (plan.fit(), is_corner) {
            (_, false) => (0.0, 0.0),
            (Fit::Inscribed, _) => (radius, radius),
            (Fit::Circumscribed, _) => (radius, f64::INFINITY),
        };
        assert!(
            (low - slack..=high + slack).contains(&across),
            "{what}: vertex {number}, {across} from the axis"
        );
    }
    for corners in triangles {
        let [a_, b_, c_] = corners.map(|i| vertices[i]);
        // Corners and the middles of edges and face, each against the point of
        // the surface that is nearest in the solid's space.
        let normal = (b_ - a_).cross(c_ - a_).normalize();
        let middles = [(a_ + b_) / 2.0, (b_ + c_) / 2.0, (c_ + a_) / 2.0];
        for point in middles
            .into_iter()
            .chain([a_, b_, c_, (a_ + b_ + c_) / 3.0])
        {
            let from_p0 = into_solid(point) - p0;
            let nearest = [Part::Side, Part::Cap0, Part::Cap1]
                .map(|part| surface_point(cylinder, part, from_p0).point)
                .map(|surface| (map.transform_point3(surface) - point).length())
                .into_iter()
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest <= plan.deviation() + own,
                "{what}: {nearest} from the surface"
            );
        }
        // The middle of the solid is on the inner side.
        let inside = map.transform_point3(p0 + a / 2.0);
        assert!(
            normal.dot(a_ - inside) > 0.0,
            "{what}: {corners:?} faces inward"
        );
    }
    if cylinder.caps() != Caps::Both {
        return;
    }
    assert!(is_sphere(vertices.len(), triangles), "{what}: not closed");
    let six_times: f64 = triangles
        .iter()
        .map(|corners| corners.map(|i| vertices[i] - vertices[0]))
        .map(|[a, b, c]| a.dot(b.cross(c)))
        .sum();
    let exact = std::f64::consts::PI * radius * radius * a.length();
    let exact = exact * map.matrix3.determinant().abs();
    match plan.fit() {
        Fit::Inscribed => assert!(six_times / 6.0 < exact, "{what}"),
        Fit::Circumscribed => assert!(six_times / 6.0 > exact, "{what}"),
    }
}

#[test]
fn meshes_read_back_are_prisms_of_the_placed_solids() {
    for (seed, segments, fit) in [
        (1, 3, Fit::Inscribed),
        (2, 3, Fit::Circumscribed),
        (3, 16, Fit::Inscribed),
        (4, 16, Fit::Circumscribed),
        (5, 65, Fit::Inscribed),
        (6, 65, Fit::Circumscribed),
    ] {
        let scene = random_scene(seed);
        let plan = Plan::new(&scene, segments, fit).unwrap();
        let obj = written(&scene, &plan, Format::Obj);
        let ply = written(&scene, &plan, Format::Ply);
        assert_eq!(
            ply.len() as u128,
            Format::Ply.file_bytes(&plan, "a scene"),
            "seed {seed}"
        );
        let most = Format::Obj.file_bytes(&plan, "a scene");
        assert!((most / 2..=most).contains(&(obj.len() as u128)));
        let (obj, ply) = (read_obj(&obj), read_ply(&ply));
        assert_eq!(
            (&obj.vertices, &obj.triangles),
            (&ply.vertices, &ply.triangles)
        );
        assert_eq!(obj.comments, ply.comments);
        for line in [
            "scene a scene".to_owned(),
            format!("segments {segments}"),
            format!("fit {}", fit.name()),
            format!("deviation {:?}", plan.deviation()),
        ] {
            assert!(obj.comments.contains(&line), "{line}: {:?}", obj.comments);
        }
        assert_eq!(obj.vertices.len() as u128, plan.vertices());
        assert_eq!(obj.triangles.len() as u128, plan.triangles());

        let solids = placed(&scene, 0, DAffine3::IDENTITY, "");
        assert_eq!(solids.len() as u128, plan.solids());
        let mut groups: Vec<&str> = solids.iter().map(|solid| solid.group.as_str()).collect();
        groups.dedup();
        assert_eq!(obj.groups, groups, "seed {seed}");
        assert!(groups.contains(&"my_tree_1/0") && groups.contains(&"leaf/2/1"));
        let mirrored = solids
            .iter()
            .filter(|solid| solid.world_from_solid.matrix3.determinant() < 0.0);
        assert!((1..solids.len()).contains(&mirrored.count()), "seed {seed}");

        let (mut first_vertex, mut first_triangle) = (0, 0);
        for (number, solid) in solids.iter().enumerate() {
            let (vertices, triangles) = prism_size(solid.cylinder.caps(), segments);
            let end = first_triangle + triangles as usize;
            let own: Vec<[usize; 3]> = obj.triangles[first_triangle..end]
                .iter()
                .map(|corners| corners.map(|corner| corner - first_vertex))
                .collect();
            let end_vertex = first_vertex + vertices as usize;
            let what = format!("seed {seed}, solid {number}, {segments} sides");
            judge(
                solid,
                &obj.vertices[first_vertex..end_vertex],
                &own,
                &plan,
                &what,
            );
            (first_vertex, first_triangle) = (end_vertex, end);
        }
    }
}

#[test]
fn deviation_of_unplaced_solids_is_the_sagitta_and_of_placed_ones_stretched() {
    let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z, 2.0, Caps::Both).unwrap();
    let record = CylinderRecord::new(&cylinder, 0, MaterialIndex(0));
    let leaf = Prototype {
        name: "leaf".into(),
        solids: Solids::of_cylinders(vec![record]),
        placements: Vec::new(),
        ..Prototype::default()
    };
    let root = |of: u32, factors: DVec3| Prototype {
        name: String::new(),
        solids: Solids::default(),
        placements: vec![Placement {
            of: PrototypeIndex(of),
            parent_from_child: DAffine3::from_scale(factors),
        }],
        ..Prototype::default()
    };
    let angle = std::f64::consts::PI / 8.0;
    for (fit, expected) in [
        (Fit::Inscribed, 2.0 * (1.0 - libm::cos(angle))),
        (Fit::Circumscribed, 2.0 * (1.0 / libm::cos(angle) - 1.0)),
    ] {
        for (scene, factor) in [
            (Scene::new(vec![leaf.clone()]), 1.0),
            (
                Scene::new(vec![root(1, DVec3::new(3.0, 0.5, -1.0)), leaf.clone()]),
                3.0,
            ),
        ] {
            let plan = Plan::new(&scene, 8, fit).unwrap();
            let seen = plan.deviation() / (factor * expected);
            assert!((1.0..1.0 + 1e-10).contains(&seen), "{seen}");
            assert!(plan.rounding() < 1e-13);
        }
    }
}

#[test]
fn meshes_too_large_or_interrupted_are_refused() {
    let scene = random_scene(1);
    let plan = Plan::new(&scene, 64, Fit::Inscribed).unwrap();
    for format in [Format::Obj, Format::Ply] {
        let bytes = format.file_bytes(&plan, "x") as u64;
        format.check(&plan, "x", bytes).unwrap();
        let refused = format.check(&plan, "x", bytes - 1).unwrap_err();
        assert!(
            matches!(refused, MeshFileError::TooLarge { .. }),
            "{refused}"
        );
        let stopped = format.write(&scene, &plan, "x", &mut Vec::new(), &mut |_| {
            ControlFlow::Break(())
        });
        assert!(matches!(stopped, Err(MeshFileError::Cancelled)));
    }
    for segments in [0, 2, 4097] {
        let refused = Plan::new(&scene, segments, Fit::Inscribed).unwrap_err();
        assert!(
            refused
                .to_string()
                .starts_with(&format!("{segments} segments"))
        );
    }

    // Forty levels that place the next ten times each: counted, not walked.
    let mut prototypes: Vec<Prototype> = (1..=40)
        .map(|next| Prototype {
            name: format!("level {next}"),
            solids: Solids::default(),
            placements: vec![
                Placement {
                    of: PrototypeIndex(next),
                    parent_from_child: DAffine3::IDENTITY,
                };
                10
            ],
            ..Prototype::default()
        })
        .collect();
    prototypes.push(Prototype {
        name: "leaf".into(),
        solids: Solids::of_cylinders(records(&mut Random::new(1, 1), 1)),
        placements: Vec::new(),
        ..Prototype::default()
    });
    let scene = Scene::new(prototypes);
    let plan = Plan::new(&scene, 3, Fit::Inscribed).unwrap();
    // 10^40 solids: more than can be counted.
    assert_eq!(plan.solids(), u128::MAX);
    let refused = Format::Ply.check(&plan, "x", u64::MAX).unwrap_err();
    assert!(
        matches!(refused, MeshFileError::TooLarge { .. }),
        "{refused}"
    );
}
