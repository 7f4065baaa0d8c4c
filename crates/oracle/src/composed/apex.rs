//! Witnesses beside cones whose apex is the point.
//!
//! There `g` is zero, and the sign of the sheet on `p + s v` is that of `v·M v`. The
//! rulings of the cone are cut into stretches by the tangent planes of other sheets and
//! by other cones with the same apex. In each stretch are two witnesses, a
//! little inside and a little outside of the cone. Rulings are rounded: what counts is
//! that the signs of the two witnesses differ in this cone only, and they are tried
//! nearer and nearer until that is so. Other cones are crossed where a
//! fine step sees a change of sign.
//!
//! A needle's half opening angle may be far below the rounding of a direction. So a ruling is
//! `v = a + σ (cos φ u + sin φ w)` in exact numbers, with the exact axis `a`; only `u` and `w`,
//! unit vectors across it, and `σ` are rounded, which tilts the cone by 2^-52 of `σ`.

use std::f64::consts::TAU;

use crate::number::{ExactVector, exact, to_f64};

use super::ring::Vector;
use super::survey::{Active, Curve, Survey};

/// Steps around a cone in which crossings are looked for.
const STEPS: usize = 360;

/// The angle of the first step, in no relation to planes of whole numbers.
const FIRST: f64 = 0.1234;

/// Where in its stretch a witness is: not in the middle, which is a ruling on which
/// another cone may touch this one.
const BETWEEN: f64 = 0.37;

/// How far from the cone witnesses are, as a share.
const NEAR: [f64; 4] = [1e-3, 1e-5, 1e-8, 1e-11];

/// The rulings of a cone on the side of its solid or on the other one.
struct Rulings {
    axis: ExactVector,
    across: [ExactVector; 2],
    /// The radius of the cone at the end of the axis.
    radius: f64,
}

impl Rulings {
    /// That at an angle, with a share of the cone's radius.
    fn at(&self, angle: f64, share: f64) -> ExactVector {
        let [u, w] = &self.across;
        let radius = self.radius * share;
        let radial = &u.times(&exact(radius * libm::cos(angle)))
            + &w.times(&exact(radius * libm::sin(angle)));
        &self.axis + &radial
    }

    /// A function of the angle that has the sign of an active sheet on its ruling. Exact
    /// coefficients are rounded once, so that a small radius loses nothing.
    fn values_on(&self, active: &Active) -> Box<dyn Fn(f64) -> f64> {
        let [a, u, w] = [&self.axis, &self.across[0], &self.across[1]];
        let radius = self.radius;
        if !active.gradient.is_zero() {
            let slopes =
                [a, u, w].map(|v| active.gradient.dot(&Vector::rational(v)).approximation());
            return Box::new(move |angle| {
                let [x, y] = [libm::cos(angle), libm::sin(angle)];
                slopes[0] + radius * (x * slopes[1] + y * slopes[2])
            });
        }
        let form = &active.sheet.form;
        let [of_a, of_u, of_w] = [a, u, w].map(|v| form.image(v));
        let constant = to_f64(&of_a.dot(a));
        let linear = [u, w].map(|v| 2.0 * to_f64(&of_a.dot(v)));
        let squares = [of_u.dot(u), of_u.dot(w), of_w.dot(w)].map(|number| to_f64(&number));
        Box::new(move |angle| {
            let [x, y] = [libm::cos(angle), libm::sin(angle)];
            let bent = x * x * squares[0] + 2.0 * x * y * squares[1] + y * y * squares[2];
            constant + radius * (x * linear[0] + y * linear[1] + radius * bent)
        })
    }
}

pub(super) fn survey(survey: &mut Survey) {
    for number in 0..survey.active.len() {
        let active = &survey.active[number];
        let Some((axis, slope)) = &active.sheet.axis else {
            continue;
        };
        if !active.gradient.is_zero() {
            continue;
        }
        let same: Vec<usize> = (0..survey.active.len())
            .filter(|&other| is_same_cone(survey, number, other))
            .collect();
        let rounded = axis.rounded();
        let u = rounded.normalize().any_orthonormal_vector();
        let w = rounded.normalize().cross(u);
        let radius = slope * rounded.length();
        for side in [1.0, -1.0] {
            let rulings = Rulings {
                axis: axis.times(&exact(side)),
                across: [u, w].map(ExactVector::new),
                radius,
            };
            for angle in stretches(survey, &rulings, &same) {
                let pair = |near: f64| {
                    [1.0 - near, 1.0 + near].map(|share| Curve {
                        v: Vector::rational(&rulings.at(angle, share)),
                        a: None,
                    })
                };
                for near in NEAR {
                    let [inner, outer] = pair(near);
                    if survey.note([&inner, &outer], &same) {
                        break;
                    }
                }
            }
        }
    }
}

/// Whether two active sheets are the same cone: their matrices are proportional.
fn is_same_cone(survey: &Survey, one: usize, other: usize) -> bool {
    let [one, other] = [one, other].map(|number| &survey.active[number]);
    if !other.gradient.is_zero() {
        return false;
    }
    let [m, n] = [one, other].map(|active| &active.sheet.form.0);
    let entries = || (0..9).map(|k| (k / 3, k % 3));
    let size = |&(i, j): &(usize, usize)| to_f64(&m[i].0[j]).abs();
    let greatest = entries().max_by(|one, other| size(one).total_cmp(&size(other)));
    let (k, l) = greatest.unwrap_or_default();
    entries().all(|(i, j)| &m[i].0[j] * &n[k].0[l] == &n[i].0[j] * &m[k].0[l])
}

/// An angle in each of the stretches of a cone between other sheets.
fn stretches(survey: &Survey, rulings: &Rulings, same: &[usize]) -> Vec<f64> {
    let step = TAU / STEPS as f64;
    let mut crossings = Vec::new();
    for (number, active) in survey.active.iter().enumerate() {
        if same.contains(&number) {
            continue;
        }
        let value = rulings.values_on(active);
        for i in 0..STEPS {
            let (mut low, mut high) = (FIRST + i as f64 * step, FIRST + (i + 1) as f64 * step);
            let starts = value(low) < 0.0;
            // The last step ends where the first one began, to the same bits.
            let end = if i + 1 == STEPS { FIRST } else { high };
            if starts == (value(end) < 0.0) {
                continue;
            }
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if (value(middle) < 0.0) == starts {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            crossings.push(low);
        }
    }
    crossings.sort_by(f64::total_cmp);
    let Some(&first) = crossings.first() else {
        return vec![0.4];
    };
    crossings.push(first + TAU);
    let pairs = crossings.windows(2);
    let wide = pairs.filter(|pair| pair[1] - pair[0] > 1e-9);
    wide.map(|pair| pair[0] + BETWEEN * (pair[1] - pair[0]))
        .collect()
}
