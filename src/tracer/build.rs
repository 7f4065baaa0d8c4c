//! From a scene's description to prototypes that are ready to be built.

use std::sync::Arc;

use rayon::prelude::*;

use super::prototype::{BuildContext, Outlines, Prototype};
use crate::embree;
use crate::math::{ChildFromParent, PlacementErrors};
use crate::scene::{
    GREATEST_CONDITION, GREATEST_DEPTH, GREATEST_STRETCH, Placement, PrototypeIndex, Scene,
};

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
    /// For every prototype, the solids of other kinds likewise.
    pub instanced_others: Vec<u128>,
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
            instanced_others: vec![0; count],
            instances: vec![0; count],
        };
        let mut nesting = vec![None; count];
        plan.visit(scene, PrototypeIndex::ROOT, 0, &mut nesting)?;
        Ok(plan)
    }

    /// Visits a prototype after all that it places. The description holds no
    /// cycles, and scene files no more than [`GREATEST_DEPTH`] levels.
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
        // Scattered placements come in runs of the same prototype.
        let mut last = None;
        for placement in &prototype.placements {
            if last.replace(placement.of) != Some(placement.of) {
                self.visit(scene, placement.of, level + 1, known)?;
            }
        }
        let total = prototype
            .placements
            .par_iter()
            .with_min_len(1 << 10)
            .enumerate()
            .map(|(number, placement)| {
                let of = placement.of.0 as usize;
                let child = known[of].expect("what is placed was visited");
                let errors = placement_errors(scene, prototype, number, placement)?;
                Ok::<_, TracerError>(Total {
                    nesting: child.placed(&errors, &scene.prototypes[of].name)?,
                    cylinders: self.instanced_cylinders[of],
                    others: self.instanced_others[of],
                    instances: self.instances[of].saturating_add(1),
                })
            })
            .try_reduce(Total::default, |one, other| Ok(one.with(&other)))?;
        let nesting = total.nesting;
        if nesting.depth > GREATEST_DEPTH {
            return Err(TracerError::Depth {
                depth: nesting.depth,
            });
        }
        let cylinders = prototype.cylinders.len() as u128;
        self.instanced_cylinders[index.0 as usize] = total.cylinders.saturating_add(cylinders);
        let others = prototype.solids.len() as u128;
        self.instanced_others[index.0 as usize] = total.others.saturating_add(others);
        self.instances[index.0 as usize] = total.instances;
        self.order.push(index);
        known[index.0 as usize] = Some(nesting);
        Ok(nesting)
    }
}

/// The roundings of a placement, if they can be borne.
fn placement_errors(
    scene: &Scene,
    prototype: &crate::scene::Prototype,
    number: usize,
    placement: &Placement,
) -> Result<PlacementErrors, TracerError> {
    let way = ChildFromParent::new(&placement.parent_from_child);
    let errors = PlacementErrors::new(&placement.parent_from_child, &way);
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

impl Nesting {
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

/// What all placements of a prototype come to.
#[derive(Clone, Copy)]
struct Total {
    nesting: Nesting,
    cylinders: u128,
    others: u128,
    instances: u128,
}

impl Default for Total {
    fn default() -> Self {
        Self {
            nesting: Nesting {
                depth: 0,
                least: 1.0,
                greatest: 1.0,
            },
            cylinders: 0,
            others: 0,
            instances: 0,
        }
    }
}

impl Total {
    fn with(&self, other: &Self) -> Self {
        let (one, two) = (&self.nesting, &other.nesting);
        Self {
            nesting: Nesting {
                depth: one.depth.max(two.depth),
                least: one.least.min(two.least),
                greatest: one.greatest.max(two.greatest),
            },
            cylinders: self.cylinders.saturating_add(other.cylinders),
            others: self.others.saturating_add(other.others),
            instances: self.instances.saturating_add(other.instances),
        }
    }
}

/// Makes the prototypes in the plan's order; those it leaves out stay `None`.
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
