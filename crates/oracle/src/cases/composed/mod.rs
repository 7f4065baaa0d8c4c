//! Set operations of solids that touch, share faces and coincide, and rays within
//! their faces, along their edges and through their corners.
//!
//! Solids are stated on a grid of whole numbers (`shape.rs`), a ray goes through points
//! that several of them have in common (`aim.rs`), and then everything is multiplied by
//! one factor: a number of few bits for f32 inputs, one of 25 bits for f64. All
//! products are exact, so what touches on the grid touches in the case, to the last bit.

mod aim;
mod shape;
mod trees;

use std::fmt::Debug;
use std::str::FromStr;

use glam::DVec3;

use super::{Inputs, UnknownFamily, family_named, with_hyphens};
use cyltrace::math::{Random, Ray, power_of_two};
use cyltrace::solid::Composition;
use shape::Shape;

/// A composition, a ray and points.
#[derive(Clone, Debug, PartialEq)]
pub struct ComposedCase {
    /// The set operations.
    pub composition: Composition,
    /// The ray.
    pub ray: Ray,
    /// Points to locate.
    pub points: [DVec3; 4],
}

/// A family of set operations that are hard in one way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ComposedFamily {
    /// Boxes, cylinders and cones with faces in the same planes.
    CoplanarFaces,
    /// Cylinders on one axis with one radius, and pieces of one cone.
    SharedWalls,
    /// Cylinders, balls and capsules that touch each other or a face, from either side.
    TangentWalls,
    /// Edges, rims, corners and axes in the faces of a box.
    EdgesOnFaces,
    /// Trees in which the same solids occur again.
    CoincidentOperands,
    /// Solids end to end on an axis, with bores of the same lengths.
    Stacks,
    /// Trees of depth 6.
    Nested,
    /// Cones and rounded cones whose apex is on others, or the apex of others.
    Apexes,
    /// Solids of all kinds and rays in no special position.
    Mixed,
}

impl ComposedFamily {
    /// All families, in the order of tables.
    pub const ALL: [Self; 9] = [
        Self::CoplanarFaces,
        Self::SharedWalls,
        Self::TangentWalls,
        Self::EdgesOnFaces,
        Self::CoincidentOperands,
        Self::Stacks,
        Self::Nested,
        Self::Apexes,
        Self::Mixed,
    ];

    /// The name on the command line and in tables.
    #[must_use]
    pub fn name(self) -> String {
        format!("composed{}", with_hyphens(&format!("{self:?}")))
    }

    /// Case `index`, below 2^32, of the family; the same for the same arguments.
    #[must_use]
    pub fn case(self, seed: u64, index: u64, inputs: Inputs) -> ComposedCase {
        let stream = (0xC0DE << 48) | ((self as u64) << 40) | ((inputs as u64) << 39) | index;
        let mut random = Random::new(seed, stream);
        let shapes = self.shapes(&mut random);
        let scale = scale(&mut random, inputs);
        let solids: Vec<_> = shapes.iter().map(|shape| shape.solid(scale)).collect();
        let composition = trees::draw(self, &mut random, &solids);
        let is_special = self != Self::Mixed && random.below(16) > 0;
        let aim = aim::draw(&mut random, &shapes, is_special);
        ComposedCase {
            composition,
            ray: Ray {
                origin: aim.origin * scale,
                ..aim
            },
            points: [(); 4].map(|()| aim::point(&mut random, &shapes) * scale),
        }
    }

    fn shapes(self, random: &mut Random) -> Vec<Shape> {
        let count = 2 + random.below(3);
        let several = |random: &mut Random, draw: &dyn Fn(&mut Random) -> Shape| {
            (0..count).map(|_| draw(random)).collect()
        };
        match self {
            Self::CoplanarFaces => several(random, &|random| Shape::flat(random, 2)),
            Self::SharedWalls => shape::on_one_wall(random, count),
            Self::TangentWalls => shape::tangents(random),
            Self::EdgesOnFaces => shape::on_faces(random),
            Self::CoincidentOperands => several(random, &|random| Shape::any(random, 3)),
            Self::Stacks => shape::stack(random, count),
            Self::Nested => several(random, &|random| Shape::any(random, 2)),
            Self::Apexes => shape::apexes(random, count),
            Self::Mixed => several(random, &|random| Shape::any(random, 7)),
        }
    }
}

/// What all lengths are multiplied by.
fn scale(random: &mut Random, inputs: Inputs) -> f64 {
    match inputs {
        Inputs::F32 => {
            let factor = [1.0, 1.0, 1.0, 3.0, 7.0, 85.0][random.below(6) as usize];
            factor * power_of_two(random.below(9) as i32 - 4)
        }
        Inputs::F64 => {
            let factor = (1_u64 << 24) | random.below(1 << 24) | 1;
            factor as f64 * power_of_two(random.below(9) as i32 - 28)
        }
    }
}

impl FromStr for ComposedFamily {
    type Err = UnknownFamily;

    fn from_str(name: &str) -> Result<Self, UnknownFamily> {
        family_named(name, Self::ALL, Self::name)
    }
}
