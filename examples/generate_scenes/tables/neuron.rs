//! A neuron that grew by rule: a body, dendrites that wander and fork, and a long axon.
//!
//! Lengths are micrometers. Branches are thinner after a fork by Rall's rule, under which the
//! sum of the radii to the power 3/2 stays the same.

use cyltrace::math::Random;
use glam::DVec3;

use super::{Table, rounded};

const SOMA: f64 = 9.0;
/// The length of a segment.
const STEP: f64 = 5.0;
/// Thinner branches end.
const LEAST_RADIUS: f64 = 0.16;

/// The types of SWC.
const AXON: u32 = 2;
const BASAL: u32 = 3;
const APICAL: u32 = 4;

/// The neuron as a file in SWC.
pub fn tables() -> Vec<Table> {
    let mut neuron = Neuron {
        table: Table::new(
            "gallery/neuron.swc",
            "# id type x y z radius parent, in micrometers",
        ),
        random: Random::new(44, 0),
    };
    let soma = neuron.push(1, DVec3::ZERO, SOMA, None);
    let mut grow = |kind, towards: DVec3, radius, reach, forks| {
        let direction = towards.normalize();
        let stem = Stem {
            kind,
            pull: direction,
            reach,
            forks,
        };
        let tip = Tip {
            point: direction * SOMA,
            direction,
            radius,
            length: 0.0,
            parent: soma,
        };
        neuron.grow(&stem, tip);
    };
    grow(APICAL, DVec3::new(0.1, 0.05, 1.0), 2.6, 430.0, 0.045);
    for number in 0..6 {
        let (sine, cosine) = libm::sincos(f64::from(number) * 1.05 + 0.3);
        let towards = DVec3::new(cosine, sine, -0.35);
        grow(BASAL, towards, 1.5, 170.0, 0.075);
    }
    grow(AXON, DVec3::new(-0.2, 0.1, -1.0), 0.9, 420.0, 0.03);
    vec![neuron.table]
}

struct Neuron {
    table: Table,
    random: Random,
}

/// What the branches from one root have in common.
struct Stem {
    kind: u32,
    /// The direction in which they tend to grow.
    pull: DVec3,
    /// The greatest length from the body.
    reach: f64,
    /// The probability of a fork at each step.
    forks: f64,
}

/// The end of a growing branch.
struct Tip {
    point: DVec3,
    direction: DVec3,
    radius: f64,
    /// From the body.
    length: f64,
    parent: usize,
}

impl Neuron {
    fn grow(&mut self, stem: &Stem, mut tip: Tip) {
        while tip.length < stem.reach && tip.radius > LEAST_RADIUS {
            let wander = self.random.direction() * 0.32;
            tip.direction = (tip.direction + wander + stem.pull * 0.03).normalize();
            tip.point += tip.direction * STEP;
            tip.length += STEP;
            tip.radius *= 0.994;
            tip.parent = self.push(stem.kind, tip.point, tip.radius, Some(tip.parent));
            if self.random.unit() < stem.forks {
                let share = self.random.uniform(0.3, 0.7);
                let side = tip.direction.cross(self.random.direction()).normalize();
                let child = Tip {
                    direction: (tip.direction + side * 0.8).normalize(),
                    radius: tip.radius * libm::pow(share, 2.0 / 3.0),
                    ..tip
                };
                tip.direction = (tip.direction - side * 0.5).normalize();
                tip.radius *= libm::pow(1.0 - share, 2.0 / 3.0);
                self.grow(stem, child);
            }
        }
    }

    /// Adds a sample and returns its number.
    fn push(&mut self, kind: u32, point: DVec3, radius: f64, parent: Option<usize>) -> usize {
        let number = self.table.rows + 1;
        let parent = parent.map_or("-1".to_owned(), |parent| parent.to_string());
        let [x, y, z] = point.to_array().map(|coordinate| rounded(coordinate, 2));
        let radius = rounded(radius, 3);
        self.table.text += &format!("{number} {kind} {x} {y} {z} {radius} {parent}\n");
        self.table.rows = number;
        number
    }
}
