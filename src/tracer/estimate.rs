//! An estimate of a scene's memory, from counts alone, before anything is built.
//!
//! **Records** are exact: the size of a record times their number.
//!
//! **Embree's tree.** A tree over n primitives has nodes of 4 children (128 bytes, SSE) or 8
//! (256 bytes, from AVX on) and a leaf of 16 bytes per primitive. A node of b children replaces
//! b subtrees by one, so a full tree has (n - 1)/(b - 1) nodes. Real trees are less full, as
//! the last level contains the remainder, which depends on n and on the positions of the
//! primitives. Measured as `Device::memory_bytes`, with Embree 3.13.5, SSE2, AVX2 and AVX-512,
//! on random boxes in a cube, on a plane, along a line, and so large that they overlap, n from
//! 1 to 3 million:
//!
//! - 4 children: 70 to 76 bytes per primitive, for any n. The model has 72.5.
//! - 8 children: a wave with the period of a factor of 8 in n, since even splitting ends with 2
//!   to 8 primitives for the last nodes. Evenly spread in a cube the wave goes from 74 to 110
//!   bytes, on a plane from 74 to 89, and 79 to 81 remain if primitives overlap or differ in
//!   size. The model is the middle of the extremes at each phase ([`WAVE`]), and at most 18
//!   bytes off; only the positions could improve it.
//! - The last blocks of each tree are not full. 610 bytes times the cube root of n, and at
//!   least a block of 1152 bytes each for the tree and its leaves, cover the measurements from
//!   n = 1 on, within 20 kB below 3000 primitives.
//!
//! So Embree's part is within 18 % from 3000 primitives on. Records are added and exact: the
//! sum is within 10 % for f64 cylinders or for placements, within 13 % for f32 cylinders.
//!
//! **Groups** are not known from counts. A prototype with several has 4 bytes more per entry,
//! which is within the error, and each of its placements has a leaf for every group, which is
//! not: the tree of a scene of placements grows by that factor.
//!
//! **Instances.** Embree takes [`INSTANCE_BYTES`] for each placement that is an instance of its
//! own (`prototype::instances`), beside the leaf. Counts alone do not determine these:
//! placements that are far smaller than their parents are not instances. So the estimate
//! includes every possible instance, with those in prototypes that are opened
//! (`prototype::opened`): at most 2.5 MB per prototype.
//!
//! **While building**, Embree has a reference of 32 bytes to each primitive of the scene, in an
//! array whose size is the next power of two. That is exact in every measurement with Embree
//! 3.13.5; Embree 4.4 allocates only the required number, which is less. Scenes that are built
//! at once are built one after the other; the peak is assumed at the largest, with all others
//! present.

use super::options::Layout;
use super::prototype::{MOST_INNER, MOST_INSTANCES, MOST_OUTER, block_bytes};
use crate::embree::MaxIsa;
use crate::math::LANES;
use crate::scene::{ExpectedCounts, Placement};
use crate::solid::SolidKind;

/// Bytes of an instance: Embree 3.13.5's structures and the overhead of the allocator.
pub(super) const INSTANCE_BYTES: u64 = 305;

/// Bytes per primitive of a tree of nodes with 4 children.
const NARROW: f64 = 72.5;

/// Bytes per primitive of a tree of nodes with 8 children, at n = 8^k and at every power of √2
/// from there.
const WAVE: [f64; 6] = [79.5, 87.5, 91.3, 87.5, 81.5, 77.0];

/// Unused bytes in blocks, over the cube root of the number of primitives.
const UNFILLED: f64 = 610.0;

/// The least block that Embree takes for nodes or leaves.
const BLOCK: u64 = 1152;

/// A reference to a primitive while Embree builds.
const REFERENCE: u64 = 32;

impl Layout {
    /// The number of primitives for `solids` of a kind that has a filter.
    fn primitives(self, solids: u64) -> u64 {
        if self.has_blocks(solids) {
            solids.div_ceil(LANES as u64)
        } else {
            solids
        }
    }

    /// Bytes that the tracer stores for `solids` of a kind in addition to their records.
    fn copies_bytes(self, solids: u64) -> u64 {
        if self.has_blocks(solids) {
            block_bytes(solids)
        } else {
            0
        }
    }
}

/// An estimate of a scene's memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryEstimate {
    /// The records of solids and placements with their values for data colors, including those
    /// that are not built, and images.
    pub records_bytes: u64,
    /// The filters of blocks, and the numbers of their records.
    pub copies_bytes: u64,
    /// Embree's trees.
    pub embree_bytes: u64,
    /// What Embree needs temporarily, in addition, to build the largest tree.
    pub building_bytes: u64,
}

