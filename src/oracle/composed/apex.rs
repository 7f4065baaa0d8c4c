//! Witnesses beside cones whose apex is the point.
//!
//! There `g` is zero, and the sign of the sheet on `p + s v` is that of `v·M v`. The
//! rulings of the cone are cut into stretches by the tangent planes of other sheets and
//! by other cones with the same apex. In each stretch are two witnesses, a
//! little inside and a little outside of the cone. Rulings are rounded: what counts is
//! that the signs of the two witnesses differ in this cone only, and they are tried
//! nearer and nearer until that is so. Other cones are crossed where a
//! fine step sees a change of sign.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::oracle::number::{ExactVector, to_f64};

use super::around::{Curve, Survey};
use super::ring::Vector;

/// Steps around a cone in which crossings are looked for.
const STEPS: usize = 360;

/// The angle of the first step, in no relation to planes of whole numbers.
const FIRST: f64 = 0.1234;

/// Where in its stretch a witness is: not in the middle, which is a ruling on which
/// another cone may touch this one.
const BETWEEN: f64 = 0.37;

/// How far from the cone witnesses are, as a share.
const NEAR: [f64; 4] = [1e-3, 1e-5, 1e-8, 1e-11];

/// The rulings of a cone on the side of its solid and the other one.
struct Rulings {
    axis: DVec3,
    across: [DVec3; 2],
    slope: f64,
}

impl Rulings {
    fn at(&self, angle: f64, share: f64) -> DVec3 {
        let [u, w] = self.across;
        let radial = u * libm::cos(angle) + w * libm::sin(angle);
        self.axis + radial * (self.slope * share)
    }
}

pub(super) fn survey(survey: &mut Survey) {
    for number in 0..survey.active.len() {
        let active = &survey.active[number];
        let Some((axis, slope)) = active.sheet.axis else {
            continue;
        };
        if !active.gradient.is_zero() {
            continue;
        }
        let same: Vec<usize> = (0..survey.active.len())
            .filter(|&other| is_same_cone(survey, number, other))
            .collect();
        let axis = axis.normalize();
        let u = axis.any_orthonormal_vector();
        for axis in [axis, -axis] {
            let rulings = Rulings {
                axis,
                across: [u, axis.cross(u)],
                slope,
            };
            for angle in stretches(survey, &rulings, &same) {
                let pair = |near: f64| {
                    [1.0 - near, 1.0 + near].map(|share| {
                        let v = ExactVector::new(rulings.at(angle, share));
                        Curve {
                            v: Vector::rational(&v),
                            a: None,
                        }
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
        let g = active.gradient.approximation();
        let rows = active.sheet.form.0.each_ref().map(ExactVector::rounded);
        let value = |angle: f64| {
            let v = rulings.at(angle, 1.0);
            if active.gradient.is_zero() {
                v.dot(DVec3::from_array(rows.map(|row| row.dot(v))))
            } else {
                g.dot(v)
            }
        };
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
