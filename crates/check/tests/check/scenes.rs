//! Scenes made by rule.

use cyltrace::math::Random;
use cyltrace::scene::{
    CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, Solids,
};
use cyltrace::solid::{Caps, Cylinder};
use glam::{DAffine3, DMat3, DVec3};

/// A prototype of cylinders.
pub fn prototype(cylinders: impl IntoIterator<Item = Cylinder>) -> Prototype {
    let records = (0..).zip(cylinders);
    Prototype {
        solids: Solids::of_cylinders(records.map(|(primitive, cylinder)| {
            CylinderRecord::new(&cylinder, primitive, MaterialIndex(0))
        })),
        ..Prototype::default()
    }
}

/// A random cylinder about the origin.
pub fn random_cylinder(random: &mut Random, reach: f64, caps: Caps) -> Cylinder {
    let p0 = random.direction() * (reach * random.unit());
    let p1 = p0 + random.direction() * random.log_uniform(0.05, 3.0);
    let radius = random.log_uniform(0.02, 1.0);
    Cylinder::new(p0, p1, radius, caps).expect("a cylinder")
}

fn random_placement(random: &mut Random, of: u32) -> Placement {
    let x = random.direction();
    let y = x.cross(random.direction()).normalize();
    let turn = DMat3::from_cols(x, y, x.cross(y));
    let mut scale = DVec3::from_array([0; 3].map(|_| random.log_uniform(0.3, 3.0)));
    if random.below(3) == 0 {
        scale.x = -scale.x;
    }
    let matrix = turn * DMat3::from_diagonal(scale);
    let translation = random.direction() * random.log_uniform(0.1, 10.0);
    Placement {
        of: PrototypeIndex(of),
        parent_from_child: DAffine3::from_mat3_translation(matrix, translation),
    }
}

/// 1 to 100 cylinders with all caps in the root and two levels of prototypes.
pub fn random_scene(seed: u64) -> Scene {
    let mut random = Random::new(seed, 4);
    let all_caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both];
    let count = 1 + random.below(100);
    let mut lists = [Vec::new(), Vec::new(), Vec::new()];
    for number in 0..count {
        let caps = all_caps[random.below(4) as usize];
        let cylinder = random_cylinder(&mut random, 3.0, caps);
        lists[(number % 3) as usize].push(cylinder);
    }
    let [root, outer, inner] = lists.map(prototype);
    let mut prototypes = vec![root, outer, inner];
    for _ in 0..3 {
        prototypes[0]
            .placements
            .push(random_placement(&mut random, 1));
        prototypes[1]
            .placements
            .push(random_placement(&mut random, 2));
    }
    Scene::new(prototypes)
}

/// A cylinder that is about as thick as it is long, askew.
pub fn single_cylinder() -> Scene {
    let axis = DVec3::new(0.6, 0.5, 0.7);
    let cylinder = Cylinder::new(-axis, axis, 1.0, Caps::Both).expect("a cylinder");
    Scene::new(vec![prototype([cylinder])])
}
