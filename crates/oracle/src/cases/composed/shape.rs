//! Solids of whole numbers.

use glam::DVec3;

use crate::cases::aiming::whole;
use cyltrace::math::{Orientation, Random};
use cyltrace::solid::{AnySolid, Caps, Cone, Cuboid, Cylinder, RoundedCone, Sphere};

/// A solid on the grid.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    Block {
        lower: DVec3,
        upper: DVec3,
    },
    /// A cone, or a cylinder where the radii are equal.
    Taper {
        ends: [DVec3; 2],
        radii: [f64; 2],
    },
    Rounded {
        ends: [DVec3; 2],
        radii: [f64; 2],
    },
    Ball {
        center: DVec3,
        radius: f64,
    },
}

fn number(random: &mut Random, low: u64, high: u64) -> f64 {
    (low + random.below(high - low + 1)) as f64
}

fn axis(random: &mut Random) -> DVec3 {
    let axis = DVec3::AXES[random.below(3) as usize];
    if random.below(2) == 0 { axis } else { -axis }
}

impl Shape {
    fn taper(p0: DVec3, along: DVec3, radii: [f64; 2]) -> Self {
        let ends = [p0, p0 + along];
        Self::Taper { ends, radii }
    }

    /// A box, or a cylinder or a cone along an axis, with coordinates up to `reach`.
    pub fn flat(random: &mut Random, reach: u64) -> Self {
        let p0 = whole(random, reach);
        match random.below(5) {
            0..=2 => {
                let size = whole(random, 1) + DVec3::splat(2.0);
                Self::Block {
                    lower: p0,
                    upper: p0 + size,
                }
            }
            other => {
                let along = axis(random) * number(random, 1, 3);
                let first = number(random, 1, 3);
                let last = if other == 3 {
                    first
                } else {
                    number(random, 0, 3)
                };
                Self::taper(p0, along, [first, last])
            }
        }
    }

    /// Any kind; some cylinders and cones have an axis (3, 4, 0) and radii of 5.
    pub fn any(random: &mut Random, reach: u64) -> Self {
        let p0 = whole(random, reach);
        match random.below(6) {
            0..=2 => Self::flat(random, reach),
            3 => Self::Ball {
                center: p0,
                radius: number(random, 1, 3),
            },
            4 => Self::rounded(random, p0),
            _ => {
                let turns = random.below(3) as usize;
                let along = [3.0, 4.0, 0.0];
                let along = DVec3::from_array([0, 1, 2].map(|i| along[(i + turns) % 3]));
                let last = 5.0 * number(random, 0, 1);
                Self::taper(p0, along, [5.0, last])
            }
        }
    }

    /// A capsule, or a rounded cone whose wall has slopes of 3, 4 and 5.
    fn rounded(random: &mut Random, p0: DVec3) -> Self {
        let (along, radii) = match random.below(4) {
            0 => (number(random, 1, 4), [number(random, 1, 2); 2]),
            1 => (5.0, [5.0, 2.0]),
            2 => (5.0, [3.0, 0.0]),
            // One ball touches the other from inside.
            _ => (1.0, [2.0, 1.0]),
        };
        let ends = [p0, p0 + axis(random) * along];
        Self::Rounded { ends, radii }
    }

    /// The solid with all lengths multiplied by a factor.
    pub fn solid(&self, scale: f64) -> AnySolid {
        const STATED: &str = "a shape of the grid is a solid";
        match *self {
            Self::Block { lower, upper } => {
                let (center, half_widths) = ((lower + upper) * 0.5, (upper - lower) * 0.5);
                Cuboid::new(center * scale, half_widths * scale, Orientation::IDENTITY)
                    .expect(STATED)
                    .into()
            }
            Self::Taper { ends, radii } => {
                let [p0, p1] = ends.map(|end| end * scale);
                let [r0, r1] = radii.map(|radius| radius * scale);
                if r0 == r1 {
                    Cylinder::new(p0, p1, r0, Caps::Both).expect(STATED).into()
                } else {
                    Cone::new(p0, p1, r0, r1, Caps::Both).expect(STATED).into()
                }
            }
            Self::Rounded { ends, radii } => {
                let [p0, p1] = ends.map(|end| end * scale);
                let [r0, r1] = radii.map(|radius| radius * scale);
                RoundedCone::new(p0, p1, r0, r1).expect(STATED).into()
            }
            Self::Ball { center, radius } => Sphere::new(center * scale, radius * scale)
                .expect(STATED)
                .into(),
        }
    }

