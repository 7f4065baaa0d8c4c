//! Witnesses along a direction that several tangent planes have in common.
//!
//! Where a rim touches an edge, the face has a cusp between the two: its points are
//! nearer and nearer to the common tangent `v`, so that no direction in the plane of the
//! face leads into it. On `p + s v + s² a` a sheet whose tangent plane contains `v` has the
//! sign of
//!
//! ```text
//! 2 g·a + v·M v
//! ```
//!
//! which is linear in `a = x n + y n'`, with the normals of two of the planes. So each such
//! sheet is a line in the plane of `(x, y)`, and the cells and faces along `v` are the
//! cells of these lines and their edges. A pair of witnesses is beside the middle of each
//! edge. Middles are rounded; the signs of the pair say whether it is one.
//!
//! Lines that all go through one point are those of the tangent planes alone, which
//! `smooth.rs` has.

use crate::number::exact;

use super::ring::{Number, Vector};
use super::survey::{Curve, Survey};

/// How far beside an edge witnesses are, as a share of its length.
const BESIDE: [f64; 4] = [1e-2, 1e-4, 1e-7, 1e-10];

/// Points of a line that are nearer, as a share of the greatest coordinate, are one.
const ONE_POINT: f64 = 1e-10;

/// `p x + q y + r`, exactly and in f64, and the sheets that it is.
struct Line {
    exact: [Number; 3],
    rough: [f64; 3],
    sheets: Vec<usize>,
}

/// Notes what is along `v`, the common line of the planes with the normals given.
pub(super) fn survey_along(survey: &mut Survey, v: &Vector, normals: [&Vector; 2]) {
    let lines = lines(survey, v, normals);
    if lines.len() < 3 {
        return;
    }
    let crossings: Vec<Vec<f64>> = lines.iter().map(|line| line.crossings(&lines)).collect();
    let is_central = |all: &Vec<f64>| all.len() == 1;
    if crossings.iter().all(is_central) {
        return;
    }
    for (line, crossings) in lines.iter().zip(&crossings) {
        for (middle, length) in edges(crossings) {
            let point = line.at(middle);
            for beside in BESIDE {
                let pair = [-1.0, 1.0].map(|side| {
                    let off = side * beside * length;
                    let [x, y] = line.beside(point, off).map(exact);
                    Curve {
                        v: v.clone(),
                        a: Some(normals[0].times(&x).plus(&normals[1].times(&y))),
                    }
                });
                if survey.note([&pair[0], &pair[1]], &line.sheets) {
                    break;
                }
            }
        }
    }
}

/// The sheets whose tangent planes contain `v`, as lines.
fn lines(survey: &Survey, v: &Vector, normals: [&Vector; 2]) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for (number, active) in survey.active.iter().enumerate() {
        let g = &active.gradient;
        if g.is_zero() || !g.dot(v).is_zero() {
            continue;
        }
        let [p, q] = normals.map(|normal| g.dot(normal).times(&exact(2.0)));
        let exact = [p, q, active.sheet.form.of(v, v)];
        match lines.iter_mut().find(|line| line.is_same(&exact)) {
            Some(line) => line.sheets.push(number),
            None => lines.push(Line {
                rough: exact.each_ref().map(Number::approximation),
                exact,
                sheets: vec![number],
            }),
        }
    }
    lines
}

impl Line {
    fn is_same(&self, other: &[Number; 3]) -> bool {
        [(0, 1), (1, 2), (2, 0)].into_iter().all(|(i, j)| {
            let one = self.exact[i].by(&other[j]);
            one.minus(&self.exact[j].by(&other[i])).is_zero()
        })
    }

    fn size(&self) -> f64 {
        let [p, q, _] = self.rough;
        (p * p + q * q).sqrt()
    }

    /// The point at a distance from the foot of the origin.
    fn at(&self, along: f64) -> [f64; 2] {
        let ([p, q, r], size) = (self.rough, self.size());
        let foot = -r / size;
        [(p * foot - q * along) / size, (q * foot + p * along) / size]
    }

    /// The same point, off the line.
    fn beside(&self, [x, y]: [f64; 2], off: f64) -> [f64; 2] {
        let ([p, q, _], size) = (self.rough, self.size());
        [x + p / size * off, y + q / size * off]
    }

    /// Where other lines cross this one, in order.
    fn crossings(&self, lines: &[Self]) -> Vec<f64> {
        let mut crossings = Vec::new();
        for other in lines {
            let value = |[x, y]: [f64; 2]| {
                let [p, q, r] = other.rough;
                p * x + q * y + r
            };
            let start = value(self.at(0.0));
            let slope = value(self.at(1.0)) - start;
            if slope.abs() > ONE_POINT * other.size() {
                crossings.push(-start / slope);
            }
        }
        crossings.sort_by(f64::total_cmp);
        let greatest = crossings
            .iter()
            .fold(1.0, |sum: f64, one| sum.max(one.abs()));
        crossings.dedup_by(|one, other| (*one - *other).abs() < ONE_POINT * greatest);
        crossings
    }
}

/// The middles and lengths of the edges that crossings leave of a line.
fn edges(crossings: &[f64]) -> Vec<(f64, f64)> {
    let (Some(first), Some(last)) = (crossings.first(), crossings.last()) else {
        return vec![(0.0, 1.0)];
    };
    let far = 1.0 + first.abs().max(last.abs());
    let inner = crossings.windows(2);
    inner
        .map(|pair| (0.5 * (pair[0] + pair[1]), pair[1] - pair[0]))
        .chain([(first - far, far), (last + far, far)])
        .collect()
}
