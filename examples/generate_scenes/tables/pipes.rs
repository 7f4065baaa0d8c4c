//! Pipes in a rack, each with the temperature of what flows through it.
//!
//! A pipe wanders on a grid along x, turns at right angles and keeps out of the cells of others.
//! What it contains cools on its way.

use std::collections::HashSet;

use cyltrace::math::Random;
use glam::{DVec3, IVec3};

use super::Table;

/// Cells of the rack.
const SIZE: IVec3 = IVec3::new(60, 16, 12);
const PIPES: usize = 90;

/// One straight piece of a pipe per row.
pub fn tables() -> Vec<Table> {
    let header = "x0,y0,z0,x1,y1,z1,radius,temperature";
    let mut table = Table::new("gallery/pipes.csv", header);
    let mut random = Random::new(45, 0);
    let mut taken = HashSet::new();
    for _ in 0..PIPES {
        let start = IVec3::new(0, random.below(16) as i32, random.below(12) as i32);
        if taken.contains(&start) {
            continue;
        }
        let nodes = route(&mut random, &mut taken, start);
        let radius = random.uniform(0.18, 0.42);
        let mut temperature = random.uniform(20.0, 180.0);
        for pair in nodes.windows(2) {
            let (from, to) = (pair[0].as_dvec3(), pair[1].as_dvec3());
            let along = (to - from).normalize();
            // The ends reach into the next piece, so that corners are closed.
            let (p0, p1) = (from - along * radius, to + along * radius);
            push(&mut table, p0, p1, radius, temperature);
            temperature = 20.0 + (temperature - 20.0) * libm::exp(-0.012 * from.distance(to));
        }
    }
    vec![table]
}

/// The corners of a pipe from a cell at the front to wherever it ends.
fn route(random: &mut Random, taken: &mut HashSet<IVec3>, start: IVec3) -> Vec<IVec3> {
    let (mut place, mut step) = (start, IVec3::X);
    let mut corners = vec![start];
    taken.insert(start);
    loop {
        let turns = random.unit() < 0.14;
        let mut choices = vec![step];
        if turns || !is_free(taken, place + step) {
            choices = vec![IVec3::X, IVec3::Y, -IVec3::Y, IVec3::Z, -IVec3::Z];
            choices.retain(|choice| *choice != -step);
            let first = random.below(choices.len() as u64) as usize;
            choices.rotate_left(first);
        }
        let Some(&chosen) = choices
            .iter()
            .find(|&&choice| is_free(taken, place + choice))
        else {
            break;
        };
        if chosen != step && place != start {
            corners.push(place);
        }
        step = chosen;
        place += step;
        taken.insert(place);
    }
    if place != start {
        corners.push(place);
    }
    corners
}

fn is_free(taken: &HashSet<IVec3>, cell: IVec3) -> bool {
    let inside = cell.cmpge(IVec3::ZERO) & cell.cmplt(SIZE);
    inside.all() && !taken.contains(&cell)
}

fn push(table: &mut Table, p0: DVec3, p1: DVec3, radius: f64, temperature: f64) {
    let ends = p0.to_array().into_iter().chain(p1.to_array());
    let mut cells: Vec<_> = ends.map(|coordinate| (coordinate, 3)).collect();
    cells.extend([(radius, 3), (temperature, 1)]);
    table.push(&cells);
}