    /// Points that are worth aiming at: corners, points of rims, apexes, centers.
    pub fn points(&self) -> Vec<DVec3> {
        match *self {
            Self::Block { lower, upper } => (0..8)
                .map(|corner| {
                    let is_upper = |axis: usize| corner >> axis & 1 == 1;
                    let pick = |i: usize| if is_upper(i) { upper[i] } else { lower[i] };
                    DVec3::from_array([0, 1, 2].map(pick))
                })
                .chain([(lower + upper) * 0.5])
                .collect(),
            Self::Taper { ends, radii } => {
                let mut points = ends.to_vec();
                for (end, radius) in ends.into_iter().zip(radii) {
                    let across = across(ends[1] - ends[0]);
                    points.extend(across.iter().map(|one| end + *one * radius));
                }
                points
            }
            Self::Rounded { ends, radii } => {
                let mut points = ends.to_vec();
                let along = (ends[1] - ends[0]).normalize().round();
                for (end, radius) in ends.into_iter().zip(radii) {
                    points.extend([end + along * radius, end - along * radius]);
                    for across in across(ends[1] - ends[0]) {
                        points.push(end + across * radius);
                        if radii == [5.0, 2.0] {
                            // On the wall, and its seam with the first ball.
                            points.push(ends[0] + along * 3.0 + across * 4.0);
                        }
                    }
                }
                points
            }
            Self::Ball { center, radius } => {
                let ends = DVec3::AXES.map(|axis| [center + axis * radius, center - axis * radius]);
                let mut points = ends.as_flattened().to_vec();
                points.push(center);
                points
            }
        }
    }
}

/// Four unit vectors across an axis of whole numbers, exact times 5.
fn across(along: DVec3) -> [DVec3; 4] {
    let zero = along.abs().min_position();
    let one = DVec3::AXES[zero];
    let other = one.cross(along);
    // Of the axis (3, 4, 0) that is as long as 5, and its tenth parts round.
    let other = other / other.length();
    [one, -one, other, -other]
}

/// Pieces of one cylinder or of one cone, side by side or overlapping.
pub(super) fn on_one_wall(random: &mut Random, count: u64) -> Vec<Shape> {
    let along = axis(random);
    let slope = [0.0, 0.0, 1.0, -1.0][random.below(4) as usize];
    let base = whole(random, 2);
    let mut shapes: Vec<Shape> = (0..count)
        .map(|_| {
            let start = number(random, 0, 3);
            let end = start + number(random, 1, 4 - start as u64);
            let radius = |height: f64| {
                if slope < 0.0 {
                    4.0 - height
                } else {
                    2.0 + slope * height
                }
            };
            let radius = |height| if slope == 0.0 { 2.0 } else { radius(height) };
            let radii = [radius(start), radius(end)];
            Shape::taper(base + along * start, along * (end - start), radii)
        })
        .collect();
    if random.below(3) == 0 {
        // A capsule with the same wall, or a box around.
        let ends = [base, base + along * 3.0];
        shapes.push(match random.below(2) {
            0 => Shape::Rounded {
                ends,
                radii: [2.0; 2],
            },
            _ => Shape::Block {
                lower: base - DVec3::splat(2.0),
                upper: base + DVec3::splat(2.0),
            },
        });
    }
    shapes
}

