//! Random scenes of all kinds of solids, in any order and with gaps between their numbers.

use cyltrace::math::{Orientation, Random};
use cyltrace::scene::{
    Composition, CylinderList, CylinderRecord, Material, MaterialIndex, Placement, Prototype,
    PrototypeIndex, Records, Scene, SolidRecord,
};
use cyltrace::solid::{AnySolid, Caps, Cone, Cuboid, Cylinder, Disk, RoundedCone, Sphere};
use glam::{DAffine3, DMat3, DVec3};

const MATERIALS: u16 = 4;

/// A scene of nested prototypes. An odd seed gives f32 records.
pub fn random_scene(seed: u64) -> Scene {
    let mut random = Random::new(seed, 1);
    let records = match seed % 2 {
        0 => Records::F64,
        _ => Records::F32,
    };
    let mut prototypes = vec![prototype(&mut random, "", records, 30)];
    for name in ["\"tree\"", "a\\b", "木\n"] {
        let solids = [4, 60, 200][random.below(3) as usize];
        prototypes.push(prototype(&mut random, name, records, solids));
    }
    // Each prototype places those behind it, often one after the other or in turns.
    for parent in 0..3 {
        for _ in 0..1 + random.below(3) {
            let of = parent + 1 + random.below(3 - parent);
            let run = [1, 3, 40][random.below(3) as usize];
            for _ in 0..run {
                let placement = placement(&mut random, of as u32);
                prototypes[parent as usize].placements.push(placement);
            }
        }
    }
    let mut scene = Scene::new(prototypes);
    scene.materials.extend((1..MATERIALS).map(|index| {
        let color = DVec3::new(random.unit(), random.unit(), random.unit());
        Material::diffuse(format!("material \"{index}\""), color)
    }));
    scene
}

fn placement(random: &mut Random, of: u32) -> Placement {
    let scale = DVec3::new(random.uniform(0.5, 2.0), random.uniform(-2.0, -0.5), 1.0);
    let turn = Orientation::IDENTITY.rotated(random.direction(), random.uniform(0.0, 360.0));
    let matrix = turn.world_from_object() * DMat3::from_diagonal(scale);
    Placement {
        of: PrototypeIndex(of),
        parent_from_child: DAffine3::from_mat3_translation(matrix, point(random)),
    }
}

fn prototype(random: &mut Random, name: &str, records: Records, solids: u32) -> Prototype {
    let mut prototype = Prototype {
        name: name.to_owned(),
        ..Prototype::default()
    };
    prototype.solids.cylinders = CylinderList::new(records);
    // One prototype in three is of cylinders without gaps.
    let is_mixed = random.below(3) > 0;
    let mut primitive = 0;
    for _ in 0..solids {
        let material = MaterialIndex(random.below(u64::from(MATERIALS)) as u16);
        let kind = if is_mixed { random.below(9) } else { 0 };
        let lists = &mut prototype.solids;
        match kind {
            0..3 => {
                let record = CylinderRecord::new(&cylinder(random), primitive, material);
                lists.cylinders.push(record).expect("a cylinder in f32");
            }
            3 => {
                let solid = composition(random, 3);
                let record = SolidRecord::new(solid, primitive, material);
                lists.compositions.push(record);
            }
            _ => {
                let record = SolidRecord::new(solid(random, kind), primitive, material);
                lists.push(record).expect("a solid");
            }
        }
        primitive += 1;
        if is_mixed && random.below(10) == 0 {
            primitive += random.below(1 << 20) as u32;
        }
    }
    prototype
}

fn point(random: &mut Random) -> DVec3 {
    random.direction() * random.uniform(0.0, 10.0)
}

fn radius(random: &mut Random) -> f64 {
    random.log_uniform(1e-3, 3.0)
}

fn caps(random: &mut Random) -> Caps {
    Caps::at(random.below(2) == 0, random.below(2) == 0)
}

fn cylinder(random: &mut Random) -> Cylinder {
    let caps = caps(random);
    Cylinder::new(point(random), point(random), radius(random), caps).expect("a cylinder")
}

fn solid(random: &mut Random, kind: u64) -> AnySolid {
    match kind {
        4 => Sphere::new(point(random), radius(random))
            .expect("a sphere")
            .into(),
        5 => {
            let sizes = DVec3::new(radius(random), radius(random), radius(random));
            let turn =
                Orientation::IDENTITY.rotated(random.direction(), random.uniform(0.0, 360.0));
            Cuboid::new(point(random), sizes, turn)
                .expect("a cuboid")
                .into()
        }
        6 => {
            let (p0, p1, caps) = (point(random), point(random), caps(random));
            Cone::new(p0, p1, radius(random), 0.0, caps)
                .expect("a cone")
                .into()
        }
        7 => {
            let (p0, p1) = (point(random), point(random));
            let cone = RoundedCone::new(p0, p1, radius(random), radius(random));
            cone.expect("a rounded cone").into()
        }
        _ => {
            let (center, normal) = (point(random), point(random));
            Disk::new(center, normal, radius(random))
                .expect("a disk")
                .into()
        }
    }
}

/// A tree of set operations, with `levels` inside each other at most.
fn composition(random: &mut Random, levels: u32) -> Composition {
    let parts = (0..1 + random.below(3)).map(|_| match levels > 1 && random.below(3) == 0 {
        true => composition(random, levels - 1),
        false => Composition::Solid(match 4 + random.below(4) {
            6 => {
                let (p0, p1) = (point(random), point(random));
                let cone = Cone::new(p0, p1, radius(random), radius(random), Caps::Both);
                cone.expect("a cone").into()
            }
            kind => solid(random, kind),
        }),
    });
    let parts: Vec<_> = parts.collect();
    match random.below(3) {
        0 => Composition::Union(parts),
        1 => Composition::Intersection(parts),
        _ => Composition::Difference(parts),
    }
}