impl MemoryEstimate {
    /// The estimate for a scene with these contents, built whole and limited to `max_isa`, as
    /// in [`Options`](super::Options).
    #[must_use]
    pub fn of(contents: &[ExpectedCounts], layout: Layout, max_isa: Option<MaxIsa>) -> Self {
        let is_wide = is_wide(max_isa);
        let mut sum = Self::default();
        for prototype in contents {
            let placements = prototype.placements();
            let records = placements.saturating_mul(size_of::<Placement>() as u64);
            let records = records.saturating_add(prototype.solids.bytes);
            let records = records.saturating_add(prototype.values_bytes);
            sum.records_bytes = sum.records_bytes.saturating_add(records);
            if !prototype.is_used {
                continue;
            }
            let mut primitives = placements;
            for (kind, solids) in prototype.solids.counts.iter() {
                let solids = u64::try_from(solids).unwrap_or(u64::MAX);
                if SolidKind::OPERATIONS.contains(&kind) {
                    primitives = primitives.saturating_add(solids);
                    continue;
                }
                let copies = layout.copies_bytes(solids);
                sum.copies_bytes = sum.copies_bytes.saturating_add(copies);
                primitives = primitives.saturating_add(layout.primitives(solids));
            }
            let tree = tree_bytes(primitives, is_wide)
                .saturating_add(INSTANCE_BYTES.saturating_mul(instances(prototype, contents)));
            sum.embree_bytes = sum.embree_bytes.saturating_add(tree);
            let building = primitives
                .checked_next_power_of_two()
                .map_or(u64::MAX, |references| references.saturating_mul(REFERENCE));
            sum.building_bytes = sum.building_bytes.max(building);
        }
        sum
    }

    /// The memory of the built scene.
    #[must_use]
    pub fn total_bytes(&self) -> u64 {
        self.records_bytes
            .saturating_add(self.copies_bytes)
            .saturating_add(self.embree_bytes)
    }

    /// The peak while it is built.
    #[must_use]
    pub fn peak_bytes(&self) -> u64 {
        self.total_bytes().saturating_add(self.building_bytes)
    }
}

/// The greatest number of Embree's instances in a prototype: its innermost placements, and the
/// placements in those of its children that consist of a few placements only.
fn instances(prototype: &ExpectedCounts, all: &[ExpectedCounts]) -> u64 {
    let placements = prototype.placements();
    if placements > MOST_INSTANCES as u64 {
        return 0;
    }
    let of_one = |child: &ExpectedCounts| {
        let within = child.placements();
        let is_bare = child.solids.counts.total() == 0;
        let may_be_opened = placements <= MOST_OUTER as u64 && within <= MOST_INNER as u64;
        match within {
            0 => 1,
            within if is_bare && may_be_opened => within,
            _ => 0,
        }
    };
    let placed = prototype.placed.iter();
    let instances = placed.filter_map(|placed| {
        let child = all.get(placed.of.0 as usize)?;
        Some(placed.count * of_one(child))
    });
    instances.sum()
}

/// Whether Embree's nodes have 8 children.
fn is_wide(max_isa: Option<MaxIsa>) -> bool {
    MaxIsa::in_use(max_isa).is_some_and(|isa| isa >= MaxIsa::Avx)
}

/// The bytes of Embree's tree over a number of primitives.
fn tree_bytes(primitives: u64, is_wide: bool) -> u64 {
    if primitives == 0 {
        return 0;
    }
    let count = primitives as f64;
    let each = if is_wide { wave(count) } else { NARROW };
    let bytes = count * each + UNFILLED * libm::cbrt(count);
    (bytes as u64).max(BLOCK * primitives.min(2))
}

