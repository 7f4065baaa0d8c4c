//! Trees of operations over given solids.

use cyltrace::math::Random;
use cyltrace::solid::{AnySolid, Composition};

use super::ComposedFamily;

/// The depth of nested trees.
const DEPTH: u32 = 6;

/// A tree that suits the family.
pub(super) fn draw(
    family: ComposedFamily,
    random: &mut Random,
    solids: &[AnySolid],
) -> Composition {
    match family {
        ComposedFamily::Nested => nested(random, solids, DEPTH),
        ComposedFamily::CoincidentOperands => branching(random, solids, 3),
        ComposedFamily::Stacks => stack(random, solids),
        _ => flat(random, solids),
    }
}

fn operation(random: &mut Random, parts: Vec<Composition>) -> Composition {
    match random.below(3) {
        0 => Composition::Union(parts),
        1 => Composition::Intersection(parts),
        _ => Composition::Difference(parts),
    }
}

fn any_of(random: &mut Random, solids: &[AnySolid]) -> Composition {
    Composition::Solid(solids[random.below(solids.len() as u64) as usize])
}

/// One operation on all, or one on the first and another on the rest.
fn flat(random: &mut Random, solids: &[AnySolid]) -> Composition {
    let parts: Vec<_> = solids.iter().copied().map(Composition::Solid).collect();
    if parts.len() > 2 && random.below(2) == 0 {
        let rest = operation(random, parts[1..].to_vec());
        return operation(random, vec![parts[0].clone(), rest]);
    }
    operation(random, parts)
}

/// A chain of operations with solids on either side, as deep as stated.
fn nested(random: &mut Random, solids: &[AnySolid], depth: u32) -> Composition {
    if depth == 0 {
        return any_of(random, solids);
    }
    let mut parts = vec![nested(random, solids, depth - 1), any_of(random, solids)];
    if random.below(3) == 0 {
        parts.swap(0, 1);
    }
    operation(random, parts)
}

/// A tree in which each operand is drawn from the solids anew.
fn branching(random: &mut Random, solids: &[AnySolid], depth: u32) -> Composition {
    if depth == 0 || random.below(3) == 0 {
        return any_of(random, solids);
    }
    let count = 2 + random.below(2);
    let parts = (0..count)
        .map(|_| branching(random, solids, depth - 1))
        .collect();
    operation(random, parts)
}

/// Solids and bores in turn: all bores out of all solids, each out of its own, or
/// filled again.
fn stack(random: &mut Random, solids: &[AnySolid]) -> Composition {
    use Composition::{Difference, Solid, Union};
    let pairs = || solids.chunks_exact(2);
    let blocks = || pairs().map(|pair| Solid(pair[0]));
    let bores = || pairs().map(|pair| Solid(pair[1]));
    let bored = || pairs().map(|pair| Difference(vec![Solid(pair[0]), Solid(pair[1])]));
    match random.below(5) {
        0 => Union(blocks().collect()),
        1 => Difference(
            [Union(blocks().collect())]
                .into_iter()
                .chain(bores())
                .collect(),
        ),
        2 => Difference(vec![Union(blocks().collect()), Union(bores().collect())]),
        3 => Union(bored().collect()),
        _ => Union(bored().chain(bores()).collect()),
    }
}
