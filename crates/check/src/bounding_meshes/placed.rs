//! The scene without its placements: windows of it, as lists of placed solids.
//!
//! The oracle's code composes the placements in exact numbers, and boxes
//! follow the composed map: the tracer's code has no part in it.
//!
//! A scene is one window if its meshes fit into the memory and f32
//! resolves them. An f32 mesh about a point `c` represents a coordinate at distance
//! `d` from `c` to `2^-24 d`; with `w` the least half width of a solid (radius or
//! half length, in the world), meshes lose `2^-24 d / w` of it. A window is
//! resolved if `d / w` is bounded for half of all solids, so that half of them lose less than a
//! thousandth. Other windows are boxes about a random solid, at most
//! [`WIDEST`] times as wide as its half width, with all solids whose boxes overlap them.

use std::sync::Arc;

use cyltrace::math::{Bounds, Random, power_of_two};
use cyltrace::scene::{PrototypeIndex, Scene};
use cyltrace::solid::{AnySolid, Composition};

use super::hull::triangles_needed;
use super::window::{PlacedComposition, PlacedFrame, PlacedSolid, Window};
use crate::solids::scene_solid::{SceneSolid, nth};

/// The width of a window in half widths of the solid at its center.
const WIDEST: f64 = (1 << 12) as f64;

/// Windows of a scene that is not a single window.
const WINDOWS: u64 = 8;

/// How often a window is halved before it is given up: 2^-40 of
/// the widest is far smaller than the solid at its center, so all solids left share
/// a point.
const MOST_HALVINGS: u32 = 40;

/// The least half width of a window, as a share of its farthest coordinate. The origins of
/// rays are on a grid of at most 2^-49 of it (`mesh_frame`), which divides a window into 64
/// steps or more: rays aimed at the window hit it. If this is wider than [`WIDEST`], the solid
/// is beyond f32 in any window, and its row reports no witness.
const LEAST_REACH: f64 = power_of_two(-44);

/// The size of a window's meshes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget {
    /// Triangles of the meshes of either side.
    pub triangles: u64,
    /// Sides of each mesh.
    pub segments: u32,
}

/// The whole scene as one window if that is resolved, or else several of at
/// most an eighth of the triangles each; none if the scene is empty or has too many
/// solids at one point in each of them.
pub(crate) fn windows(scene: &Scene, budget: Budget, seed: u64) -> Vec<Window> {
    let tree = Tree::new(scene);
    if tree.root().count == 0 {
        return Vec::new();
    }
    if let Some(whole) = tree.window_of(None, budget)
        && whole.is_resolved()
    {
        return vec![whole];
    }
    let part = Budget {
        triangles: budget.triangles / WINDOWS,
        ..budget
    };
    let about_random = |number| {
        let (middle, half_width) = tree.pick(&mut Random::new(seed, number));
        tree.window_about(middle, half_width, part)
    };
    (0..WINDOWS).filter_map(about_random).collect()
}

/// A prototype with all that is placed in it.
struct Node {
    /// Solids with every placement counted; saturates.
    count: u64,
    /// Contains all of them, in the prototype's space.
    bounds: Bounds,
    /// The boxes of the placements, in the prototype's space.
    placed: Vec<Bounds>,
    /// Its compositions, shared by all placements.
    compositions: Vec<Arc<Composition>>,
}

/// A scene with boxes about all placements.
struct Tree<'a> {
    scene: &'a Scene,
    nodes: Vec<Option<Node>>,
}

/// Solids whose boxes overlap a region, as they are found.
struct Found {
    triangles_left: u64,
    segments: u32,
    window: Window,
}

impl Found {
    fn meets(&self, bounds: &Bounds) -> bool {
        let region = self.window.bounds.as_ref();
        region.is_none_or(|region| region.meets(bounds))
    }

