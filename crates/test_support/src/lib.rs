//! What the integration tests of several crates share: random scenes and solids, rays
//! aimed at them, and 3MF files.
pub mod aim;

pub mod solids;
pub mod three_mf;
pub mod trees;

use std::sync::Arc;

use cyltrace::embree::MaxIsa;
use cyltrace::math::{Random, Ray};
use cyltrace::scene::{
    CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, Solids,
};
use cyltrace::solid::{Caps, Cylinder};
use cyltrace::tracer::{BuildTime, Layout, Options};
use glam::{DAffine3, DMat3, DVec3};

/// How many rays a test of very many traces.
pub fn ray_count() -> u64 {
    std::env::var("CYLTRACE_RAYS").map_or(100_000, |count| count.parse().expect("a number"))
}

/// The bits of a ray, for messages that can be replayed.
pub fn bits(ray: &Ray) -> String {
    let numbers = ray
        .origin
        .to_array()
        .into_iter()
        .chain(ray.direction.to_array());
    numbers
        .chain([ray.t_min, ray.t_max])
        .map(|number| format!("{:#018x}", number.to_bits()))
        .collect::<Vec<_>>()
        .join(" ")
}

/// A scene of prototypes and nothing else; the first is the root.
pub fn scene_of(prototypes: Vec<Prototype>) -> Arc<Scene> {
    Arc::new(Scene::new(prototypes))
}

/// `count` cylinders in the unit cube: long and short, thick and thin, of all
/// cap kinds, along an axis or not, some of them twice.
pub fn cylinders_in_a_box(seed: u64, count: u32) -> Vec<CylinderRecord> {
    let mut random = Random::new(seed, 1);
    let mut records: Vec<CylinderRecord> = Vec::new();
    for primitive in 0..count {
        let p0 = DVec3::new(random.unit(), random.unit(), random.unit());
        let heading = match random.below(3) {
            0 => DVec3::AXES[random.below(3) as usize],
            _ => random.direction(),
        };
        let p1 = p0 + heading * random.log_uniform(1e-3, 0.5);
        let radius = random.log_uniform(1e-5, 5e-2);
        let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
        let mut cylinder = Cylinder::new(p0, p1, radius, caps).unwrap();
        if random.below(20) == 0 && primitive > 0 {
            let twin = random.below(u64::from(primitive)) as usize;
            cylinder = records[twin].cylinder();
        }
        records.push(CylinderRecord::new(&cylinder, primitive, MaterialIndex(0)));
    }
    records
}

/// The instruction sets of this machine; `None`, which is whatever Embree uses,
/// where they go by no names.
pub fn instruction_sets() -> Vec<Option<MaxIsa>> {
    let available = MaxIsa::available();
    if available.is_empty() {
        return vec![None];
    }
    available.into_iter().map(Some).collect()
}

/// Every instruction set with each layout and time of building.
pub fn ways_to_trace() -> Vec<Options> {
    let mut ways = Vec::new();
    for max_isa in instruction_sets() {
        for layout in [Layout::Single, Layout::Block] {
            for build in [BuildTime::WhenReached, BuildTime::AtOnce] {
                ways.push(Options {
                    max_isa,
                    layout,
                    build,
                    ..Default::default()
                });
            }
        }
    }
    ways
}

/// A rotation, any as likely as any other axis and angle.
pub fn random_rotation(random: &mut Random) -> DMat3 {
    let axis = random.direction();
    let across = axis.any_orthonormal_vector();
    let (sin, cos) = libm::sincos(random.uniform(0.0, std::f64::consts::TAU));
    let turned = across * cos + axis.cross(across) * sin;
    DMat3::from_cols(axis, turned, axis.cross(turned))
}

/// Prototypes placed in each other, small against their distances.
pub struct Nested {
    pub scene: Arc<Scene>,
    /// How far the outermost is moved, in its own extents.
    pub translation: f64,
    /// The placements of the last prototype, which contains all cylinders, in the
    /// root.
    images: Vec<DAffine3>,
}

impl Nested {
    /// The cylinders that are placed.
    pub fn cylinders(&self) -> Vec<CylinderRecord> {
        self.scene.prototypes[3].solids.cylinders.iter().collect()
    }

    /// Where they are placed.
    pub fn any_image(&self, random: &mut Random) -> DAffine3 {
        self.images[random.below(self.images.len() as u64) as usize]
    }
}

/// A scale from 1e-4 to 1e4, every other time a different one for each axis, any
/// rotations and a translation of this many times the scale.
pub fn random_placement(random: &mut Random, translation: f64) -> DAffine3 {
    let scale = random.log_uniform(1e-4, 1e4);
    let stretch = match random.below(2) {
        0 => DVec3::ONE,
        _ => DVec3::new(1.0, random.uniform(0.2, 1.0), random.uniform(1.0, 5.0)),
    };
    let matrix =
        random_rotation(random) * DMat3::from_diagonal(stretch * scale) * random_rotation(random);
    let offset = random.direction() * (scale * translation);
    DAffine3::from_mat3_translation(matrix, offset)
}

/// Three levels of placements with translations up to 1e7 extents and scales
/// from 1e-4 to 1e4, some of them different for each axis.
pub fn nested_placements(seed: u64) -> Vec<Nested> {
    let mut random = Random::new(seed, 2);
    let mut place =
        |of: u32, translation: f64| placed(of, random_placement(&mut random, translation));
    let leaf = Prototype {
        solids: Solids::of_cylinders(cylinders_in_a_box(seed, 100)),
        ..Default::default()
    };
    let middle = placing((0..5).map(|_| place(3, 3.0)).collect());
    let outer = placing(vec![place(2, 1e3), place(3, 1e5)]);
    let scenes = [1.0, 1e3, 1e7].map(|translation| {
        let root = placing(vec![place(1, translation)]);
        let root_from_outer = root.placements[0].parent_from_child;
        let [through_middle, leaf_in_outer] = [0, 1].map(|place| {
            let placement: &Placement = &outer.placements[place];
            root_from_outer * placement.parent_from_child
        });
        let in_middle = middle.placements.iter();
        let images = in_middle
            .map(|inner| through_middle * inner.parent_from_child)
            .chain([leaf_in_outer])
            .collect();
        Nested {
            scene: scene_of(vec![root, outer.clone(), middle.clone(), leaf.clone()]),
            translation,
            images,
        }
    });
    scenes.into()
}

/// A placement of a prototype.
pub fn placed(of: u32, parent_from_child: DAffine3) -> Placement {
    Placement {
        of: PrototypeIndex(of),
        parent_from_child,
    }
}

/// A prototype of placements alone.
pub fn placing(placements: Vec<Placement>) -> Prototype {
    Prototype {
        placements,
        ..Default::default()
    }
}
