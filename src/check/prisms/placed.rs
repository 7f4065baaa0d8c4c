//! The scene without its placements: windows of it, as lists of placed solids.
//!
//! Placements are composed in exact numbers, by the oracle's code, and boxes
//! follow the composed map: what the tracer does on its way down has no part in
//! it.
//!
//! A scene is one window if all its solids may be checked at a time and f32
//! resolves them. An f32 mesh about a point `c` knows a coordinate at distance
//! `d` from `c` to `2^-24 d`; with `w` the least half width of a solid (radius or
//! half length, in the world), prisms lose `2^-24 d / w` of it. [`RESOLVED`]
//! bounds `d / w` for half of all solids, so that half of them lose less than a
//! thousandth. Other windows are boxes about a random cylinder, at most
//! [`WIDEST`] times as wide as its half width, with all solids that meet them.

use std::sync::Arc;

use glam::DAffine3;

use crate::math::{Bounds, ChildFromParent, PlacementErrors, Random};
use crate::oracle::ExactAffine;
use crate::scene::{Placement, PrototypeIndex, Scene};
use crate::solid::Cylinder;

/// The most distances from a window's middle in half widths of a solid at which
/// its prisms are worth tracing: 2^-24 of it is 2^-10 of the half width.
const RESOLVED: f64 = (1 << 14) as f64;

/// The width of a window in half widths of the solid in its middle.
const WIDEST: f64 = (1 << 12) as f64;

/// Windows of a scene that is not checked at once.
const WINDOWS: u64 = 8;

/// How often a window is made smaller by half before it is given up: 2^-40 of
/// the widest is far below the solid in its middle, where all solids left share
/// a point.
const MOST_HALVINGS: u32 = 40;

/// A place in the world where a prototype stands.
#[derive(Debug)]
pub(crate) struct PlacedFrame {
    /// The placements from the root, outermost first.
    pub instance: Vec<u32>,
    /// The composed map, without rounding.
    pub exact: ExactAffine,
    /// Every entry is the f64 nearest to the exact one.
    pub world_from_object: DAffine3,
}

impl PlacedFrame {
    fn new(instance: Vec<u32>, exact: ExactAffine) -> Self {
        let world_from_object = exact.rounded();
        Self {
            instance,
            exact,
            world_from_object,
        }
    }

    fn within(&self, number: u32, placement: &Placement) -> Self {
        let mut instance = self.instance.clone();
        instance.push(number);
        let inner = ExactAffine::new(&placement.parent_from_child);
        Self::new(instance, self.exact.after(&inner))
    }
}

/// A cylinder and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct PlacedSolid {
    /// The solid in its prototype's space.
    pub cylinder: Cylinder,
    /// Where its prototype stands.
    pub frame: Arc<PlacedFrame>,
    /// Its number within the prototype.
    pub primitive: u32,
}

impl PlacedSolid {
    /// A box in the world that holds the solid.
    ///
    /// [`Bounds::transformed`] grows by 8 units where its own roundings need
    /// 6; the rounded entries of the map add one.
    pub fn bounds(&self) -> Bounds {
        let bounds = self.cylinder.bounds();
        bounds.transformed(&self.frame.world_from_object)
    }

    /// At most the distance from its middle to its surface, in the world.
    fn half_width(&self) -> f64 {
        let placement = &self.frame.world_from_object;
        let shrink = PlacementErrors::new(placement, &ChildFromParent::new(placement)).shrink;
        let length = (self.cylinder.p1() - self.cylinder.p0()).length();
        shrink * self.cylinder.radius().min(length / 2.0)
    }
}

/// A part of the scene that is checked at a time.
#[derive(Debug)]
pub(crate) struct Window {
    /// Rays are clipped to this box; `None` is the whole scene.
    pub bounds: Option<Bounds>,
    /// All solids that meet it.
    pub solids: Vec<PlacedSolid>,
}

impl Window {
    /// The box about which meshes are centred: the window's own, or that of all
    /// its solids.
    pub fn extent(&self) -> Bounds {
        let all = || {
            let solids = self.solids.iter();
            solids.fold(Bounds::EMPTY, |all, solid| all.union(&solid.bounds()))
        };
        self.bounds.unwrap_or_else(all)
    }

    /// Whether f32 resolves half of the solids.
    fn is_resolved(&self) -> bool {
        let centre = self.extent().centre();
        let resolved = self.solids.iter().filter(|solid| {
            let bounds = solid.bounds();
            let farthest = (bounds.upper - centre).max(centre - bounds.lower);
            farthest.length() <= RESOLVED * solid.half_width()
        });
        2 * resolved.count() >= self.solids.len()
    }
}

/// The whole scene as one window where that is sound, or else several of at
/// most an eighth of `most_solids` each; none if the scene is empty or has more
/// solids than that in one point wherever it was looked at.
pub(crate) fn windows(scene: &Scene, most_solids: usize, seed: u64) -> Vec<Window> {
    let tree = Tree::new(scene);
    let count = tree.root().count;
    if count == 0 {
        return Vec::new();
    }
    if count <= most_solids as u64
        && let Some(solids) = tree.solids(None, most_solids)
    {
        let whole = Window {
            bounds: None,
            solids,
        };
        if whole.is_resolved() {
            return vec![whole];
        }
    }
    let most = most_solids / WINDOWS as usize;
    let about_random = |number| tree.window(&tree.pick(&mut Random::new(seed, number)), most);
    (0..WINDOWS).filter_map(about_random).collect()
}

/// What is known of a prototype and all that is placed in it.
struct Node {
    /// Cylinders with every placement counted; stays at the greatest number.
    count: u64,
    /// Holds all of them, in the prototype's space.
    bounds: Bounds,
    /// The boxes of the placements, in the prototype's space.
    placed: Vec<Bounds>,
}

