//! Counts the solids of a beam lattice before they are made.
//!
//! This reads the whole model and drops it: an object may be placed many times, so only
//! the whole model determines the number of solids.

use std::collections::BTreeSet;

use toml::Spanned;

use super::element::Element;
use super::lattice::{End, Lattice};
use super::model::Model;
use super::package;
use super::part::parsed;
use crate::scene::contents::ExpectedSolids;
use crate::scene::error::SceneError;
use crate::scene::record::Records;
use crate::scene::source::Source;
use crate::solid::SolidKind;

/// Counts the solids of a `[[beam_lattice]]`. A half ball counts even if a greater ball at
/// its vertex will contain it.
pub(super) fn count(
    source: &Source,
    file: &Spanned<String>,
    records: Records,
    solids: &mut ExpectedSolids,
) -> Result<(), SceneError> {
    let part = package::model_part(source, file)?;
    let document = parsed(&part)?;
    // Meshes add no solids, whether they are an error or not.
    let model = Model::new(&Element::root(&part.path, &document), true)?;
    for placed in &model.placed {
        let kinds = Kinds::of(&placed.lattice);
        let times = |count: u64| count.saturating_mul(placed.places.len() as u64);
        for (kind, more) in [
            (SolidKind::Cylinder, kinds.cylinders),
            (SolidKind::Cone, kinds.cones),
            (SolidKind::Sphere, kinds.balls),
            (SolidKind::Intersection, kinds.halves),
        ] {
            solids.add(kind, times(more), records);
        }
        solids.add_operands(times(2 * kinds.halves));
    }
    Ok(())
}

/// The solids of a lattice in one place, by kind.
#[derive(Default)]
struct Kinds {
    cylinders: u64,
    cones: u64,
    balls: u64,
    halves: u64,
}

impl Kinds {
    fn of(lattice: &Lattice) -> Self {
        let mut kinds = Self::default();
        let mut balls: BTreeSet<usize> = lattice.balls.keys().copied().collect();
        for beam in lattice.beams.iter().filter(|beam| !beam.is_short) {
            match beam.radii[0] == beam.radii[1] {
                true => kinds.cylinders += 1,
                false => kinds.cones += 1,
            }
            let [from, to] = beam.vertices.map(|vertex| lattice.vertices[vertex]);
            for end in [0, 1] {
                match beam.end(end, beam.radii, from.distance(to)) {
                    End::Flat => {}
                    End::Ball => {
                        balls.insert(beam.vertices[end]);
                    }
                    End::Half => kinds.halves += 1,
                }
            }
        }
        kinds.balls = balls.len() as u64;
        kinds
    }
}