/// Solids that touch a cylinder, a capsule or a ball of radius 5 around an axis.
pub(super) fn tangents(random: &mut Random) -> Vec<Shape> {
    let round = |random: &mut Random, center: DVec3, radius: f64| {
        let ends = [center, center + DVec3::Z * 4.0];
        let radii = [radius; 2];
        match random.below(4) {
            0 | 1 => Shape::Taper { ends, radii },
            2 => Shape::Rounded { ends, radii },
            _ => Shape::Ball { center, radius },
        }
    };
    let first = round(random, DVec3::ZERO, 5.0);
    let count = 1 + random.below(2);
    let mut shapes = vec![first];
    for _ in 0..count {
        let way = [
            DVec3::new(1.0, 0.0, 0.0),
            DVec3::new(0.0, -1.0, 0.0),
            DVec3::new(0.6, 0.8, 0.0),
            DVec3::new(-0.8, 0.6, 0.0),
        ][random.below(4) as usize];
        // Radii of 5 and apart by 10, or 10 and 5 apart, or of 10 and 15.
        let (apart, radius) = [(10.0, 5.0), (5.0, 10.0), (15.0, 10.0)][random.below(3) as usize];
        let center = (way * apart).round() + DVec3::Z * number(random, 0, 2);
        shapes.push(match random.below(4) {
            0 => {
                let sides = [DVec3::new(5.0, -5.0, 0.0), DVec3::new(-5.0, -10.0, 0.0)];
                let lower = sides[random.below(2) as usize];
                Shape::Block {
                    lower,
                    upper: lower + DVec3::new(10.0, 10.0, 4.0),
                }
            }
            _ => round(random, center, radius),
        });
    }
    shapes
}

/// A box from -2 to 2 and what lies on its faces.
pub(super) fn on_faces(random: &mut Random) -> Vec<Shape> {
    let mut shapes = vec![Shape::Block {
        lower: DVec3::splat(-2.0),
        upper: DVec3::splat(2.0),
    }];
    for _ in 0..1 + random.below(3) {
        let normal = axis(random);
        // A point of a face, of an edge or a corner.
        let across = whole(random, 2);
        let foot = across - normal * across.dot(normal) + normal * 2.0;
        let tangent = normal.cross(axis(random));
        let radius = number(random, 1, 2);
        shapes.push(match random.below(6) {
            0 => Shape::taper(foot, normal * number(random, 1, 2), [radius; 2]),
            1 => Shape::taper(foot, -normal * 4.0, [radius; 2]),
            2 if tangent != DVec3::ZERO => Shape::taper(foot, tangent * 2.0, [radius; 2]),
            3 => Shape::taper(foot, normal * 2.0, [radius, 0.0]),
            4 => Shape::Ball {
                center: foot + normal * radius * (random.below(3) as f64 - 1.0),
                radius,
            },
            _ => {
                let size = whole(random, 1) + DVec3::splat(2.0);
                let lower = foot - size * (random.below(2) as f64);
                Shape::Block {
                    lower,
                    upper: lower + size,
                }
            }
        });
    }
    shapes
}

/// Pieces end to end on an axis, each with its bore.
pub(super) fn stack(random: &mut Random, count: u64) -> Vec<Shape> {
    let along = axis(random);
    let mut start = whole(random, 1);
    let mut shapes = Vec::new();
    for _ in 0..count {
        let length = number(random, 1, 2);
        let end = start + along * length;
        let wide = DVec3::splat(3.0) - along.abs() * 3.0;
        shapes.push(match random.below(4) {
            0 => Shape::Block {
                lower: start.min(end) - wide,
                upper: start.max(end) + wide,
            },
            1 => Shape::taper(start, along * length, [3.0, 2.0]),
            _ => Shape::taper(start, along * length, [3.0; 2]),
        });
        shapes.push(match random.below(3) {
            0 => Shape::taper(start, along * length, [2.0, 1.0]),
            _ => Shape::taper(start, along * length, [1.0; 2]),
        });
        start = end;
    }
    shapes
}

/// Cones that end in the origin, and others there.
pub(super) fn apexes(random: &mut Random, count: u64) -> Vec<Shape> {
    let cone = |random: &mut Random| {
        let along = axis(random) * 4.0;
        match random.below(4) {
            0 => Shape::Rounded {
                ends: [DVec3::ZERO, along * 1.25],
                radii: [0.0, 3.0],
            },
            _ => Shape::taper(DVec3::ZERO, along, [0.0, number(random, 1, 4)]),
        }
    };
    let mut shapes = vec![cone(random)];
    for _ in 1..count {
        shapes.push(match random.below(3) {
            0 => cone(random),
            1 => Shape::flat(random, 1),
            _ => {
                let lower = whole(random, 1) - DVec3::ONE;
                Shape::Block {
                    lower,
                    upper: lower + DVec3::splat(2.0),
                }
            }
        });
    }
    shapes
}
