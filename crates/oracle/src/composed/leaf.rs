//! The operands of a composition: which sheets bound each, and what is inside.

use std::cmp::Ordering;

use glam::DVec3;

use crate::number::{ExactVector, exact, sign};
use cyltrace::solid::{AnySolid, Part};

use super::sheet::Sheet;

/// An operand: a closed solid with an inside.
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    pub sheets: Vec<Sheet>,
    inside: Inside,
}

/// What is inside, by the signs of the sheets.
#[derive(Clone, Copy, Debug)]
enum Inside {
    /// Within all sheets.
    All,
    /// Within the first or the second sheet, or within all others, if there are any.
    Either,
}

impl Leaf {
    /// # Panics
    /// When the solid is a disk, which has no inside.
    pub fn new(solid: &AnySolid) -> Self {
        let all = |sheets| Self {
            sheets,
            inside: Inside::All,
        };
        match solid {
            AnySolid::Cylinder(cylinder) => {
                let ends = [cylinder.p0(), cylinder.p1()];
                all(between_disks(ends, [cylinder.radius(); 2]))
            }
            AnySolid::Cone(cone) => {
                let ends = [cone.p0(), cone.p1()];
                all(between_disks(ends, [cone.radius0(), cone.radius1()]))
            }
            AnySolid::Sphere(sphere) => all(vec![Sheet::sphere(
                &ExactVector::new(sphere.center()),
                &exact(sphere.radius()),
                Part::Side,
            )]),
            AnySolid::Cuboid(cuboid) => {
                let center = ExactVector::new(cuboid.center());
                let axes = cuboid.orientation().world_from_object();
                let parts = [
                    [Part::XMin, Part::XMax],
                    [Part::YMin, Part::YMax],
                    [Part::ZMin, Part::ZMax],
                ];
                let mut sheets = Vec::new();
                for (axis, parts) in parts.into_iter().enumerate() {
                    let half_width = exact(cuboid.half_widths()[axis]);
                    for (part, side) in parts.into_iter().zip([-1.0, 1.0]) {
                        let normal = ExactVector::new(axes.col(axis) * side);
                        let offset = normal.dot(&center) + &half_width;
                        sheets.push(Sheet::plane(&normal, &offset, Some(part)));
                    }
                }
                all(sheets)
            }
            AnySolid::RoundedCone(cone) => {
                let [p0, p1] = [cone.p0(), cone.p1()].map(ExactVector::new);
                let [r0, r1] = [cone.radius0(), cone.radius1()].map(exact);
                let (a, delta) = (&p1 - &p0, &r1 - &r0);
                let beta = a.dot(&a) - &delta * &delta;
                let mut sheets = vec![
                    Sheet::sphere(&p0, &r0, Part::Cap0),
                    Sheet::sphere(&p1, &r1, Part::Cap1),
                ];
                if sign(&beta) == Ordering::Greater {
                    // 0 <= a·q + r0 Δ <= β
                    let seam = a.dot(&p0) - &r0 * &delta;
                    sheets.push(Sheet::plane(&a.times(&exact(-1.0)), &-&seam, None));
                    sheets.push(Sheet::plane(&a, &(seam + &beta), None));
                    sheets.push(Sheet::wall(&p0, &a, [&r0, &delta, &beta]));
                }
                Self {
                    sheets,
                    inside: Inside::Either,
                }
            }
            AnySolid::Disk(_) => panic!("a disk has no inside and composes nothing"),
        }
    }

    /// Whether points with these signs are inside. `None` where a zero decides.
    pub fn decide(&self, signs: &[Ordering]) -> Option<bool> {
        let within_all = |signs: &[Ordering]| {
            if signs.contains(&Ordering::Greater) {
                Some(false)
            } else if signs.contains(&Ordering::Equal) {
                None
            } else {
                Some(true)
            }
        };
        match self.inside {
            Inside::All => within_all(signs),
            Inside::Either => {
                let (balls, hull) = signs.split_at(2);
                if balls.contains(&Ordering::Less) {
                    return Some(true);
                }
                let hull = if hull.is_empty() {
                    Some(false)
                } else {
                    within_all(hull)
                };
                match hull {
                    Some(false) if balls.contains(&Ordering::Equal) => None,
                    other => other,
                }
            }
        }
    }
}

fn between_disks(ends: [DVec3; 2], radii: [f64; 2]) -> Vec<Sheet> {
    let [p0, p1] = ends.map(ExactVector::new);
    let [r0, r1] = radii.map(exact);
    let (a, delta) = (&p1 - &p0, &r1 - &r0);
    let wall = Sheet::wall(&p0, &a, [&r0, &delta, &a.dot(&a)]);
    let back = a.times(&exact(-1.0));
    vec![
        wall,
        Sheet::plane(&back, &back.dot(&p0), Some(Part::Cap0)),
        Sheet::plane(&a, &a.dot(&p1), Some(Part::Cap1)),
    ]
}
