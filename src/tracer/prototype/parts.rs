//! Boxes whose union contains a group, for tight boxes of its placements.
//!
//! The box of a placement could be the image of the group's box. But the image of a box is
//! larger than its contents if the placement turns it: the box of a diagonal rod remains as
//! wide as the rod is long when the rod is turned to lie along an axis, and the box of a tree,
//! turned by 45 degrees, is twice as large as the box of the turned tree. Rays then enter
//! placements in vain. So the boxes of the members of a group are gathered into at most 64
//! *parts*, by the cell of a grid that contains their center, and the box of a placement is the
//! box around the images of the parts.
//!
//! A part has a center c and a half extent h, so that `|x - c| <= h` for all its points x. With
//! a row m of the placement's matrix and its translation t, the images of these points are at
//! `m·c + t ± |m|·h` along an axis, |m| the absolute values. Each of these terms takes part in
//! at most 6 roundings, so the box of all images grows by 8 u of the greatest sum of the terms'
//! sizes, and is rounded outward. So it contains the images of all members, as the image of the
//! group's box does.

use glam::{DAffine3, DVec3};
use rayon::prelude::*;

use crate::math::{Bounds, LANES, Lanes, UNIT_ROUNDOFF};

/// Cells of the grid along each axis. In the forest of `scenes/` 4 saves a sixth of all entries
/// into trees, 8 a fifth and 2 a thirtieth. 64 parts take 3 kB, less than Embree's scene.
const CELLS: usize = 4;

/// The greatest length of a list whose placements use parts. In longer lists they use the
/// images of whole boxes: 64 images take 0.25 µs, compared with 0.7 to read, measure and build
/// a placement.
const MOST_PLACEMENTS: usize = 1 << 16;

/// Boxes whose union contains a group; none for a group that is not placed.
#[derive(Default)]
pub(crate) struct Parts {
    eights: Box<[Eight]>,
    /// An upper bound of the sizes of all coordinates.
    size: DVec3,
}

/// Eight parts, by axis. The last eight repeat a part if there are fewer.
struct Eight {
    middle: [Lanes; 3],
    half: [Lanes; 3],
}

impl Parts {
    /// Gathers the boxes of members.
    pub fn new(whole: &Bounds, members: impl ParallelIterator<Item = Bounds>) -> Self {
        let rate = whole.extent().map(|extent| CELLS as f64 / extent);
        let none = || vec![Bounds::EMPTY; CELLS * CELLS * CELLS];
        let gathered = members.fold(none, |mut cells, member| {
            if !member.is_empty() {
                let cell = &mut cells[cell((member.center() - whole.lower) * rate)];
                *cell = cell.union(&member);
            }
            cells
        });
        let mut cells = gathered.reduce(none, |mut cells, others| {
            for (cell, other) in cells.iter_mut().zip(others) {
                *cell = cell.union(&other);
            }
            cells
        });
        cells.retain(|cell| !cell.is_empty());
        Self {
            eights: cells.chunks(LANES).map(Eight::new).collect(),
            size: cells.iter().fold(DVec3::ZERO, |size, cell| {
                size.max(cell.lower.abs()).max(cell.upper.abs())
            }),
        }
    }

    /// Whether placements in a list of this length use parts.
    pub fn serve(&self, placements: usize) -> bool {
        !self.eights.is_empty() && placements <= MOST_PLACEMENTS
    }

    /// A box that contains the image of every point of the parts. There is at least one part.
    pub fn image(&self, map: &DAffine3) -> Bounds {
        let mut image = Bounds::EMPTY;
        for axis in 0..3 {
            let row = map.matrix3.row(axis);
            let (mut lower, mut upper) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
            for eight in &self.eights {
                eight.reach(row, &mut lower, &mut upper);
            }
            image.lower[axis] = lower.into_iter().fold(f64::INFINITY, f64::min);
            image.upper[axis] = upper.into_iter().fold(f64::NEG_INFINITY, f64::max);
        }
        let (shift, matrix) = (map.translation, map.matrix3.abs());
        let growth = (matrix * (2.0 * self.size) + shift.abs()) * (8.0 * UNIT_ROUNDOFF);
        Bounds {
            lower: image.lower + shift - growth,
            upper: image.upper + shift + growth,
        }
        .rounded_outward()
    }
}

impl Eight {
    /// From at least one and at most eight boxes.
    fn new(boxes: &[Bounds]) -> Self {
        let lanes = |of: fn(&Bounds) -> DVec3| {
            [0, 1, 2].map(|axis| {
                let lane = |lane: usize| of(&boxes[lane.min(boxes.len() - 1)])[axis];
                Lanes(std::array::from_fn(lane))
            })
        };
        Self {
            middle: lanes(Bounds::center),
            half: lanes(|bounds| {
                let center = bounds.center();
                (bounds.upper - center).max(center - bounds.lower) * (1.0 + 2.0 * UNIT_ROUNDOFF)
            }),
        }
    }

