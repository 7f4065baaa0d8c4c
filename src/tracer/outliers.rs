//! Solids and placements that are very far from the others of their prototype, or very large
//! compared with them. They are likely mistakes: a row of zeros, a wrong unit.
//!
//! They are the members of the small groups of `prototype/grouping.rs`: those that have a frame
//! of their own because they would slow down the others.

use super::build::Plan;
use super::prototype::{Boxes, List};
use crate::math::Bounds;
use crate::scene::{PrototypeIndex, Scene};
use crate::solid::SolidKind;

/// The greatest number of members of a group of outliers. A group with at most a hundredth of
/// its prototype's members also counts as one.
const FEW: u64 = 3;

/// A solid or a placement that is far away from all others, or large compared with them.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlier {
    /// The prototype that contains it.
    pub prototype: PrototypeIndex,
    /// The kind of solid; `None` for a placement.
    pub kind: Option<SolidKind>,
    /// The number of the primitive or the placement within the prototype.
    pub number: u32,
    /// The distance of its center from that of the others' box, in half diagonals of that box.
    pub distance: f64,
    /// The diagonal of its box, in diagonals of the others' box.
    pub size: f64,
}

/// The outliers of all prototypes that the root places, children before parents.
///
/// Runs on the rayon pool that this is called in.
#[must_use]
pub fn outliers(scene: &Scene) -> Vec<Outlier> {
    let mut outliers = Vec::new();
    // A scene that cannot be traced has no groups.
    let Ok(plan) = Plan::new(scene) else {
        return outliers;
    };
    let mut boxes: Vec<Vec<Bounds>> = vec![Vec::new(); scene.prototypes.len()];
    for &index in &plan.order {
        let prototype = &scene.prototypes[index.0 as usize];
        let boxes_of = |of: PrototypeIndex| &boxes[of.0 as usize][..];
        let all = Boxes::new(prototype, &boxes_of);
        let groups = all.groups();
        let total: u64 = groups.iter().map(|(members, _)| members.len()).sum();
        if let Some((_, most)) = groups.first() {
            for (members, _) in &groups[1..] {
                if members.len() > FEW.max(total / 100) {
                    continue;
                }
                outliers.extend(members.iter().filter_map(|(list, position)| {
                    let (kind, number) = match list {
                        List::Solids(SolidKind::Union) => {
                            let record = &prototype.solids.compositions[position as usize];
                            (Some(record.solid.kind()), record.primitive)
                        }
                        List::Solids(kind) => (
                            Some(kind),
                            prototype.solids.primitive(kind, position as usize),
                        ),
                        List::Placements { group: 0 } => (None, position),
                        // An outlier of the placed prototype, which is reported there.
                        List::Placements { .. } => return None,
                    };
                    let bounds = all.entry(list, position);
                    let apart = (bounds.center() - most.center()).length();
                    let reach = 0.5 * most.extent().length();
                    Some(Outlier {
                        prototype: index,
                        kind,
                        number,
                        distance: apart / reach,
                        size: 0.5 * bounds.extent().length() / reach,
                    })
                }));
            }
        }
        boxes[index.0 as usize] = groups.into_iter().map(|(_, bounds)| bounds).collect();
    }
    outliers
}

#[cfg(test)]
mod tests;