/// A scene with boxes about everything that is placed.
struct Tree<'a> {
    scene: &'a Scene,
    nodes: Vec<Option<Node>>,
}

/// Solids that meet a region, as they are found.
struct Found<'a> {
    region: Option<&'a Bounds>,
    most: usize,
    solids: Vec<PlacedSolid>,
}

impl Found<'_> {
    fn meets(&self, bounds: &Bounds) -> bool {
        self.region.is_none_or(|region| region.meets(bounds))
    }
}

impl<'a> Tree<'a> {
    fn new(scene: &'a Scene) -> Self {
        let nodes = scene.prototypes.iter().map(|_| None).collect();
        let mut tree = Self { scene, nodes };
        tree.add(PrototypeIndex::ROOT);
        tree
    }

    /// Fills in the node of a prototype, after those that it places.
    fn add(&mut self, index: PrototypeIndex) {
        if self.nodes[index.0 as usize].is_some() {
            return;
        }
        let scene = self.scene;
        let prototype = &scene.prototypes[index.0 as usize];
        let mut node = Node {
            count: prototype.cylinders.len() as u64,
            bounds: Bounds::EMPTY,
            placed: Vec::with_capacity(prototype.placements.len()),
        };
        for record in &prototype.cylinders {
            node.bounds = node.bounds.union(&record.cylinder().bounds());
        }
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
        node.as_ref().expect("what is placed was added first")
    }

    fn root(&self) -> &Node {
        self.node(PrototypeIndex::ROOT)
    }

    fn root_frame() -> Arc<PlacedFrame> {
        Arc::new(PlacedFrame::new(Vec::new(), ExactAffine::identity()))
    }

    /// All solids that meet the region, or `None` if they are more than `most`.
    fn solids(&self, region: Option<&Bounds>, most: usize) -> Option<Vec<PlacedSolid>> {
        let mut found = Found {
            region,
            most,
            solids: Vec::new(),
        };
        let all_fit = self.find(PrototypeIndex::ROOT, &Self::root_frame(), &mut found);
        all_fit.then_some(found.solids)
    }

    /// Adds what meets the region in one place of a prototype; false as soon as
    /// it is too much.
    fn find(&self, index: PrototypeIndex, frame: &Arc<PlacedFrame>, found: &mut Found) -> bool {
        let prototype = &self.scene.prototypes[index.0 as usize];
        for record in &prototype.cylinders {
            let solid = PlacedSolid {
                cylinder: record.cylinder(),
                frame: Arc::clone(frame),
                primitive: record.primitive(),
            };
            if !found.meets(&solid.bounds()) {
                continue;
            }
            if found.solids.len() == found.most {
                return false;
            }
            found.solids.push(solid);
        }
        let placed = prototype
            .placements
            .iter()
            .zip(&self.node(index).placed)
            .zip(0..);
        for ((placement, bounds), number) in placed {
            // The box is in this prototype's space: no map is composed for
            // what is elsewhere.
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

    /// A solid of the scene, each with the same chance.
    fn pick(&self, random: &mut Random) -> PlacedSolid {
        let mut index = PrototypeIndex::ROOT;
        let mut frame = Self::root_frame();
        let mut number = random.below(self.root().count);
        loop {
            let prototype = &self.scene.prototypes[index.0 as usize];
            if number < prototype.cylinders.len() as u64 {
                let record = prototype.cylinders.get(number as usize);
                return PlacedSolid {
                    cylinder: record.cylinder(),
                    frame,
                    primitive: record.primitive(),
                };
            }
            number -= prototype.cylinders.len() as u64;
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
            frame = Arc::new(frame.within(place, placement));
            index = placement.of;
        }
    }

    /// The largest window about a solid with at most so many solids, of those
    /// that are as wide as [`WIDEST`] allows or half, a quarter, ... of it.
    fn window(&self, middle: &PlacedSolid, most: usize) -> Option<Window> {
        let centre = Bounds::at(middle.bounds().centre());
        let widest = WIDEST / 2.0 * middle.half_width();
        let mut reach = widest;
        for _ in 0..MOST_HALVINGS {
            // So far out that `reach` is lost, the box still has an extent.
            let bounds = centre.grown(reach).rounded_outward();
            if let Some(solids) = self.solids(Some(&bounds), most) {
                return Some(Window {
                    bounds: Some(bounds),
                    solids,
                });
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
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("scenes")
            .join(name);
        crate::scene::load(&path).expect("the scene is there")
    }

    #[test]
    fn lattice_is_one_window_with_every_solid() {
        let scene = load("lattice.toml");
        let all = windows(&scene, 1 << 17, 0);
        assert_eq!(all.len(), 1);
        assert_eq!(all[0].bounds, None);
        assert_eq!(all[0].solids.len(), 61_061);
        assert_eq!(all[0].solids[0].frame.instance, Vec::<u32>::new());
        assert_eq!(all[0].solids[61_060].frame.instance, [0, 5]);
    }

    /// The windows of the lattice against all solids, one by one.
    #[test]
    fn windows_hold_exactly_the_solids_that_meet_them() {
        let scene = load("lattice.toml");
        let whole = windows(&scene, 1 << 17, 0).remove(0);
        for window in windows(&scene, 20_000, 3) {
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
        let all = windows(&load("forest.toml"), 400_000, 1);
        assert_eq!(all.len(), 8);
        for window in &all {
            assert!((1_000..=50_000).contains(&window.solids.len()));
            let bounds = window.bounds.expect("a part of the scene");
            assert!(bounds.extent().max_element() < 20.0, "{bounds:?}");
            assert!(window.is_resolved());
        }
    }
}
