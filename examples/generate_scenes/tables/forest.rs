//! Where the ten thousand trees stand, and the land under them.
//!
//! The land is made of cylinders too: a disk for the plain, and cylinders that
//! lie half sunk in it for the hills. Trees keep a distance from each other,
//! leave a glade free in front of the camera, and sort themselves into groves
//! of one kind.

use cyltrace::math::Random;
use glam::{DVec2, DVec3};

use super::Table;

const SEED: u64 = 2;
/// All trees together.
const TREES: usize = 10_000;
/// Trees stand up to this far from the camera, in metres.
const DEPTH: f64 = 640.0;
/// The hills: a point of the axis, where it leads, its height, the radius.
const HILLS: [Hill; 3] = [
    Hill::new(DVec2::new(0.0, 600.0), DVec2::new(1.0, 0.25), 92.0, 900.0),
    Hill::new(DVec2::new(-330.0, 330.0), DVec2::new(0.8, 1.0), 48.0, 500.0),
    Hill::new(DVec2::new(250.0, 260.0), DVec2::new(-0.5, 1.0), 24.0, 400.0),
];
/// Trees that frame the picture.
const FRAME: [(DVec2, f64, Kind); 7] = [
    (DVec2::new(-17.0, 30.0), 1.25, Kind::Green),
    (DVec2::new(19.0, 27.0), 1.1, Kind::Conifer),
    (DVec2::new(25.5, 33.0), 0.85, Kind::Conifer),
    (DVec2::new(16.0, 42.0), 0.6, Kind::Conifer),
    (DVec2::new(-9.0, 62.0), 0.9, Kind::Yellow),
    (DVec2::new(-30.0, 42.0), 1.0, Kind::Conifer),
    (DVec2::new(11.0, 84.0), 1.0, Kind::Green),
];

/// Which prototype a tree is. The broadleaf ones differ in their leaves'
/// colour only.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Conifer,
    Green,
    Yellow,
    Red,
}

impl Kind {
    const ALL: [(Self, &'static str); 4] = [
        (Self::Conifer, "forest_conifer.csv"),
        (Self::Green, "forest_green.csv"),
        (Self::Yellow, "forest_yellow.csv"),
        (Self::Red, "forest_red.csv"),
    ];
}

/// A cylinder of which only the uppermost part looks out of the plain.
struct Hill {
    middle: DVec2,
    along: DVec2,
    height: f64,
    radius: f64,
}

impl Hill {
    const fn new(middle: DVec2, along: DVec2, height: f64, radius: f64) -> Self {
        Self {
            middle,
            along,
            height,
            radius,
        }
    }

    fn top(&self, place: DVec2) -> f64 {
        let across = self.along.normalize().perp_dot(place - self.middle);
        let sunk = self.height - self.radius;
        sunk + (self.radius * self.radius - across * across)
            .max(0.0)
            .sqrt()
    }
}

/// The height of the land.
fn height(place: DVec2) -> f64 {
    HILLS.iter().map(|hill| hill.top(place)).fold(0.0, f64::max)
}

/// The land, and the placements of each kind of tree.
pub fn tables() -> Vec<Table> {
    let trees = trees();
    let mut tables = vec![land()];
    tables.extend(Kind::ALL.map(|(kind, file)| placements(file, kind, &trees)));
    tables
}

/// The trees of one kind, each turned by chance.
fn placements(file: &'static str, kind: Kind, trees: &[(DVec2, f64, Kind)]) -> Table {
    let mut table = Table::new(file, "x,y,z,ax,ay,az,angle,scale");
    let mut random = Random::new(SEED, 2 + kind as u64);
    // Turning about a leaning axis turns the tree and leans it a little.
    let lean = if kind == Kind::Conifer { 0.01 } else { 0.04 };
    for (place, scale, _) in trees.iter().filter(|tree| tree.2 == kind) {
        table.push(&[
            (place.x, 2),
            (place.y, 2),
            (height(*place) - 0.05, 2),
            (random.uniform(-lean, lean), 3),
            (random.uniform(-lean, lean), 3),
            (1.0, 0),
            (random.uniform(0.0, 360.0), 0),
            (*scale, 2),
        ]);
    }
    table
}

/// The plain and the hills.
fn land() -> Table {
    let mut table = Table::new("forest_land.csv", "x0,y0,z0,x1,y1,z1,radius");
    let mut push = |p0: DVec3, p1: DVec3, radius: f64| {
        table.push(&[
            (p0.x, 2),
            (p0.y, 2),
            (p0.z, 2),
            (p1.x, 2),
            (p1.y, 2),
            (p1.z, 2),
            (radius, 2),
        ]);
    };
    push(DVec3::NEG_Z, DVec3::ZERO, 20_000.0);
    for hill in &HILLS {
        let reach = hill.along.normalize() * 3000.0;
        let sunk = hill.height - hill.radius;
        let p0 = (hill.middle - reach).extend(sunk);
        let p1 = (hill.middle + reach).extend(sunk);
        push(p0, p1, hill.radius);
    }
    table
}

/// Place, scale and kind of every tree, the framing ones first.
fn trees() -> Vec<(DVec2, f64, Kind)> {
    let mut random = Random::new(SEED, 1);
    let mut trees = FRAME.to_vec();
    while trees.len() < TREES {
        // The wedge of land that the camera sees, and a margin for shadows.
        let depth = DEPTH * random.unit().sqrt();
        let place = DVec2::new(random.uniform(-1.0, 1.0) * (0.72 * depth + 45.0), depth);
        let kind = kind(place, &mut random);
        let scale = random.uniform(0.7, 1.2);
        let room = scale * if kind == Kind::Conifer { 3.5 } else { 4.7 };
        if in_glade(place) {
            continue;
        }
        let crowded = trees
            .iter()
            .any(|(other, ..)| other.distance_squared(place) < room * room);
        if !crowded {
            trees.push((place, scale, kind));
        }
    }
    trees
}

/// The kind that grows at a place: conifers in groves and on the hills, and
/// autumn in patches.
fn kind(place: DVec2, random: &mut Random) -> Kind {
    let autumn = libm::sin(place.x * 0.05 + 1.0) + libm::sin(place.y * 0.041 - 0.5);
    let colour = random.unit() + 0.16 * autumn;
    if grove(place) + random.uniform(-0.3, 0.3) > 0.0 {
        Kind::Conifer
    } else if colour > 0.97 {
        Kind::Red
    } else if colour > 0.66 {
        Kind::Yellow
    } else {
        Kind::Green
    }
}

/// Positive where conifers prevail: a few waves, and the higher ground.
fn grove(place: DVec2) -> f64 {
    let wave = |x: f64, y: f64, phase: f64| libm::sin(place.x * x + place.y * y + phase);
    let waves = wave(0.021, 0.034, 0.4) + wave(-0.045, 0.019, 2.0) + wave(0.09, 0.075, 1.0);
    waves / 3.0 + height(place) / 110.0 - 0.38
}

/// The glade: a meadow that winds into the forest and narrows.
fn in_glade(place: DVec2) -> bool {
    let end = 165.0;
    if place.y > end {
        return false;
    }
    let middle = 13.0 * libm::sin(place.y / 34.0) - 2.0;
    let half_width = 24.0 * (1.0 - place.y / end).sqrt();
    (place.x - middle).abs() < half_width || place.y < 22.0
}