    /// Extends the ranges of the images along an axis, without the translation.
    #[inline(always)]
    fn reach(&self, row: DVec3, lower: &mut [f64; LANES], upper: &mut [f64; LANES]) {
        let ([x, y, z], [a, b, c]) = (&self.middle, &self.half);
        let size = row.abs();
        for lane in 0..LANES {
            let middle = row.x * x.0[lane] + row.y * y.0[lane] + row.z * z.0[lane];
            let half = size.x * a.0[lane] + size.y * b.0[lane] + size.z * c.0[lane];
            // Comparisons, unlike `min` and `max`, compile to one instruction for eight lanes.
            let (least, greatest) = (middle - half, middle + half);
            lower[lane] = if least < lower[lane] {
                least
            } else {
                lower[lane]
            };
            upper[lane] = if greatest > upper[lane] {
                greatest
            } else {
                upper[lane]
            };
        }
    }
}

/// The number of the cell that contains a place, which is in sides of a cell from the grid's
/// corner.
fn cell(place: DVec3) -> usize {
    // A place outside is in the nearest cell, and NaN, from a flat grid, in the first.
    let [x, y, z] = place
        .to_array()
        .map(|along| (along as usize).min(CELLS - 1));
    (z * CELLS + y) * CELLS + x
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DMat3;

    use super::*;
    use crate::math::Random;
    use crate::scene::{
        CylinderRecord, MaterialIndex, Placement, Prototype, PrototypeIndex, Scene, SolidRecord,
        Solids,
    };
    use crate::solid::{Caps, Cylinder, Sphere};
    use crate::tracer::prototype::Outlines;

    const SEED: u64 = 20_261_129;

    fn random_map(random: &mut Random) -> DAffine3 {
        let mut turn = || {
            let x = random.direction();
            let y = x.cross(random.direction()).normalize();
            DMat3::from_cols(x, y, x.cross(y))
        };
        let (first, second) = (turn(), turn());
        let stretch = DVec3::from_array([(); 3].map(|()| random.log_uniform(0.1, 10.0)));
        let shift = random.direction() * random.log_uniform(1e-3, 1e3);
        DAffine3::from_mat3_translation(first * DMat3::from_diagonal(stretch) * second, shift)
    }

    fn is_in(bounds: &Bounds, point: DVec3) -> bool {
        bounds.lower.cmple(point).all() && point.cmple(bounds.upper).all()
    }

    fn around(boxes: &[Bounds]) -> Bounds {
        let all = boxes.iter().copied();
        all.reduce(|one, other| one.union(&other)).expect("boxes")
    }

    fn corners(bounds: &Bounds) -> impl Iterator<Item = DVec3> {
        let Bounds { lower, upper } = *bounds;
        (0..8).map(move |corner| {
            DVec3::select(
                glam::BVec3::new(corner & 1 > 0, corner & 2 > 0, corner & 4 > 0),
                lower,
                upper,
            )
        })
    }

    /// Any number of boxes, of any sizes, near or far.
    #[test]
    fn image_contains_the_images_of_all_corners() {
        let mut random = Random::new(SEED, 0);
        for case in 0..2_000 {
            let far = random.direction() * random.log_uniform(1e-6, 1e6);
            let boxes: Vec<Bounds> = (0..1 + random.below(100))
                .map(|_| {
                    let mut point = || random.direction() * random.log_uniform(1e-3, 1e3);
                    let (a, b) = (far + point(), far + point());
                    Bounds::at(a).union(&Bounds::at(b))
                })
                .collect();
            let map = random_map(&mut random);
            let whole = around(&boxes);
            let image = Parts::new(&whole, boxes.par_iter().copied()).image(&map);
            for corner in boxes.iter().flat_map(corners) {
                let moved = map.transform_point3(corner);
                assert!(is_in(&image, moved), "case {case}: {moved} in {image:?}");
            }
        }
    }

    #[test]
    fn box_of_a_turned_row_of_solids_is_a_quarter_as_wide() {
        let boxes: Vec<Bounds> = (0..100)
            .map(|along| {
                let corner = DVec3::splat(f64::from(along));
                Bounds::at(corner).union(&Bounds::at(corner + 1.0))
            })
            .collect();
        let whole = around(&boxes);
        let (x, y) = (
            DVec3::ONE.normalize(),
            DVec3::new(1.0, -1.0, 0.0).normalize(),
        );
        // Turns the row to the x axis.
        let map = DAffine3::from_mat3(DMat3::from_cols(x, y, x.cross(y)).transpose());
        let parts = Parts::new(&whole, boxes.par_iter().copied());
        let (tight, loose) = (parts.image(&map).extent(), whole.transformed(&map).extent());
        assert!(
            tight.y <= 0.26 * loose.y && tight.z <= 0.26 * loose.z,
            "{tight}, {loose}"
        );
        assert!(tight.x <= 1.0001 * 100.0 * 3_f64.sqrt(), "{tight}");
    }

    #[test]
    fn long_lists_get_whole_boxes_and_so_does_what_is_not_placed() {
        let parts = Parts::new(
            &Bounds::at(DVec3::ONE),
            rayon::iter::once(Bounds::at(DVec3::ONE)),
        );
        assert!(parts.serve(MOST_PLACEMENTS));
        assert!(!parts.serve(MOST_PLACEMENTS + 1));
        assert!(!Parts::default().serve(1));
    }

    /// A prototype of random sticks and balls.
    fn solids(random: &mut Random, placements: Vec<Placement>) -> Prototype {
        let mut point = || random.direction() * random.log_uniform(0.01, 3.0);
        let cylinders = (0..30).map(|number| {
            let cylinder = Cylinder::new(point(), point(), 0.02, Caps::Both).expect("a cylinder");
            CylinderRecord::new(&cylinder, number, MaterialIndex(0))
        });
        let cylinders: Vec<_> = cylinders.collect();
        let spheres = (30..40).map(|number| {
            let sphere = Sphere::new(point(), 0.1).expect("a sphere");
            SolidRecord::new(sphere, number, MaterialIndex(0))
        });
        Prototype {
            solids: Solids {
                cylinders: cylinders.into(),
                spheres: spheres.collect(),
                ..Solids::default()
            },
            placements,
            ..Prototype::default()
        }
    }

    /// Points on rims of all cylinders, and the poles of all spheres.
    fn surface(prototype: &Prototype) -> Vec<DVec3> {
        let rims = prototype.solids.cylinders.iter().flat_map(|record| {
            let cylinder = record.cylinder();
            let (p0, p1) = (cylinder.p0(), cylinder.p1());
            let (x, y) = (p1 - p0).normalize().any_orthonormal_pair();
            (0..32).map(move |side| {
                let angle = f64::from(side);
                let end = if side % 2 == 0 { p0 } else { p1 };
                end + (x * libm::cos(angle) + y * libm::sin(angle)) * cylinder.radius()
            })
        });
        let poles = prototype.solids.spheres.iter().flat_map(|record| {
            let sphere = &record.solid;
            DMat3::IDENTITY
                .to_cols_array_2d()
                .into_iter()
                .flat_map(|axis| {
                    let pole = DVec3::from_array(axis) * sphere.radius();
                    [sphere.center() - pole, sphere.center() + pole]
                })
        });
        rims.chain(poles).collect()
    }

    #[test]
    fn tight_boxes_contain_all_that_is_placed() {
        let mut random = Random::new(SEED, 1);
        let mut share = 0.0;
        for case in 0..50 {
            let mut placements = |of: u32| -> Vec<Placement> {
                let of = PrototypeIndex(of);
                let maps = (0..4).map(|_| random_map(&mut random));
                maps.map(|parent_from_child| Placement {
                    of,
                    parent_from_child,
                })
                .collect()
            };
            let (upper, lower) = (placements(1), placements(2));
            let root = Prototype {
                placements: upper.clone(),
                ..Prototype::default()
            };
            let middle = solids(&mut random, lower.clone());
            let innermost = solids(&mut random, Vec::new());
            let mut points = surface(&middle);
            for placement in &lower {
                let map = placement.parent_from_child;
                points.extend(
                    surface(&innermost)
                        .into_iter()
                        .map(|x| map.transform_point3(x)),
                );
            }
            let scene = Arc::new(Scene::new(vec![root, middle, innermost]));
            let order = [2, 1, 0].map(PrototypeIndex);
            let mut outlines = Outlines::new(&scene, &order);
            let (child, parent) = (outlines.take(order[1]), outlines.take(order[0]));
            let (child, placement_margin) = (&child[0], &parent[0].placement_margin);
            for placement in &upper {
                let tight = placement_margin.tight_reach(placement, &child.reach, &child.parts, 4);
                for &point in &points {
                    let moved = placement.parent_from_child.transform_point3(point);
                    assert!(is_in(&tight, moved), "case {case}: {moved} in {tight:?}");
                }
                let loose = placement_margin.placement_reach(placement, &child.reach);
                share += tight.extent().element_product() / loose.extent().element_product();
            }
        }
        let share = share / 200.0;
        assert!(share < 0.6, "tight boxes have {share} of the volume");
    }
}
