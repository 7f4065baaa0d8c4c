//! A broadleaf tree of about 14 m, grown by space colonisation.
//!
//! Attraction points fill the crown; every point pulls the nearest node of the
//! skeleton, a pulled node grows a step, a point that has been reached is
//! removed (Runions, Lane, Prusinkiewicz, "Modeling trees with a space
//! colonization algorithm", 2007). Leaves are coins on the thin twigs.

use cyltrace::math::Random;
use glam::DVec3;

use super::skeleton::Skeleton;
use super::{Table, ball};

const SEED: u64 = 14;
/// The length of one growth step, in metres.
const STEP: f64 = 0.2;
/// A point counts as reached within this distance, in metres.
const REACHED: f64 = 0.38;
/// Points that pull the branches.
const ATTRACTORS: usize = 5500;
/// Radius of the thinnest twigs, in metres.
const TIP: f64 = 0.006;
/// The pull upward, against a unit pull of the points.
const TROPISM: f64 = 0.12;

/// The wood and the leaves.
pub fn tables() -> Vec<Table> {
    let mut skeleton = trunk();
    colonise(&mut skeleton, attractors());
    skeleton.smooth();
    skeleton.smooth();
    let radii = skeleton.radii(TIP);
    vec![
        skeleton.wood("broadleaf_wood.csv", &radii),
        leaves(&skeleton, &radii),
    ]
}

/// A bare trunk with a slight sway.
fn trunk() -> Skeleton {
    let mut random = Random::new(SEED, 0);
    let mut skeleton = Skeleton::new();
    let mut tip = 0;
    let mut position = DVec3::ZERO;
    while position.z < 3.4 {
        let sway = random.direction() * 0.09;
        position += (DVec3::Z + sway).normalize() * 0.3;
        tip = skeleton.grow(tip, position);
    }
    skeleton
}

/// Points in a crown of overlapping balls: the clumps give the crown its
/// uneven outline and the gaps that let light in.
fn attractors() -> Vec<DVec3> {
    let mut random = Random::new(SEED, 1);
    let center = DVec3::new(0.0, 0.0, 8.6);
    let mut clumps = vec![(center, 2.6)];
    for index in 0..17 {
        let height = (f64::from(index) + random.unit()) / 17.0 * 1.8 - 0.8;
        let across = (1.0 - height * height).max(0.0).sqrt();
        let turn = f64::from(index) * 2.4 + random.uniform(-0.5, 0.5);
        let (sin, cos) = libm::sincos(turn);
        let offset = DVec3::new(3.3 * across * cos, 3.3 * across * sin, 4.0 * height);
        clumps.push((center + offset, random.uniform(1.2, 2.0)));
    }
    (0..ATTRACTORS)
        .map(|_| {
            let (middle, radius) = clumps[random.below(clumps.len() as u64) as usize];
            middle + radius * ball(&mut random)
        })
        .collect()
}

/// Grows branches until all points are reached or pull no more.
fn colonise(skeleton: &mut Skeleton, attractors: Vec<DVec3>) {
    let mut random = Random::new(SEED, 2);
    let mut points: Vec<(DVec3, usize, f64)> = attractors
        .into_iter()
        .map(|point| (point, 0, f64::INFINITY))
        .collect();
    let mut seen = 0;
    for _ in 0..120 {
        // Only the nodes of the last round can be nearer than those before.
        for (point, nearest, distance) in &mut points {
            for (index, node) in skeleton.nodes().iter().enumerate().skip(seen) {
                let candidate = node.position.distance(*point);
                if candidate < *distance {
                    (*nearest, *distance) = (index, candidate);
                }
            }
        }
        seen = skeleton.nodes().len();
        points.retain(|&(_, _, distance)| distance > REACHED);
        let mut pull = vec![DVec3::ZERO; seen];
        for (point, nearest, distance) in &points {
            pull[*nearest] += (*point - skeleton.nodes()[*nearest].position) / *distance;
        }
        for (index, pull) in pull.into_iter().enumerate() {
            if pull == DVec3::ZERO {
                continue;
            }
            // The jitter frees a node that is pulled to two sides at once.
            let jitter = random.direction() * 0.15;
            let heading = pull.normalize() + DVec3::Z * TROPISM + jitter;
            let position = skeleton.nodes()[index].position + heading.normalize() * STEP;
            skeleton.grow(index, position);
        }
        if skeleton.nodes().len() == seen {
            break;
        }
    }
}

/// Coins of about a hand's breadth around the thin twigs, facing the sky more
/// often than not. They stand for a spray of leaves each.
fn leaves(skeleton: &Skeleton, radii: &[f64]) -> Table {
    let mut random = Random::new(SEED, 3);
    let mut table = Table::new("broadleaf_leaves.csv", "x,y,z,ax,ay,az,length,radius");
    for (index, node) in skeleton.nodes().iter().enumerate() {
        if radii[index] > 2.5 * TIP {
            continue;
        }
        for _ in 0..if radii[index] > 1.01 * TIP { 3 } else { 5 } {
            let position = node.position + ball(&mut random) * 0.3;
            let facing = (random.direction() + DVec3::Z * 0.7).normalize() * 9.0;
            let axis = DVec3::new(facing.x.round(), facing.y.round(), facing.z.round());
            let radius = random.uniform(0.06, 0.11);
            table.push(&[
                (position.x, 2),
                (position.y, 2),
                (position.z, 2),
                (axis.x, 0),
                (axis.y, 0),
                (axis.z, 0),
                (0.01, 2),
                (radius, 2),
            ]);
        }
    }
    table
}