    /// Adds a solid, single or as its leaves; false if that exceeds the budget.
    fn add(&mut self, solids: &[AnySolid], frame: &Arc<PlacedFrame>, primitive: u32) -> bool {
        for &solid in solids {
            let triangles = triangles_needed(&solid, self.segments);
            let Some(left) = self.triangles_left.checked_sub(triangles) else {
                return false;
            };
            self.triangles_left = left;
            self.window.solids.push(PlacedSolid {
                solid,
                frame: Arc::clone(frame),
                primitive,
            });
        }
        true
    }
}

impl<'a> Tree<'a> {
    fn new(scene: &'a Scene) -> Self {
        let nodes = scene.prototypes.iter().map(|_| None).collect();
        let mut tree = Self { scene, nodes };
        tree.add(PrototypeIndex::ROOT);
        tree
    }

    /// Fills in the node of a prototype, after those of its placements.
    fn add(&mut self, index: PrototypeIndex) {
        if self.nodes[index.0 as usize].is_some() {
            return;
        }
        let scene = self.scene;
        let prototype = &scene.prototypes[index.0 as usize];
        let solids = &prototype.solids;
        let compositions = solids.compositions.iter();
        let mut node = Node {
            count: solids.len() as u64,
            bounds: solids.bounds(),
            placed: Vec::with_capacity(prototype.placements.len()),
            compositions: compositions
                .map(|record| Arc::new(record.solid.clone()))
                .collect(),
        };
        for placement in &prototype.placements {
            self.add(placement.of);
            let child = self.node(placement.of);
            let bounds = child.bounds.transformed(&placement.parent_from_child);
            node.count = node.count.saturating_add(child.count);
            node.bounds = node.bounds.union(&bounds);
            node.placed.push(bounds);
        }
        self.nodes[index.0 as usize] = Some(node);
    }

    fn node(&self, index: PrototypeIndex) -> &Node {
        let node = &self.nodes[index.0 as usize];
        node.as_ref().expect("placements are added first")
    }

    fn root(&self) -> &Node {
        self.node(PrototypeIndex::ROOT)
    }

    /// All solids whose boxes overlap the region; `None` if they exceed the budget.
    fn window_of(&self, region: Option<Bounds>, budget: Budget) -> Option<Window> {
        let mut found = Found {
            triangles_left: budget.triangles,
            segments: budget.segments,
            window: Window {
                bounds: region,
                ..Window::default()
            },
        };
        let root = Arc::new(PlacedFrame::root());
        let all_fit = self.find(PrototypeIndex::ROOT, &root, &mut found);
        all_fit.then_some(found.window)
    }

    /// Adds the solids of one placement of a prototype; false as soon as they exceed the
    /// budget.
    fn find(&self, index: PrototypeIndex, frame: &Arc<PlacedFrame>, found: &mut Found) -> bool {
        let prototype = &self.scene.prototypes[index.0 as usize];
        let node = self.node(index);
        for (primitive, solid) in prototype.singles() {
            let bounds = solid.bounds().transformed(&frame.world_from_object);
            if found.meets(&bounds) && !found.add(&[solid], frame, primitive) {
                return false;
            }
        }
        let records = prototype.solids.compositions.iter();
        for (record, composition) in records.zip(&node.compositions) {
            let bounds = composition.bounds().transformed(&frame.world_from_object);
            if !found.meets(&bounds) {
                continue;
            }
            let first = found.window.solids.len() as u32;
            if !found.add(&composition.solids(), frame, record.primitive) {
                return false;
            }
            found.window.compositions.push(PlacedComposition {
                leaves: first..found.window.solids.len() as u32,
                composition: Arc::clone(composition),
            });
        }
        let placed = prototype.placements.iter().zip(&node.placed).zip(0..);
        for ((placement, bounds), number) in placed {
            // The box is in this prototype's space, so no map is composed for placements
            // outside of the region.
            if !found.meets(&bounds.transformed(&frame.world_from_object)) {
                continue;
            }
            let inner = Arc::new(frame.within(number, placement));
            if !self.find(placement.of, &inner, found) {
                return false;
            }
        }
        true
    }

