//! Validates the graph of prototypes that place each other: it has no cycles and
//! not too many levels, every branch ends in solids, and numbers stay in range
//! throughout.

use super::description::Prototype;
use super::error::SceneError;
use super::limits::{GREATEST_DEPTH, GREATEST_STRETCH};
use super::names::quoted;
use super::placing::Edge;
use super::source::Source;
use crate::solid::Cylinder;

/// A prototype and the entries that place others in it.
pub(super) struct Node<'a> {
    pub prototype: &'a Prototype,
    pub edges: &'a [Edge],
    /// An upper bound of the size of its own solids' coordinates.
    pub reach: f64,
    /// Rows of its tables that were skipped.
    pub skipped: u64,
}

impl Node<'_> {
    fn has_solids(&self) -> bool {
        !self.prototype.solids.is_empty()
    }

    /// Why it contains no solids, if all of its rows were skipped.
    fn emptied(&self) -> String {
        match self.skipped {
            0 => String::new(),
            rows => format!(" (all {rows} rows were skipped as degenerate)"),
        }
    }
}

/// The totals of a prototype and everything placed in it.
#[derive(Clone, Copy, Default)]
struct Summary {
    has_solids: bool,
    /// The depth of nested placements.
    levels: usize,
    /// An upper bound of the size of every coordinate.
    reach: f64,
    /// An upper bound of the factor by which vectors grow when mapped outward.
    stretch: f64,
    /// An upper bound of the factor by which they grow when mapped inward.
    squeeze: f64,
}

/// Checks all prototypes; the first is the root.
pub(super) fn check(source: &Source, nodes: &[Node]) -> Result<(), SceneError> {
    let mut summaries = vec![Summary::default(); nodes.len()];
    for index in children_first(source, nodes)? {
        summaries[index] = summary(source, nodes, &summaries, index)?;
    }
    if summaries.first().is_none_or(|root| !root.has_solids) {
        return Err(source.error_with_help(
            0..0,
            format!(
                "the scene is empty: it contains no solids{}",
                nodes.first().map_or_else(String::new, Node::emptied)
            ),
            "add a [[cylinder]] or another solid, a [[cylinder_table]] or an [[swc]], or place a prototype with an [[instance]]",
        ));
    }
    Ok(())
}

fn summary(
    source: &Source,
    nodes: &[Node],
    summaries: &[Summary],
    index: usize,
) -> Result<Summary, SceneError> {
    let node = &nodes[index];
    let mut total = Summary {
        has_solids: node.has_solids(),
        levels: 0,
        reach: node.reach,
        stretch: 1.0,
        squeeze: 1.0,
    };
    for edge in node.edges {
        let of = edge.of.0 as usize;
        let child = summaries[of];
        let name = quoted(&nodes[of].prototype.name);
        let wrong = |message: String| Err(source.error(edge.place.clone(), message));
        if !child.has_solids {
            return wrong(format!(
                "the prototype {name} contains no solids{}: it cannot be placed",
                nodes[of].emptied()
            ));
        }
        total.has_solids = true;
        total.levels = total.levels.max(child.levels + 1);
        if total.levels > GREATEST_DEPTH {
            return wrong(format!(
                "placements are nested {} levels deep: at most {GREATEST_DEPTH} are supported",
                total.levels
            ));
        }
        // The distance of a point is at most √3 times its greatest coordinate.
        let reach = 2.0 * edge.reach.stretch * child.reach + edge.reach.translation;
        if reach > Cylinder::GREATEST {
            return wrong(format!(
                "placed here, {name} may reach coordinates of {reach:.1e}: at most {:.1e} are supported",
                Cylinder::GREATEST
            ));
        }
        total.reach = total.reach.max(reach);
        let stretch = edge.reach.stretch * child.stretch;
        let squeeze = edge.reach.squeeze * child.squeeze;
        if stretch.max(squeeze) > GREATEST_STRETCH {
            return wrong(format!(
                "nested placements scale the content of {name} by factors from {:.1e} to {stretch:.1e}: factors from {:.1e} to {:.1e} are supported",
                1.0 / squeeze,
                1.0 / GREATEST_STRETCH,
                GREATEST_STRETCH
            ));
        }
        total.stretch = total.stretch.max(stretch);
        total.squeeze = total.squeeze.max(squeeze);
    }
    Ok(total)
}

/// An order in which every prototype comes after those placed in it.
///
/// A depth-first search with its own stack, because a chain of placements may be
/// as long as the file.
fn children_first(source: &Source, nodes: &[Node]) -> Result<Vec<usize>, SceneError> {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        Unseen,
        OnPath,
        Done,
    }
    let mut states = vec![State::Unseen; nodes.len()];
    let mut order = Vec::with_capacity(nodes.len());
    for start in 0..nodes.len() {
        if states[start] != State::Unseen {
            continue;
        }
        states[start] = State::OnPath;
        // The prototypes on the path, each with its next edge.
        let mut path = vec![(start, 0)];
        while let Some(&(index, next)) = path.last() {
            let Some(edge) = nodes[index].edges.get(next) else {
                states[index] = State::Done;
                order.push(index);
                path.pop();
                continue;
            };
            if let Some(top) = path.last_mut() {
                top.1 += 1;
            }
            let child = edge.of.0 as usize;
            match states[child] {
                State::Done => {}
                State::Unseen => {
                    states[child] = State::OnPath;
                    path.push((child, 0));
                }
                State::OnPath => {
                    let indices: Vec<usize> = path.iter().map(|&(index, _)| index).collect();
                    return Err(cycle(source, nodes, &indices, child, edge));
                }
            }
        }
    }
    Ok(order)
}

/// The error that the end of `path` places `child`, which is on the path.
fn cycle(source: &Source, nodes: &[Node], path: &[usize], child: usize, edge: &Edge) -> SceneError {
    const MOST_SHOWN: usize = 12;
    let start = path.iter().position(|&index| index == child).unwrap_or(0);
    let round = &path[start..];
    let mut names: Vec<String> = round
        .iter()
        .take(MOST_SHOWN)
        .map(|&index| quoted(&nodes[index].prototype.name))
        .collect();
    if round.len() > MOST_SHOWN {
        names.push(format!("({} more)", round.len() - MOST_SHOWN));
    }
    names.push(quoted(&nodes[child].prototype.name));
    source.error(
        edge.place.clone(),
        format!(
            "prototypes place each other in a cycle: {}",
            names.join(" -> ")
        ),
    )
}
