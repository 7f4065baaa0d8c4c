//! From a scene's description to built prototypes.

use std::sync::Arc;

use super::prototype::Prototype;
use crate::embree::{self, Device};
use crate::math::{ChildFromParent, PlacementErrors};
use crate::scene::{GREATEST_CONDITION, GREATEST_DEPTH, GREATEST_STRETCH, PrototypeIndex, Scene};

/// Why a scene cannot be traced.
#[derive(Debug, thiserror::Error)]
pub enum TracerError {
    /// Embree refused.
    #[error(transparent)]
    Embree(#[from] embree::Error),
    /// A placement flattens too much.
    #[error(
        "placement {placement} of prototype \"{of}\" in \"{prototype}\" stretches one direction {condition:.1e} times as much as another: at most {:.1e} can be traced accurately",
        GREATEST_CONDITION
    )]
    Condition {
        /// The prototype that holds the placement; empty for the root.
        prototype: String,
        /// The placement's number in it.
        placement: usize,
        /// The prototype that is placed.
        of: String,
        /// The ratio.
        condition: f64,
    },
    /// The placements on some path stretch or shrink too much together.
    #[error(
        "nested placements of prototype \"{prototype}\" scale by {stretch:.1e} in all: factors between {:.1e} and {:.1e} can be traced",
        1.0 / GREATEST_STRETCH,
        GREATEST_STRETCH
    )]
    Stretch {
        /// The innermost prototype.
        prototype: String,
        /// The factor.
        stretch: f64,
    },
    /// Placements are nested too deeply.
    #[error("placements are nested {depth} deep: at most {GREATEST_DEPTH} levels can be traced")]
    Depth {
        /// The number of levels.
        depth: usize,
    },
}

/// What a walk over all placements of the scene finds out.
pub(crate) struct Plan {
    /// The prototypes that the root needs, children before parents.
    pub order: Vec<PrototypeIndex>,
    /// For every prototype, the cylinders in it and in all it places; counts
    /// beyond u128 stay at its greatest number.
    pub instanced_cylinders: Vec<u128>,
    /// For every prototype, the placements in it and in all it places.
    pub instances: Vec<u128>,
}

/// The least and greatest scale along any path below a prototype, and its depth.
#[derive(Clone, Copy)]
struct Nesting {
    depth: usize,
    least: f64,
    greatest: f64,
}

impl Plan {
    /// Plans the build of the root.
    pub fn new(scene: &Scene) -> Result<Self, TracerError> {
        let count = scene.prototypes.len();
        let mut plan = Self {
            order: Vec::new(),
            instanced_cylinders: vec![0; count],
            instances: vec![0; count],
        };
        let mut nesting = vec![None; count];
        plan.visit(scene, PrototypeIndex::ROOT, &mut nesting)?;
        Ok(plan)
    }

    /// Visits a prototype after all that it places. The description holds no
    /// cycles, and scene files no more than [`GREATEST_DEPTH`] levels.
    fn visit(
        &mut self,
        scene: &Scene,
        index: PrototypeIndex,
        known: &mut [Option<Nesting>],
    ) -> Result<Nesting, TracerError> {
        if let Some(nesting) = known[index.0 as usize] {
            return Ok(nesting);
        }
        let prototype = &scene.prototypes[index.0 as usize];
        let mut nesting = Nesting {
            depth: 0,
            least: 1.0,
            greatest: 1.0,
        };
        let mut cylinders = prototype.cylinders.len() as u128;
        let mut instances = prototype.placements.len() as u128;
        for (number, placement) in prototype.placements.iter().enumerate() {
            let child = self.visit(scene, placement.of, known)?;
            let way = ChildFromParent::new(&placement.parent_from_child);
            let errors = PlacementErrors::new(&placement.parent_from_child, &way);
            let of = &scene.prototypes[placement.of.0 as usize].name;
            if !(errors.condition <= GREATEST_CONDITION) {
                return Err(TracerError::Condition {
                    prototype: prototype.name.clone(),
                    placement: number,
                    of: of.clone(),
                    condition: errors.condition,
                });
            }
            let greatest = child.greatest * errors.stretch;
            let least = child.least * errors.shrink;
            for stretch in [least, greatest] {
                if !(1.0 / GREATEST_STRETCH..=GREATEST_STRETCH).contains(&stretch) {
                    return Err(TracerError::Stretch {
                        prototype: of.clone(),
                        stretch,
                    });
                }
            }
            nesting.depth = nesting.depth.max(child.depth + 1);
            nesting.least = nesting.least.min(least);
            nesting.greatest = nesting.greatest.max(greatest);
            let of = placement.of.0 as usize;
            cylinders = cylinders.saturating_add(self.instanced_cylinders[of]);
            instances = instances.saturating_add(self.instances[of]);
        }
        if nesting.depth > GREATEST_DEPTH {
            return Err(TracerError::Depth {
                depth: nesting.depth,
            });
        }
        self.instanced_cylinders[index.0 as usize] = cylinders;
        self.instances[index.0 as usize] = instances;
        self.order.push(index);
        known[index.0 as usize] = Some(nesting);
        Ok(nesting)
    }
}

/// Builds the prototypes in the plan's order; those it leaves out stay `None`.
pub(crate) fn build(
    device: &Device,
    scene: &Arc<Scene>,
    plan: &Plan,
) -> Result<Vec<Option<Arc<Prototype>>>, TracerError> {
    let mut built = vec![None; scene.prototypes.len()];
    for &index in &plan.order {
        built[index.0 as usize] = Prototype::build(device, scene, index, &built)?;
    }
    Ok(built)
}