    /// The center and the half width of a random solid of the scene, all equally likely.
    fn pick(&self, random: &mut Random) -> (Bounds, f64) {
        let mut index = PrototypeIndex::ROOT;
        let mut frame = PlacedFrame::root();
        let mut number = random.below(self.root().count);
        loop {
            let prototype = &self.scene.prototypes[index.0 as usize];
            let own = prototype.solids.len() as u64;
            if number < own {
                let (primitive, solid) = match nth(prototype, number as usize) {
                    (primitive, SceneSolid::Single(solid)) => (primitive, solid),
                    // A composition is represented by its first leaf.
                    (primitive, SceneSolid::Composed(solid)) => {
                        let leaf = solid.solids().first().copied();
                        (primitive, leaf.expect("an operation has operands"))
                    }
                };
                let frame = Arc::new(frame);
                let placed = PlacedSolid {
                    solid,
                    frame,
                    primitive,
                };
                return (Bounds::at(placed.bounds().center()), placed.half_width());
            }
            number -= own;
            let mut placements = prototype.placements.iter().zip(0..);
            let (placement, place) = placements
                .find(|(placement, _)| {
                    let count = self.node(placement.of).count;
                    let is_here = number < count;
                    if !is_here {
                        number -= count;
                    }
                    is_here
                })
                .expect("the counts add up");
            frame = frame.within(place, placement);
            index = placement.of;
        }
    }

    /// The largest window about a point that fits the budget: as wide as [`WIDEST`] allows,
    /// or half, a quarter, ... of it.
    fn window_about(&self, center: Bounds, half_width: f64, budget: Budget) -> Option<Window> {
        let mut reach = WIDEST / 2.0 * half_width;
        let least = LEAST_REACH * center.lower.abs().max_element();
        for _ in 0..MOST_HALVINGS {
            let bounds = center.grown(reach.max(least)).rounded_outward();
            if let Some(window) = self.window_of(Some(bounds), budget) {
                return Some(window);
            }
            if reach <= least {
                return None;
            }
            reach /= 2.0;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn load(name: &str) -> Scene {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
            .join("scenes")
            .join(name);
        cyltrace::scene::load(&path).expect("the scene is there")
    }

    /// The budget of this number of cylinders with 8 sides.
    fn of_cylinders(count: u64) -> Budget {
        Budget {
            triangles: 32 * count,
            segments: 8,
        }
    }

    #[test]
    fn lattice_is_one_window_with_every_solid() {
        let scene = load("lattice.toml");
        let all = windows(&scene, of_cylinders(1 << 17), 0);
        assert_eq!(all.len(), 1);
        assert_eq!(all[0].bounds, None);
        assert_eq!(all[0].solids.len(), 61_061);
        assert_eq!(all[0].solids[0].frame.instance, Vec::<u32>::new());
        assert_eq!(all[0].solids[61_060].frame.instance, [0, 5]);
    }

    /// The windows of the lattice against all solids, one by one.
    #[test]
    fn windows_contain_exactly_the_solids_that_overlap_them() {
        let scene = load("lattice.toml");
        let whole = windows(&scene, of_cylinders(1 << 17), 0).remove(0);
        for window in windows(&scene, of_cylinders(20_000), 3) {
            let bounds = window.bounds.expect("a part of the scene");
            let meets = |solid: &&PlacedSolid| solid.bounds().meets(&bounds);
            let name = |solid: &PlacedSolid| (solid.frame.instance.clone(), solid.primitive);
            let expected: Vec<_> = whole.solids.iter().filter(meets).map(name).collect();
            let found: Vec<_> = window.solids.iter().map(name).collect();
            assert!(!found.is_empty() && found.len() <= 2_500);
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn forest_has_windows_that_f32_resolves() {
        let all = windows(&load("forest.toml"), of_cylinders(400_000), 1);
        assert_eq!(all.len(), 8);
        for window in &all {
            assert!((1_000..=50_000).contains(&window.solids.len()));
            let bounds = window.bounds.expect("a part of the scene");
            assert!(bounds.extent().max_element() < 20.0, "{bounds:?}");
            assert!(window.is_resolved());
        }
    }
}
