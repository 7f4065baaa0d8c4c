//! How much memory a scene will take, before it is built.

use super::prototype::PlacementRecord;
use crate::scene::{Census, CylinderRecord, Placement};

/// Bytes that Embree holds for each primitive of a user geometry: its share of
/// the tree. Measured with Embree 3.13.5 (AVX-512) on random cylinders in a
/// cube, and again on random placements, as `memory.embree_bytes` of `render`:
/// 87 and 86 a primitive for 100 000 of them, 105 and 104 for 10 000, 121 and
/// 115 for 1 000. Large scenes are where an estimate matters.
const EMBREE_BYTES_PER_PRIMITIVE: u64 = 88;

/// What a scene's memory should come to. Peak use while building is higher.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryEstimate {
    /// The records of cylinders and placements: exact sizes, times what is
    /// stored.
    pub records_bytes: u64,
    /// Embree's trees: a measured figure for each cylinder and placement that
    /// is stored.
    pub embree_bytes: u64,
}

impl MemoryEstimate {
    /// The estimate for a scene that holds so much.
    #[must_use]
    pub fn of(census: &Census) -> Self {
        let placement_bytes = size_of::<Placement>() + size_of::<PlacementRecord>();
        Self {
            records_bytes: census.cylinders_unique * size_of::<CylinderRecord>() as u64
                + census.placements * placement_bytes as u64,
            embree_bytes: (census.cylinders_unique + census.placements)
                * EMBREE_BYTES_PER_PRIMITIVE,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DAffine3;

    use super::*;
    use crate::math::Random;
    use crate::scene::{MaterialIndex, Prototype, PrototypeIndex, Scene};
    use crate::solid::{Caps, Cylinder};
    use crate::tracer::{Options, Tracer};

    fn scene(cylinders: u32, placements: u32) -> Scene {
        let mut random = Random::new(41, 0);
        let mut prototype = Prototype::default();
        for primitive in 0..cylinders {
            let p0 = random.direction() * random.uniform(0.0, 10.0);
            let p1 = p0 + random.direction();
            let cylinder = Cylinder::new(p0, p1, 0.02, Caps::Both).expect("a cylinder");
            let record = CylinderRecord::new(&cylinder, primitive, MaterialIndex(0));
            prototype.cylinders.push(record);
        }
        let root = Prototype {
            placements: (0..placements)
                .map(|_| Placement {
                    of: PrototypeIndex(1),
                    parent_from_child: DAffine3::from_translation(random.direction() * 100.0),
                })
                .collect(),
            ..Prototype::default()
        };
        Scene::new(vec![root, prototype])
    }

    #[test]
    fn census_of_nested_scene_agrees_with_the_tracer_and_the_estimate_is_near() {
        let scene = Arc::new(scene(50_000, 20_000));
        let census = scene.census();
        let tracer = Tracer::new(Arc::clone(&scene), &Options::default()).expect("built");
        let built = tracer.statistics();
        assert_eq!(census.cylinders_unique, built.cylinders_unique);
        assert_eq!(census.cylinders_instanced, built.cylinders_instanced);
        assert_eq!(census.instances, built.instances);
        assert_eq!(census.depth, 1);

        let estimate = MemoryEstimate::of(&census);
        assert_eq!(estimate.records_bytes, built.records_bytes as u64);
        let ratio = built.embree_bytes as f64 / estimate.embree_bytes as f64;
        assert!(
            (0.6..1.6).contains(&ratio),
            "Embree holds {ratio} of the estimate"
        );

        let (counted, traced) = (census.bounds, tracer.bounds());
        let apart = (counted.lower - traced.lower).abs() + (counted.upper - traced.upper).abs();
        assert!(apart.max_element() < 1e-6, "{counted:?} {traced:?}");
    }
}
