//! Rays and points on the grid: through corners and rims, along edges and rulings, in
//! the planes of faces.

use glam::DVec3;

use crate::cases::aiming::whole;
use cyltrace::math::{Random, Ray};

use super::shape::Shape;

/// A ray, before it is scaled; a special one goes through points of the shapes.
pub(super) fn draw(random: &mut Random, shapes: &[Shape], is_special: bool) -> Ray {
    let through = special(random, shapes);
    let direction = loop {
        let direction = match random.below(5) {
            _ if !is_special => whole(random, 9),
            0 | 1 => special(random, shapes) - through,
            2 => DVec3::AXES[random.below(3) as usize],
            3 => whole(random, 1),
            _ => whole(random, 3),
        };
        if direction != DVec3::ZERO {
            break direction;
        }
    };
    let through = match (is_special, random.below(3)) {
        (false, _) => through + whole(random, 2) * 0.25,
        (_, 0) => (through + special(random, shapes)) * 0.5,
        _ => through,
    };
    let before = match random.below(8) {
        0 => 0.0,
        1 => 0.5,
        2 => 1.0,
        3 => -0.25,
        other => 4.0 * other as f64,
    };
    let ray = Ray::new(through - direction * before, direction);
    match random.below(8) {
        0 => Ray {
            t_min: f64::NEG_INFINITY,
            ..ray
        },
        _ => ray,
    }
}

/// A point of a shape, half-way between two, or one of the grid.
pub(super) fn point(random: &mut Random, shapes: &[Shape]) -> DVec3 {
    let one = special(random, shapes);
    match random.below(4) {
        0 => one,
        1 => (one + special(random, shapes)) * 0.5,
        2 => one + whole(random, 1) * 0.25,
        _ => whole(random, 6) * 0.5,
    }
}

fn special(random: &mut Random, shapes: &[Shape]) -> DVec3 {
    let points = shapes[random.below(shapes.len() as u64) as usize].points();
    points[random.below(points.len() as u64) as usize]
}
