//! What a beam lattice will hold, counted before a solid of it is made.
//!
//! The model is read for it and forgotten: an object stands in the file once and may be
//! placed many times, so that only the model as a whole says how many solids there will be.

use std::collections::BTreeSet;

use toml::Spanned;

use super::element::Element;
use super::lattice::{End, Lattice};
use super::model::Model;
use super::package;
use crate::scene::contents::OtherSolids;
use crate::scene::error::SceneError;
use crate::scene::source::Source;
use crate::solid::{Cone, Sphere};

/// The cylinders and the other solids of a `[[beam_lattice]]`. Half a ball counts also
/// where a greater ball at its vertex will hold it.
pub(in crate::scene) fn counted(
    source: &Source,
    file: &Spanned<String>,
) -> Result<(u64, OtherSolids), SceneError> {
    let part = package::model_part(source, file)?;
    let document = package::parsed(&part)?;
    // Meshes make no solids, whether they are an error or not.
    let model = Model::new(&Element::root(&part.path, &document), true)?;
    let (mut cylinders, mut others) = (0, OtherSolids::default());
    for placed in &model.placed {
        let kinds = Kinds::of(&placed.lattice);
        let times = |count: u64| count.saturating_mul(placed.places.len() as u64);
        cylinders += times(kinds.cylinders);
        others = others
            .and::<Cone>(times(kinds.cones))
            .and::<Sphere>(times(kinds.balls))
            .and_composed(times(kinds.halves), times(2 * kinds.halves));
    }
    Ok((cylinders, others))
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
