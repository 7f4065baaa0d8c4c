//! Whether a point is near any surface of a scene.
//!
//! The surface of a composition is part of those of its leaves, which count as
//! closed: a point far from those is far from it. A point near one of them may be near
//! it, or not.

use glam::{DAffine3, DVec3};

use super::deviation::{Deviation, Slack};
use super::nearness::{Frame, ROUNDING};
use super::tolerance::{Allowance, Margin, farthest};
use cyltrace::math::Bounds;
use cyltrace::scene::{PrototypeIndex, Scene};
use cyltrace::solid::AnySolid;

/// All surfaces of a scene.
pub(super) struct Surfaces<'a> {
    scene: &'a Scene,
    deviation: Deviation,
    /// The extent of each prototype that the root contains.
    reached: Vec<Option<Reached>>,
}

/// The solids of a prototype with all that it places, in its own space.
#[derive(Clone, Copy)]
struct Reached {
    bounds: Bounds,
    /// At most the least radius; infinite without solids.
    radius: f64,
    /// At least the deviation of any of their meshes, beyond that which is the same
    /// everywhere.
    deviation: f64,
    /// Whether the mesh of any of them may lack as much as its radius.
    is_lost: bool,
}

impl Default for Reached {
    fn default() -> Self {
        Self {
            bounds: Bounds::EMPTY,
            radius: f64::INFINITY,
            deviation: 0.0,
            is_lost: false,
        }
    }
}

impl<'a> Surfaces<'a> {
    pub fn new(scene: &'a Scene, deviation: Deviation) -> Self {
        let mut surfaces = Self {
            scene,
            deviation,
            reached: vec![None; scene.prototypes.len()],
        };
        surfaces.reach(PrototypeIndex::ROOT);
        surfaces
    }

    /// At most the least radius of a solid in the world; infinite without solids.
    pub fn least_radius(&self) -> f64 {
        self.root().radius
    }

    /// Whether the mesh of any solid may lack as much as its radius.
    pub fn is_any_lost(&self) -> bool {
        self.deviation.everywhere() >= self.least_radius() || self.root().is_lost
    }

    /// At least the deviation of any solid's mesh in the world, beyond that which is the
    /// same everywhere.
    pub fn greatest_deviation(&self) -> f64 {
        self.root().deviation
    }

    /// The distance of the farthest corner of the scene's box from the origin.
    pub fn greatest_coordinate(&self) -> f64 {
        farthest(&self.root().bounds)
    }

    fn root(&self) -> Reached {
        self.reached[PrototypeIndex::ROOT.0 as usize].unwrap_or_default()
    }

    fn reach(&mut self, index: PrototypeIndex) -> Reached {
        let number = index.0 as usize;
        if let Some(known) = self.reached[number] {
            return known;
        }
        let scene = self.scene;
        let prototype = &scene.prototypes[number];
        let own = prototype.solids.bounds();
        // A composition's numbers are those of its leaves, whose boxes may be larger.
        let composed = prototype.solids.compositions.iter();
        let leaves: Vec<AnySolid> = composed.flat_map(|record| record.solid.solids()).collect();
        let own = leaves
            .iter()
            .fold(own, |all, leaf| all.union(&leaf.bounds()));
        let singles = prototype.singles().map(|(_, solid)| solid);
        let mut whole = Reached {
            bounds: own,
            ..Reached::default()
        };
        for solid in singles.chain(leaves) {
            let (radius, slack) = (solid.radius(), self.deviation.slack(&solid));
            whole.radius = whole.radius.min(radius);
            whole.deviation = whole.deviation.max(slack.greatest);
            whole.is_lost |= slack.spare_radius(radius) <= 0.0;
        }
        for placement in &prototype.placements {
            let child = self.reach(placement.of);
            if !child.bounds.is_empty() {
                let map = &placement.parent_from_child;
                let frame = Frame::new(map);
                let deviation = frame.greatest_length(child.deviation);
                whole.bounds = whole.bounds.union(&child.bounds.transformed(map));
                whole.radius = whole.radius.min(frame.least_length(child.radius));
                whole.deviation = whole.deviation.max(deviation);
                whole.is_lost |= child.is_lost;
            }
        }
        self.reached[number] = Some(whole);
        whole
    }

    /// Whether some surface may be within the allowance, for its solid, of a point.
    pub fn may_be_near(&self, point: DVec3, allowance: &Allowance) -> bool {
        self.may_be_near_in(PrototypeIndex::ROOT, &DAffine3::IDENTITY, point, allowance)
    }

    fn may_be_near_in(
        &self,
        index: PrototypeIndex,
        world_from_here: &DAffine3,
        point: DVec3,
        allowance: &Allowance,
    ) -> bool {
        let prototype = &self.scene.prototypes[index.0 as usize];
        let frame = &Frame::new(world_from_here);
        // A little more than the allowance, for rounding.
        let distance = |bounds: &Bounds| {
            let placed = bounds.transformed(world_from_here);
            1.001 * allowance.of(farthest(&placed))
        };
        // At least that of every solid: most are farther even than this.
        let whole = self.reached[index.0 as usize].unwrap_or_default();
        let greatest = Margin {
            length: distance(&whole.bounds),
            slack: Slack::both(whole.deviation),
        };
        let margin = |solid: &AnySolid| Margin {
            length: distance(&solid.bounds()),
            slack: self.deviation.slack(solid),
        };
        let is_near = |solid: AnySolid| {
            !frame.is_far(&solid, point, greatest) && !frame.is_far(&solid, point, margin(&solid))
        };
        let is_near_closed = |solid: AnySolid| {
            !frame.is_far_from_closed(&solid, point, greatest)
                && !frame.is_far_from_closed(&solid, point, margin(&solid))
        };
        let composed = prototype.solids.compositions.iter();
        let mut leaves = composed.flat_map(|record| record.solid.solids());
        prototype.singles().any(|(_, solid)| is_near(solid))
            || leaves.any(is_near_closed)
            || prototype.placements.iter().any(|placement| {
                let world_from_child = *world_from_here * placement.parent_from_child;
                let Some(child) = self.reached[placement.of.0 as usize] else {
                    return false;
                };
                let placed = child.bounds.transformed(&world_from_child);
                let deviation = Frame::new(&world_from_child).greatest_length(child.deviation);
                let length = allowance.of(farthest(&placed)) + deviation;
                let reach = 1.001 * length + ROUNDING * point.length();
                !child.bounds.is_empty()
                    && placed.grown(reach).meets(&Bounds::at(point))
                    && self.may_be_near_in(placement.of, &world_from_child, point, allowance)
            })
    }
}