/// [`WAVE`] at a number of primitives, interpolated linearly in its logarithm.
fn wave(primitives: f64) -> f64 {
    let place = 2.0 * libm::log2(primitives) % WAVE.len() as f64;
    let before = place as usize % WAVE.len();
    let after = (before + 1) % WAVE.len();
    WAVE[before] + (WAVE[after] - WAVE[before]) * (place - place.floor())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::embree::{
        Box32, Device, DeviceOptions, GREATEST_PACKET, Ray32, RaySet, Rays32, Reached,
        SceneBuilder, UserGeometry,
    };
    use crate::math::Random;
    use crate::scene::{ExpectedSolids, PrototypeIndex, Records};

    /// Boxes without solids.
    struct Boxes(Vec<Box32>);

    impl UserGeometry for Boxes {
        type Query = ();

        fn primitive_count(&self) -> u32 {
            self.0.len() as u32
        }

        fn bounds(&self, primitive: u32) -> Box32 {
            self.0[primitive as usize]
        }

        fn intersect(&self, _: Reached, _: &Ray32, (): &mut ()) -> Option<f32> {
            None
        }

        fn occluded(&self, _: Reached, _: &Ray32, (): &mut ()) -> bool {
            false
        }

        fn intersect_packet(
            &self,
            _: Reached,
            _: RaySet,
            _: &Rays32,
            _: &mut [f32; GREATEST_PACKET],
            (): &mut (),
        ) -> RaySet {
            RaySet::EMPTY
        }

        fn occluded_packet(&self, _: Reached, _: RaySet, _: &Rays32, (): &mut ()) -> RaySet {
            RaySet::EMPTY
        }
    }

    /// Random boxes: in a cube and small, on a plane and small, or in a cube and
    /// large enough to overlap.
    fn boxes(count: u32, shape: usize) -> Boxes {
        let mut random = Random::new(43, u64::from(count));
        let apart = 1.0 / libm::cbrt(f64::from(count));
        let boxes = (0..count).map(|_| {
            let flat = if shape == 1 { 0.0 } else { 1.0 };
            let middle = [1.0, 1.0, flat].map(|side| side * random.unit());
            let size = random.unit() * if shape == 2 { 0.3 } else { 0.3 * apart };
            Box32 {
                lower: middle.map(|x| (x - size) as f32),
                upper: middle.map(|x| (x + size) as f32),
            }
        });
        Boxes(boxes.collect())
    }

    /// The bytes that Embree uses for a scene, and the peak.
    fn measured(max_isa: MaxIsa, boxes: Boxes) -> (u64, u64) {
        let options = DeviceOptions {
            max_isa: Some(max_isa),
            ..DeviceOptions::default()
        };
        let device = Device::new(&options).expect("a device");
        let before = device.memory_bytes();
        let mut builder = SceneBuilder::<()>::new(&device).expect("a scene");
        builder.attach_user(boxes).expect("boxes");
        let scene = builder.commit().expect("built");
        let bytes = (device.memory_bytes() - before) as u64;
        let peak = (device.peak_memory_bytes() - before) as u64;
        drop(scene);
        (bytes, peak)
    }

    fn root(cylinders: u64, records: Records) -> [ExpectedCounts; 1] {
        let mut solids = ExpectedSolids::default();
        solids.add(SolidKind::Cylinder, cylinders, records);
        [ExpectedCounts {
            name: String::new(),
            solids,
            placed: Vec::new(),
            values_bytes: 0,
            is_used: true,
        }]
    }

    #[test]
    fn scenes_of_random_boxes_measured_are_near_the_estimate() {
        let counts = [
            1_u32, 2, 7, 30, 100, 333, 1000, 3000, 4096, 8192, 20_000, 65_536, 200_000,
        ];
        for max_isa in MaxIsa::available() {
            for shape in 0..3 {
                for count in counts {
                    let cylinders = u64::from(count);
                    let estimate = MemoryEstimate::of(
                        &root(cylinders, Records::F64),
                        Layout::Single,
                        Some(max_isa),
                    );
                    let (bytes, peak) = measured(max_isa, boxes(count, shape));
                    let case =
                        format!("{max_isa}, {count} boxes, shape {shape}: {bytes}, {estimate:?}");
                    if count < 3000 {
                        let off = bytes.abs_diff(estimate.embree_bytes);
                        assert!(off < 20_000, "{case}");
                    } else {
                        let true_total = bytes + estimate.records_bytes;
                        let ratio = estimate.total_bytes() as f64 / true_total as f64;
                        assert!((0.9..1.1).contains(&ratio), "{case}: {ratio}");
                        let ratio = estimate.embree_bytes as f64 / bytes as f64;
                        assert!((0.82..1.19).contains(&ratio), "{case}: Embree {ratio}");
                    }
                    // The peak of a device itself exceeds that of the smallest scenes.
                    if count >= 100 {
                        let references = peak - bytes;
                        assert!(
                            references <= estimate.building_bytes,
                            "{case}: {references}"
                        );
                        assert!(references >= REFERENCE * cylinders, "{case}: {references}");
                    }
                }
            }
        }
    }

    #[test]
    fn layouts_and_records_change_copies_and_primitives() {
        let estimate = |cylinders, records, layout| {
            MemoryEstimate::of(&root(cylinders, records), layout, Some(MaxIsa::Sse2))
        };
        let single = estimate(1_000_001, Records::F64, Layout::Single);
        assert_eq!((single.records_bytes, single.copies_bytes), (64_000_064, 0));
        let block = estimate(1_000_001, Records::F64, Layout::Block);
        assert_eq!(block.copies_bytes, 125_001 * 64 + 1_000_001 * 4);
        assert_eq!(block.building_bytes, (1 << 17) * 32);
        let block32 = estimate(1_000_001, Records::F32, Layout::Block);
        assert_eq!(block32.records_bytes, 32_000_032);
        assert_eq!(block32.copies_bytes, block.copies_bytes);
        assert_eq!(block32.embree_bytes, block.embree_bytes);
        let as_many = estimate(125_001, Records::F64, Layout::Single);
        assert_eq!(block.embree_bytes, as_many.embree_bytes);
    }

    #[test]
    fn counts_beyond_all_memory_do_not_overflow() {
        let [mut root] = root(u64::MAX, Records::F64);
        root.placed.push(crate::scene::PlacedCount {
            of: PrototypeIndex(0),
            count: u64::MAX,
        });
        let estimate = MemoryEstimate::of(&[root.clone(), root], Layout::Block, None);
        assert_eq!(estimate.peak_bytes(), u64::MAX);
    }
}
