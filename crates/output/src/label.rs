//! Where the names in a figure go, so that none covers another.
//!
//! Names are placed one after the other. Each tries places around its mark,
//! near ones first, and takes the one that covers least: a name, a mark or the
//! edge counts much, a line little, distance least. That is a greedy form of
//! point-feature labelling (Christensen, Marks, Shieber, "An empirical study of
//! algorithms for point-feature label placement", 1995); for some thirty names
//! it finds places without any overlap, and `placed_names_never_touch` checks.

/// A rectangle in pixels, y downward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Rectangle {
    /// The square around a point.
    pub fn around(x: f64, y: f64, half: f64) -> Self {
        Self {
            left: x - half,
            top: y - half,
            right: x + half,
            bottom: y + half,
        }
    }

    /// The area that both cover.
    pub fn overlap(&self, other: &Self) -> f64 {
        let width = self.right.min(other.right) - self.left.max(other.left);
        let height = self.bottom.min(other.bottom) - self.top.max(other.top);
        width.max(0.0) * height.max(0.0)
    }

    fn area(&self) -> f64 {
        (self.right - self.left) * (self.bottom - self.top)
    }
}

/// What names should keep off.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// The plot; names stay within.
    pub frame: Rectangle,
    /// Marks, which names must not cover.
    pub marks: Vec<Rectangle>,
    /// Thin lines, which they had better not cross.
    pub lines: Vec<Rectangle>,
}

/// Pixels between a mark's middle and the nearest place of its name.
const NEAREST: f64 = 9.0;
/// Pixels from one ring of places to the next, and how many there are.
const RING: f64 = 9.0;
const RINGS: u32 = 14;
/// Places a ring.
const DIRECTIONS: u32 = 16;
/// What a pixel of distance, a covered pixel of a line, and one of a name or a
/// mark cost: two rings farther is better than a line crossed, and anything
/// is better than a mark or a name covered.
const DISTANCE_COST: f64 = 1.0;
const LINE_COST: f64 = 0.6;
const COVER_COST: f64 = 100.0;

/// A place for the name of `size` (width, height) of each mark (x, y).
pub fn place(marks: &[(f64, f64)], sizes: &[(f64, f64)], around: &Surroundings) -> Vec<Rectangle> {
    let mut placed: Vec<Rectangle> = Vec::new();
    for (&mark, &size) in marks.iter().zip(sizes) {
        let cost = |(distance, place): &(f64, Rectangle)| {
            let covered = |others: &[Rectangle]| -> f64 {
                others.iter().map(|other| place.overlap(other)).sum()
            };
            let outside = place.area() - place.overlap(&around.frame);
            let hard = covered(&placed) + covered(&around.marks) + outside;
            DISTANCE_COST * distance + LINE_COST * covered(&around.lines) + COVER_COST * hard
        };
        let best = places(mark, size)
            .min_by(|a, b| cost(a).total_cmp(&cost(b)))
            .expect("there are places around every mark");
        placed.push(best.1);
    }
    placed
}

/// The places for a name, with their distance from the mark. The name's
/// nearest side or corner lies on the ring.
fn places(
    (x, y): (f64, f64),
    (width, height): (f64, f64),
) -> impl Iterator<Item = (f64, Rectangle)> {
    (0..RINGS).flat_map(move |ring| {
        let distance = NEAREST + RING * f64::from(ring);
        (0..DIRECTIONS).map(move |direction| {
            let angle = std::f64::consts::TAU * f64::from(direction) / f64::from(DIRECTIONS);
            let (sin, cos) = libm::sincos(angle);
            let center_x = x + cos * (distance + 0.5 * width);
            let center_y = y + sin * (distance + 0.5 * height);
            let place = Rectangle {
                left: center_x - 0.5 * width,
                top: center_y - 0.5 * height,
                right: center_x + 0.5 * width,
                bottom: center_y + 0.5 * height,
            };
            (distance - NEAREST, place)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::math::Random;

    #[test]
    fn placed_names_never_touch() {
        const SEED: u64 = 12;
        for stream in 0..20 {
            let mut random = Random::new(SEED, stream);
            // Thirty marks, two thirds of them in two tight clusters.
            let marks: Vec<(f64, f64)> = (0..30)
                .map(|index| match index % 3 {
                    0 => (random.uniform(0.0, 800.0), random.uniform(0.0, 500.0)),
                    side => (
                        200.0 * f64::from(side) + random.uniform(0.0, 60.0),
                        250.0 + random.uniform(0.0, 60.0),
                    ),
                })
                .collect();
            let sizes: Vec<(f64, f64)> = marks
                .iter()
                .map(|_| (random.uniform(30.0, 110.0), 13.0))
                .collect();
            let around = Surroundings {
                frame: Rectangle {
                    left: -10.0,
                    top: -10.0,
                    right: 810.0,
                    bottom: 510.0,
                },
                marks: marks
                    .iter()
                    .map(|&(x, y)| Rectangle::around(x, y, 4.0))
                    .collect(),
                lines: Vec::new(),
            };
            let placed = place(&marks, &sizes, &around);
            for (index, one) in placed.iter().enumerate() {
                let others = placed[..index].iter().chain(&around.marks);
                let covered: f64 = others.map(|other| one.overlap(other)).sum();
                assert_eq!(covered, 0.0, "seed {SEED}, stream {stream}, name {index}");
                let inside = one.overlap(&around.frame) / one.area();
                assert!(
                    inside > 1.0 - 1e-9,
                    "seed {SEED}, stream {stream}: {inside}"
                );
            }
        }
    }
}
