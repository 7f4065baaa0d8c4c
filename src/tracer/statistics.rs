//! What was built, and what was not.

use std::slice;
use std::sync::Arc;

use super::build::Plan;
use super::estimate::MemoryEstimate;
use super::options::Options;
use super::prototype::Prototype;
use crate::scene::{Placement, Scene};
use crate::solid::SolidCounts;

/// What was built, and what was not.
#[derive(Clone, Debug)]
pub struct Statistics {
    /// Solids in the prototypes that the root places.
    pub unique: SolidCounts,
    /// Solids in the scene with every placement counted.
    pub instanced: SolidCounts,
    /// Placements in the scene, with those in placed prototypes counted each time.
    pub instances: u128,
    /// Placements that are instances of Embree's, in what is built.
    pub embree_instances: u64,
    /// Memory that Embree uses.
    pub embree_bytes: usize,
    /// Memory of the records of solids and placements.
    pub records_bytes: usize,
    /// What was not built so far, because it was not needed.
    pub skipped: Vec<String>,
    /// The version of the Embree library.
    pub embree_version: String,
    /// The instruction set in use.
    pub isa: String,
}

/// The constant part of a tracer's statistics.
pub(super) struct Counted {
    pub unique: SolidCounts,
    pub instanced: SolidCounts,
    pub instances: u128,
    pub described_bytes: usize,
}

impl Counted {
    pub fn new(scene: &Scene, plan: &Plan) -> Self {
        let used = plan.order.iter();
        let used = used.map(|index| &scene.prototypes[index.0 as usize]);
        Self {
            unique: used.fold(SolidCounts::default(), |sum, prototype| {
                sum.plus(&prototype.solids.counts())
            }),
            instanced: plan.instanced[0],
            instances: plan.instances[0],
            described_bytes: described_bytes(scene),
        }
    }
}

/// A sentence for each prototype that was not built, and one for rows of tables that are no
/// solid.
pub(super) fn skipped(
    scene: &Scene,
    made: &[Option<Arc<Prototype>>],
    options: &Options,
) -> Vec<String> {
    let rows = (scene.skipped_rows > 0)
        .then(|| format!("degenerate rows of tables: {}", scene.skipped_rows));
    let contents = scene.contents();
    let unbuilt = contents.iter().enumerate().filter_map(|(index, contents)| {
        let name = match contents.name.as_str() {
            "" => "the scene itself".to_owned(),
            name => format!("prototype \"{name}\""),
        };
        if !contents.is_used {
            return Some(format!("{name} is placed nowhere: not built"));
        }
        let made = made[index].as_ref()?;
        (!made.is_touched()).then(|| {
            let estimate =
                MemoryEstimate::of(slice::from_ref(contents), options.layout, options.max_isa);
            format!(
                "{name} was reached by no ray: not built ({} and {} placements), which saves about {:.1} MB",
                contents.solids.counts,
                contents.placements(),
                (estimate.embree_bytes + estimate.copies_bytes) as f64 / 1e6
            )
        })
    });
    let out_of_view = made
        .first()
        .and_then(|root| Some(root.as_ref()?.placements_out_of_view()))
        .filter(|&count| count > 0)
        .map(|count| format!("{count} placements are out of the camera's view: not built"));
    let general = rows.into_iter().chain(out_of_view);
    general.chain(unbuilt).collect()
}

/// The memory of solids, placements and their values, and of images, in the description.
fn described_bytes(scene: &Scene) -> usize {
    let prototypes = scene.prototypes.iter();
    let bytes = prototypes.map(|prototype| {
        let placements = prototype.placements.len() * size_of::<Placement>();
        prototype.solids.records_bytes() + placements + prototype.values_bytes()
    });
    bytes.sum::<usize>() + scene.images_bytes()
}
