//! A spruce of about 18 m, grown by rule: a straight trunk, whorls of branches
//! that droop and turn up at their ends, flat sprays of branchlets, and shoots
//! with needles, each shoot one thick green cylinder.

use cyltrace::math::Random;
use glam::DVec3;

use super::Table;
use super::skeleton::Skeleton;

const SEED: u64 = 18;
/// Height of the trunk, in metres.
const HEIGHT: f64 = 18.0;
/// Distance between whorls, and so between trunk nodes, in metres.
const WHORL: f64 = 0.36;
/// Height of the lowest green whorl, in metres.
const LOWEST: f64 = 1.6;
/// Length of the longest branch, in metres.
const LONGEST: f64 = 3.1;
/// Radius of the thinnest twigs, in metres.
const TIP: f64 = 0.0045;

/// Cylinders of the spruce that the largest scene places a million times.
const ROUND_NUMBER: usize = 10_000;

/// The wood and the needles, and as many of the needles as make a round number
/// with the wood.
pub fn tables() -> Vec<Table> {
    let mut skeleton = Skeleton::new();
    let mut needles = Table::new("conifer_needles.csv", "x0,y0,z0,x1,y1,z1,radius");
    let mut random = Random::new(SEED, 0);
    let mut tip = 0;
    let mut whorl = 0_u64;
    while skeleton.nodes()[tip].position.z + WHORL < HEIGHT {
        let sway = DVec3::new(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.0) * 0.012;
        let next = skeleton.nodes()[tip].position + (DVec3::Z + sway) * WHORL;
        tip = skeleton.grow(tip, next);
        whorl += 1;
        if next.z > LOWEST {
            branches(&mut skeleton, &mut needles, tip, whorl);
        }
    }
    let top = skeleton.nodes()[tip].position;
    shoot(&mut needles, top, top + DVec3::Z * 0.45, 0.02);
    let radii = skeleton.radii(TIP);
    let wood = skeleton.wood("conifer_wood.csv", &radii);
    let fewer = thinned("conifer_thinned.csv", &needles, ROUND_NUMBER - wood.rows);
    vec![wood, needles, fewer]
}

/// `rows` rows of a table, evenly spread over it.
fn thinned(file: &'static str, table: &Table, rows: usize) -> Table {
    let mut lines = table.text.lines();
    let mut thinned = Table::new(file, lines.next().unwrap_or_default());
    for (index, line) in lines.enumerate() {
        let kept_before = |index: usize| index * rows / table.rows;
        if kept_before(index + 1) > kept_before(index) {
            thinned.text += line;
            thinned.text.push('\n');
            thinned.rows += 1;
        }
    }
    thinned
}

/// One whorl: longer branches below, and steeper ones above.
fn branches(skeleton: &mut Skeleton, needles: &mut Table, trunk: usize, whorl: u64) {
    let mut random = Random::new(SEED, whorl);
    let height = skeleton.nodes()[trunk].position.z;
    let up = (height - LOWEST) / (HEIGHT - LOWEST);
    let count = 5 + random.below(2);
    let start = random.uniform(0.0, std::f64::consts::TAU);
    for branch in 0..count {
        let share = (branch as f64 + random.uniform(-0.25, 0.25)) / count as f64;
        let (sin, cos) = libm::sincos(start + share * std::f64::consts::TAU);
        let outward = DVec3::new(cos, sin, 0.0);
        // The lowest branches are shaded and stay behind.
        let shade = 0.75 + 0.25 * (up / 0.15).min(1.0);
        let length = (0.12 + LONGEST * (1.0 - up)) * shade * random.uniform(0.75, 1.1);
        let rise = -0.35 + 1.0 * up + random.uniform(-0.1, 0.1);
        limb(skeleton, needles, trunk, outward, rise, length, &mut random);
    }
}

/// A branch in steps of a fifth of a metre: it leaves the trunk with the slope
/// `rise`, sags under its weight and turns up again at its end.
fn limb(
    skeleton: &mut Skeleton,
    needles: &mut Table,
    trunk: usize,
    outward: DVec3,
    rise: f64,
    length: f64,
    random: &mut Random,
) {
    let steps = (length / 0.26).ceil().max(2.0);
    let sideways = DVec3::Z.cross(outward);
    let mut tip = trunk;
    let mut swerve = 0.0;
    for step in 1..=steps as u32 {
        let along = f64::from(step) / steps;
        swerve += random.uniform(-0.06, 0.06);
        let slope = rise - 0.35 * along + 0.75 * along * along * along;
        let heading = (outward + sideways * swerve + DVec3::Z * slope).normalize();
        let foot = skeleton.nodes()[tip].position;
        let position = foot + heading * (length / steps);
        tip = skeleton.grow(tip, position);
        if along > 0.9 {
            shoot(needles, foot, position + heading * 0.12, 0.022);
        } else if along > 0.35 {
            shoot(needles, foot, position, 0.024);
        }
        if step == 1 && length > 1.0 {
            continue;
        }
        for side in [-1.0, 1.0] {
            let reach = (0.10 + 0.42 * (1.0 - along) * length.sqrt()) * random.uniform(0.7, 1.2);
            let spread = heading * 0.75 + sideways * side - DVec3::Z * random.uniform(0.05, 0.45);
            spray(
                needles,
                position,
                spread.normalize(),
                heading,
                reach,
                random,
            );
        }
    }
}

/// A branchlet with its side shoots.
fn spray(
    needles: &mut Table,
    foot: DVec3,
    along: DVec3,
    forward: DVec3,
    reach: f64,
    random: &mut Random,
) {
    shoot(needles, foot, foot + along * reach, 0.020);
    let pairs = (reach / 0.16) as u32;
    for pair in 0..pairs {
        let from = foot + along * reach * (f64::from(pair) + 0.6) / f64::from(pairs + 1);
        let droop = DVec3::Z * random.uniform(0.0, 0.5);
        let inner = (along * 0.5 + forward - droop).normalize();
        let outer = (along * 1.2 - forward * 0.6 - droop).normalize();
        let length = reach * random.uniform(0.35, 0.55);
        shoot(needles, from, from + inner * length, 0.017);
        if pair % 2 == 0 {
            shoot(needles, from, from + outer * length, 0.017);
        }
    }
}

/// A twig with its needles.
fn shoot(needles: &mut Table, p0: DVec3, p1: DVec3, radius: f64) {
    needles.push(&[
        (p0.x, 2),
        (p0.y, 2),
        (p0.z, 2),
        (p1.x, 2),
        (p1.y, 2),
        (p1.z, 2),
        (radius, 3),
    ]);
}
