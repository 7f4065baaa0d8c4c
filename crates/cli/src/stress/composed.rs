//! `cyltrace stress --replay` of a case of set operations.

use cyltrace::solid::Composition;
use cyltrace_bench::stress::{ComposedWitness, Verdict};
use cyltrace_oracle::cases::ComposedCase;
use cyltrace_oracle::to_f64;
use cyltrace_output::Table;
use glam::DVec3;

use crate::print::print;

/// Prints the case, all true crossings with the faces that an answer may name, and those of
/// the solver; then where the points are.
pub fn run(case: &ComposedCase) -> anyhow::Result<()> {
    let ComposedCase {
        composition,
        ray,
        points,
    } = case;
    let mut text = tree(composition, 0, &mut 0);
    text += &row_of("origin", ray.origin);
    text += &row_of("direction", ray.direction);
    text += &format!("range     {:?} {:?}\n", ray.t_min, ray.t_max);

    let witness = ComposedWitness::new(case);
    let mut crossings = Table::new(&["who", "crossing", "t", "operand and part"], 4);
    let mut push = |who: &str, crossing: &str, t: f64, parts: Vec<String>| {
        let row = [who.to_owned(), crossing.to_owned(), format!("{t:?}")];
        crossings.push(row.into_iter().chain([parts.join(", ")]).collect());
    };
    for hit in &witness.hits {
        let faces = hit.faces.iter();
        let parts = faces.map(|face| format!("{} {}", face.leaf, face.part.name()));
        push(
            "oracle",
            hit.crossing.name(),
            to_f64(&hit.t),
            parts.collect(),
        );
    }
    let from = |anchor| ray.origin - anchor;
    let range = [ray.t_min, ray.t_max];
    composition.intersections(from, ray.direction, 0.0, range, |met| {
        let part = format!("{} {}", met.leaf, met.intersection.part.name());
        let intersection = met.intersection;
        push(
            "solver",
            intersection.crossing.name(),
            intersection.t,
            vec![part],
        );
    });

    let mut located = Table::new(&["point", "oracle", "solver"], 3);
    for (point, location) in points.iter().zip(&witness.locations) {
        located.push(vec![
            format!("{:?} {:?} {:?}", point.x, point.y, point.z),
            format!("{location:?}"),
            format!("{:?}", composition.locate(*point)),
        ]);
    }
    let verdict = match Verdict::of(case, &witness).is_wrong() {
        true => "the solver is wrong",
        false => "the solver is right",
    };
    print(&format!("{text}{crossings}{located}{verdict}\n"))
}

/// The operations, an operand a line with its number.
fn tree(composition: &Composition, depth: usize, leaf: &mut u32) -> String {
    let indent = "  ".repeat(depth);
    let (name, parts) = match composition {
        Composition::Solid(solid) => {
            let line = format!("{indent}{leaf} {solid:?}\n");
            *leaf += 1;
            return line;
        }
        Composition::Union(parts) => ("union", parts),
        Composition::Intersection(parts) => ("intersection", parts),
        Composition::Difference(parts) => ("difference", parts),
    };
    let parts = parts.iter().map(|part| tree(part, depth + 1, leaf));
    format!("{indent}{name}\n{}", parts.collect::<String>())
}

/// A line with the digits of a vector.
pub(super) fn row_of(name: &str, vector: DVec3) -> String {
    format!("{name:<10}{:?} {:?} {:?}\n", vector.x, vector.y, vector.z)
}
