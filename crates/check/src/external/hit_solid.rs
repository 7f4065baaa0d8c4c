//! A solid that a ray meets: where it stands, how far it reaches, how thick it is.

use glam::{DAffine3, DVec3};

use super::deviation::{Deviation, Slack};
use super::nearness::{Frame, PlacedComposition, PlacedSolid};
use super::tolerance::{Allowance, Margin, farthest, least_radius};
use crate::solids::scene_solid::{SceneSolid, find};
use cyltrace::math::Ray;
use cyltrace::scene::Scene;
use cyltrace::tracer::PartialHit;

/// A solid that a ray meets.
pub(super) struct HitSolid<'a> {
    /// The placements from the root to it, and its number.
    solid: (Vec<u32>, u32),
    frame: Frame,
    found: SceneSolid<'a>,
    /// How far its box reaches from the world's origin, or those of its leaves.
    pub extent: f64,
    /// At most its least radius in the world, less what its mesh may lack.
    pub spare_radius: f64,
    /// What its mesh may be off.
    slack: Slack,
    /// Where the ray meets it, rising.
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

    /// What an answer about it may be off.
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

    /// Whether the ray is proven to pass through its surface between two `t`.
    pub fn is_crossed(&self, ray: &Ray, (start, end): (f64, f64), margin: Margin) -> bool {
        let frame = &self.frame;
        match self.found {
            SceneSolid::Single(solid) => {
                PlacedSolid { solid, frame }.is_crossed(ray, (start, end), margin)
            }
            SceneSolid::Composed(solid) => {
                let placed = PlacedComposition { solid, frame };
                placed.is_crossed(ray, (start, end), margin, &self.at)
            }
        }
    }

    /// Whether a point is proven to be farther from its surface than a margin.
    pub fn is_far(&self, point: DVec3, margin: Margin) -> bool {
        let frame = &self.frame;
        match self.found {
            SceneSolid::Single(solid) => PlacedSolid { solid, frame }.is_far(point, margin),
            SceneSolid::Composed(_) => false,
        }
    }

    /// Whether a point is proven to be near its surface.
    pub fn is_near(&self, point: DVec3, margin: Margin) -> bool {
        let frame = &self.frame;
        match self.found {
            SceneSolid::Single(solid) => PlacedSolid { solid, frame }.is_near(point, margin),
            // Near one of the surfaces that it is made of, there may be nothing of it.
            SceneSolid::Composed(_) => false,
        }
    }
}

/// The path of a hit, which this check requests of all hits.
fn path(hit: &PartialHit) -> &[u32] {
    hit.instance().expect("the check requests paths")
}
