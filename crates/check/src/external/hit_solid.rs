//! A solid that a ray hits: its placement, extent and thickness.

use glam::{DAffine3, DVec3};

use super::deviation::{Deviation, Slack};
use super::nearness::Frame;
use super::tolerance::{Allowance, Margin, farthest, least_radius};
use crate::solids::scene_solid::{SceneSolid, find};
use cyltrace::math::Ray;
use cyltrace::scene::Scene;
use cyltrace::solid::AnySolid;
use cyltrace::tracer::PartialHit;

/// A solid that a ray hits.
pub(super) struct HitSolid<'a> {
    /// The placements from the root to it, and its number.
    solid: (Vec<u32>, u32),
    frame: Frame,
    found: SceneSolid<'a>,
    /// The distance of its box's farthest corner from the world's origin, or of its leaves'
    /// boxes.
    pub extent: f64,
    /// At most its least radius in the world, less what its mesh may lack.
    pub spare_radius: f64,
    /// By how much its mesh may be off.
    slack: Slack,
    /// The `t` of its hits, rising.
    pub at: Vec<f64>,
}

impl<'a> HitSolid<'a> {
    /// The solid of a hit whose path was requested.
    pub fn new(scene: &'a Scene, hit: &PartialHit, deviation: Deviation) -> Self {
        let (placements, found) = find(scene, path(hit), hit.primitive());
        let whole = placements
            .iter()
            .fold(DAffine3::IDENTITY, |whole, &one| whole * *one);
        let frame = Frame::new(&whole);
        let parts = match &found {
            SceneSolid::Single(solid) => vec![*solid],
            SceneSolid::Composed(solid) => solid.solids(),
        };
        let slack = match (&found, &parts[..]) {
            (SceneSolid::Single(solid), _) => deviation.slack(solid),
            (SceneSolid::Composed(_), parts) => {
                Slack::of_parts(parts.iter().map(|part| deviation.slack(part)))
            }
        };
        let extents = parts
            .iter()
            .map(|one| farthest(&one.bounds().transformed(&whole)));
        Self {
            solid: (path(hit).to_vec(), hit.primitive()),
            extent: extents.fold(0.0, f64::max),
            spare_radius: frame.least_length(slack.spare_radius(least_radius(parts))),
            slack,
            frame,
            found,
            at: vec![hit.t()],
        }
    }

    /// Whether it is the solid of a hit.
    pub fn is_of(&self, hit: &PartialHit) -> bool {
        self.solid.1 == hit.primitive() && self.solid.0 == path(hit)
    }

    /// By how much an answer about it may be off.
    pub fn margin(&self, allowance: &Allowance) -> Margin {
        Margin {
            length: allowance.of(self.extent),
            slack: self.slack,
        }
    }

    /// At least what a margin is in the world.
    pub fn in_world(&self, margin: Margin) -> f64 {
        self.frame.in_world(margin)
    }

    /// Whether the ray is proven to pass through its surface in a range.
    pub fn is_crossed(&self, ray: &Ray, range: (f64, f64), margin: Margin) -> bool {
        match &self.found {
            SceneSolid::Single(solid) => self.frame.is_crossed(solid, ray, range, margin),
            SceneSolid::Composed(solid) => {
                let frame = &self.frame;
                frame.is_composition_crossed(solid, ray, range, margin, &self.at)
            }
        }
    }

    /// Whether a point is proven to be farther from its surface than a margin.
    pub fn is_far(&self, point: DVec3, margin: Margin) -> bool {
        let single = self.single();
        single.is_some_and(|solid| self.frame.is_far(solid, point, margin))
    }

    /// Whether a point is proven to be near its surface.
    pub fn is_near(&self, point: DVec3, margin: Margin) -> bool {
        let single = self.single();
        single.is_some_and(|solid| self.frame.is_near(solid, point, margin))
    }

    /// Nothing is proven about the distance from a composition: near the surface of one of its
    /// leaves, its own surface may be missing.
    fn single(&self) -> Option<&AnySolid> {
        match &self.found {
            SceneSolid::Single(solid) => Some(solid),
            SceneSolid::Composed(_) => None,
        }
    }
}

/// The path of a hit, which this check requests of all hits.
fn path(hit: &PartialHit) -> &[u32] {
    hit.instance().expect("the check requests paths")
}
