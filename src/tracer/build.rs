//! From a scene's description to prototypes that are ready to be built.

use std::sync::Arc;

use rayon::prelude::*;

use super::prototype::{BuildContext, Outlines, Prototype};
use crate::embree;
use crate::math::{ChildFromParent, PlacementErrors};
use crate::scene::{
    GREATEST_CONDITION, GREATEST_DEPTH, GREATEST_STRETCH, PlacedCount, Placement, PrototypeIndex,
    Scene,
};
use crate::solid::SolidCounts;

/// Why a scene cannot be traced.
#[derive(Debug, thiserror::Error)]
pub enum TracerError {
    /// Embree reported an error.
    #[error(transparent)]
    Embree(#[from] embree::Error),
    /// A placement flattens too much.
    #[error(
        "placement {placement} of prototype \"{of}\" in \"{prototype}\" stretches one direction {condition:.1e} times as much as another: at most {:.1e} can be traced accurately",
        GREATEST_CONDITION
    )]
    Condition {
        /// The prototype that contains the placement; empty for the root.
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

/// The result of a walk over all placements of the scene.
pub(crate) struct Plan {
    /// The prototypes that the root uses, children before parents.
    pub order: Vec<PrototypeIndex>,
    /// For every prototype, the solids in it and in everything that it places.
    pub instanced: Vec<SolidCounts>,
    /// For every prototype, the placements in it and in everything that it places. Counts
    /// saturate at the greatest u128.
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
            instanced: vec![SolidCounts::default(); count],
            instances: vec![0; count],
        };
        let mut nesting = vec![None; count];
        plan.visit(scene, PrototypeIndex::ROOT, 0, &mut nesting)?;
        Ok(plan)
    }

    /// Visits a prototype after everything that it places. The description contains no cycles,
    /// and scene files have at most [`GREATEST_DEPTH`] levels.
    fn visit(
        &mut self,
        scene: &Scene,
        index: PrototypeIndex,
        level: usize,
        known: &mut [Option<Nesting>],
    ) -> Result<Nesting, TracerError> {
        if level > GREATEST_DEPTH {
            return Err(TracerError::Depth { depth: level });
        }
        if let Some(nesting) = known[index.0 as usize] {
            return Ok(nesting);
        }
        let prototype = &scene.prototypes[index.0 as usize];
        let mut instances = 0_u128;
        let mut solids = prototype.solids.counts();
        for PlacedCount { of, count } in prototype.placed() {
            self.visit(scene, of, level + 1, known)?;
            let (of, count) = (of.0 as usize, u128::from(count));
            let each = self.instances[of].saturating_add(1);
            instances = instances.saturating_add(each.saturating_mul(count));
            solids = solids.plus(&self.instanced[of].times(count));
        }
        let placements = prototype.placements.par_iter().enumerate();
        let nesting = placements
            .with_min_len(1 << 10)
            .map(|(number, placement)| {
                let of = placement.of.0 as usize;
                let child = known[of].expect("what is placed was visited");
                let errors = placement_errors(scene, prototype, number, placement)?;
                child.placed(&errors, &scene.prototypes[of].name)
            })
            .try_reduce(Nesting::default, |one, other| Ok(one.with(&other)))?;
        if nesting.depth > GREATEST_DEPTH {
            return Err(TracerError::Depth {
                depth: nesting.depth,
            });
        }
        self.instanced[index.0 as usize] = solids;
        self.instances[index.0 as usize] = instances;
        self.order.push(index);
        known[index.0 as usize] = Some(nesting);
        Ok(nesting)
    }
}

/// The roundings of a placement, or an error if they are too large.
fn placement_errors(
    scene: &Scene,
    prototype: &crate::scene::Prototype,
    number: usize,
    placement: &Placement,
) -> Result<PlacementErrors, TracerError> {
    let child_from_parent = ChildFromParent::new(&placement.parent_from_child);
    let errors = PlacementErrors::new(&placement.parent_from_child, &child_from_parent);
    if errors.condition <= GREATEST_CONDITION {
        return Ok(errors);
    }
    Err(TracerError::Condition {
        prototype: prototype.name.clone(),
        placement: number,
        of: scene.prototypes[placement.of.0 as usize].name.clone(),
        condition: errors.condition,
    })
}

impl Default for Nesting {
    fn default() -> Self {
        Self {
            depth: 0,
            least: 1.0,
            greatest: 1.0,
        }
    }
}

impl Nesting {
    /// The nesting of two placements side by side.
    fn with(&self, other: &Self) -> Self {
        Self {
            depth: self.depth.max(other.depth),
            least: self.least.min(other.least),
            greatest: self.greatest.max(other.greatest),
        }
    }

    /// The nesting seen from where the prototype `name` is placed.
    fn placed(&self, errors: &PlacementErrors, name: &str) -> Result<Self, TracerError> {
        let (least, greatest) = (self.least * errors.shrink, self.greatest * errors.stretch);
        for stretch in [least, greatest] {
            if !(1.0 / GREATEST_STRETCH..=GREATEST_STRETCH).contains(&stretch) {
                return Err(TracerError::Stretch {
                    prototype: name.to_owned(),
                    stretch,
                });
            }
        }
        Ok(Self {
            depth: self.depth + 1,
            least,
            greatest,
        })
    }
}

/// Creates the prototypes in the plan's order; others stay `None`.
pub(crate) fn make(
    context: &BuildContext,
    scene: &Arc<Scene>,
    plan: &Plan,
) -> Vec<Option<Arc<Prototype>>> {
    let mut outlines = Outlines::new(scene, &plan.order);
    let mut made = vec![None; scene.prototypes.len()];
    for &index in &plan.order {
        let groups = (index, outlines.take(index));
        made[index.0 as usize] = Prototype::new(context, scene, groups, &made);
    }
    made
}
