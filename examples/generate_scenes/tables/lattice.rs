//! One layer of an octet truss, the stiffest lattice for its weight.
//!
//! The nodes are those of a face-centerd cubic crystal; every node is joined to
//! its twelve nearest neighbours. A round hole goes through the block, and the
//! struts are thicker near it, as a designer would have them where the load is.

use glam::{DVec2, IVec3};

use super::Table;

/// Cells along each side of the layer. Nodes lie on half cells.
const CELLS: i32 = 24;
/// The middle of the hole, in cells from the corner of the layer.
const HOLE: DVec2 = DVec2::new(12.0, 12.0);
/// Radius of the hole, in cells.
const HOLE_RADIUS: f64 = 5.2;
/// Half of the neighbours of a node, in half cells; the others are opposite.
/// The first two lie in the layer's plane.
const NEIGHBOURS: [IVec3; 6] = [
    IVec3::new(1, 1, 0),
    IVec3::new(1, -1, 0),
    IVec3::new(1, 0, 1),
    IVec3::new(-1, 0, 1),
    IVec3::new(0, 1, 1),
    IVec3::new(0, -1, 1),
];

/// A layer one cell high, and the lid that closes a stack of layers.
pub fn tables() -> Vec<Table> {
    vec![
        struts("lattice_layer.csv", 0..2, &NEIGHBOURS),
        struts("lattice_lid.csv", 0..1, &NEIGHBOURS[..2]),
    ]
}

fn struts(file: &'static str, heights: std::ops::Range<i32>, neighbours: &[IVec3]) -> Table {
    let mut table = Table::new(file, "x0,y0,z0,x1,y1,z1,radius");
    for z in heights {
        for y in 0..=2 * CELLS {
            for x in 0..=2 * CELLS {
                let from = IVec3::new(x, y, z);
                if (x + y + z) % 2 != 0 || !is_solid(from) {
                    continue;
                }
                for to in neighbours.iter().map(|step| from + step) {
                    if is_solid(to) {
                        push(&mut table, from, to);
                    }
                }
            }
        }
    }
    table
}

/// Whether there is a node: inside the block and outside the hole.
fn is_solid(node: IVec3) -> bool {
    let inside = |value: i32| (0..=2 * CELLS).contains(&value);
    inside(node.x) && inside(node.y) && from_hole(node) > 0.0
}

/// The distance from the wall of the hole, in cells.
fn from_hole(node: IVec3) -> f64 {
    let place = DVec2::new(f64::from(node.x), f64::from(node.y)) / 2.0;
    place.distance(HOLE) - HOLE_RADIUS
}

fn push(table: &mut Table, from: IVec3, to: IVec3) {
    let near = 0.5 * (from_hole(from) + from_hole(to));
    let radius = 0.035 + 0.075 * libm::exp(-near / 2.5);
    let cell = |value: i32| (f64::from(value) / 2.0, 1);
    table.push(&[
        cell(from.x),
        cell(from.y),
        cell(from.z),
        cell(to.x),
        cell(to.y),
        cell(to.z),
        (radius, 3),
    ]);
}
