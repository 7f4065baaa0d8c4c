//! The decisions of the triple-product solver at the rims.
//!
//! The solver compares the axial position `y` of the roots with the planes of the disks, at 0
//! and `|a|²`. For a line through a point of a rim, `y` is on such a plane, and the computed
//! `y` is off by its rounding, even if all inputs are small whole numbers: a root is rarely a
//! binary number.
//!
//! With `k = |a| |d| / |n|` and the gap `g = D / (radius² |n|²)` the rounding is less than
//!
//! ```text
//! 2^-43 k / √g |a| √(|x|² + |a|² + radius²)                                (1)
//! ```
//!
//! by `docs/derivations.md`, section 2, (6a). An end that is nearer to a plane comes from exact
//! arithmetic on `a`, `x`, `d` and the radius, with its `t` rounded.
//!
//! The check runs for every line, so it uses the square of (1), which needs no root:
//! `|a|² |x|²` is `|m|² + (x·a)²`, and the solver has both. It uses constants for `k` and `g`
//! unless the line is near the axis or grazes the wall.

use glam::DVec3;

use super::triple_product::{Axis, LEAST_SQUARED_SINE, Line};
use super::{Caps, Chord, ChordEnd, Cylinder, exact};
use crate::math::{Real, RealVector, power_of_two};

/// The square of the constant of (1).
const ROUNDING: f64 = power_of_two(-86);

/// The gap below which a line grazes the wall.
///
/// It trades divisions for the size of (1), which uses this gap for all other lines: at 2^-14,
/// one line in 2^15 needs the division, and one in 2^34 of those from nearby is decided
/// exactly.
const LEAST_GAP: f64 = power_of_two(-14);

/// An upper bound of `k² / g` for a line that is neither near the axis nor grazes the wall.
pub(super) const ORDINARY_DISPLACEMENT: f64 = 1.0 / (LEAST_SQUARED_SINE * LEAST_GAP);

/// Whether a line, given by its `|n|²` and `D`, is next to a tangent of the wall.
#[inline(always)]
pub(super) fn is_grazing<S: Real>(axis: &impl Axis<S>, nn: S, discriminant: S) -> bool {
    discriminant < S::from_f64(LEAST_GAP) * (axis.radius() * axis.radius() * nn)
}

/// An upper bound of `k² / g` for any line.
#[inline(always)]
pub(super) fn displacement<S: Real>(axis: &impl Axis<S>, d: S::Vector, line: &Line<S>) -> S {
    if line.is_near_axis(axis, d) | is_grazing(axis, line.nn, line.discriminant) {
        let (sizes, rr) = (axis.aa() * d.dot(d), axis.radius() * axis.radius());
        return rare_displacement(sizes, line.nn, rr * line.nn, line.discriminant);
    }
    S::from_f64(ORDINARY_DISPLACEMENT)
}

/// Takes separate numbers, as `exact_chord` does.
#[cold]
#[inline(never)]
fn rare_displacement<S: Real>(sizes: S, nn: S, reach: S, discriminant: S) -> S {
    let at_least = |least: f64, x: S| {
        let least = S::from_f64(least);
        if x > least { x } else { least }
    };
    let squared_k = at_least(1.0 / LEAST_SQUARED_SINE, sizes / nn);
    squared_k * at_least(1.0 / LEAST_GAP, reach / discriminant)
}

/// The square of (1), from the square of its last two factors.
#[inline(always)]
pub(super) fn squared_rounding<S: Real>(displacement: S, squared_sizes: S) -> S {
    S::from_f64(ROUNDING) * displacement * squared_sizes
}

/// The chord by exact arithmetic.
///
/// Takes separate numbers: they are passed in registers, and the caller does not need its
/// vectors in memory for this rare case.
#[cold]
#[inline(never)]
#[expect(clippy::too_many_arguments, reason = "three vectors in registers")]
pub(super) fn exact_chord<S: Real>(
    ax: S,
    ay: S,
    az: S,
    radius: S,
    xx: S,
    xy: S,
    xz: S,
    dx: S,
    dy: S,
    dz: S,
) -> Option<Chord<S>> {
    let [a, x, d] = [[ax, ay, az], [xx, xy, xz], [dx, dy, dz]].map(|v| S::Vector::of(v).to_f64());
    let cylinder = Cylinder::from_valid(DVec3::ZERO, a, radius.to_f64(), Caps::Both);
    let chord = exact::chord(&cylinder, &x, d)?;
    let end = |end: ChordEnd| ChordEnd {
        t: S::from_f64(end.t),
        part: end.part,
        on_rim: end.on_rim,
    };
    Some(Chord {
        enter: end(chord.enter),
        leave: end(chord.leave),
        lies_on: chord.lies_on,
    })
}

#[cfg(test)]
mod tests {
    use dashu_float::{FBig, round::mode::HalfEven};

    use super::*;
    use crate::math::Random;
    use crate::solid::slab::Wall;
    use crate::solid::triple_product::{Roots, StatedAxis, slab};

    type Long = FBig<HalfEven, 2>;

    fn long(x: f64) -> Long {
        let x = Long::try_from(x).expect("it is finite");
        x.with_precision(500).value()
    }

    fn dot(a: &[Long; 3], b: &[Long; 3]) -> Long {
        &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
    }

    fn cross(a: &[Long; 3], b: &[Long; 3]) -> [Long; 3] {
        let term = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
        [term(1, 2), term(2, 0), term(0, 1)]
    }

    /// The axial positions of both roots in 500 bits, if the line intersects the wall.
    fn positions(axis: &StatedAxis<f64>, x: DVec3, d: DVec3) -> Option<[Long; 2]> {
        let [a, x, d] = [axis.a, x, d].map(|v| v.to_array().map(long));
        let (n, m) = (cross(&a, &d), cross(&a, &x));
        let (nn, w) = (dot(&n, &n), dot(&x, &n));
        let discriminant = long(axis.radius) * long(axis.radius) * &nn - &w * &w;
        if discriminant < Long::ZERO {
            return None;
        }
        let (s, mn) = ((discriminant * dot(&a, &a)).sqrt(), dot(&m, &n));
        let at = |t: Long| dot(&x, &a) + t * dot(&d, &a);
        Some([at((-&mn - &s) / &nn), at((s - mn) / nn)])
    }

    /// A line at a gap of 2^-50 to 1 from a tangent, at an angle of 1e-7 to 1 to the axis.
    fn line(random: &mut Random, axis: &StatedAxis<f64>) -> (DVec3, DVec3) {
        let along = axis.a.normalize();
        let outward = along.cross(random.direction()).normalize();
        let gap = random.log_uniform(power_of_two(-50), 1.0);
        let sine = random.log_uniform(1e-7, 1.0);
        let flat = outward.cross(along);
        let d = (along * (1.0 - sine * sine).sqrt() + flat * sine) * random.log_uniform(1e-3, 1e3);
        let through = axis.a * random.unit() + outward * (axis.radius * (1.0 - gap));
        (through - d * random.log_uniform(1e-6, 1e6), d)
    }

    #[test]
    fn heights_are_off_by_less_than_the_bound() {
        let mut random = Random::new(61, 0);
        let mut most_used = 0.0_f64;
        for case in 0..20_000 {
            let axis = StatedAxis {
                a: random.direction() * random.log_uniform(1e-4, 1e4),
                radius: random.log_uniform(1e-4, 1e4),
            };
            let (x, d) = line(&mut random, &axis);
            let line = Line::new(&axis, x, d);
            let (true, Some(positions)) = (line.discriminant >= 0.0, positions(&axis, x, d)) else {
                continue;
            };
            let (slab, roots) = (slab(&axis, x, d), Roots::new(&axis, x, d, &line));
            let bound = roots.squared_rounding(&slab).sqrt();
            for (t, position) in [roots.enter(), roots.leave()].into_iter().zip(positions) {
                let off = long(slab.position + t * slab.slope) - position;
                let used = off.to_f64().value().abs() / bound;
                assert!(
                    used < 1.0,
                    "case {case}: {used} of {bound:e}, {axis:?} {x} {d}"
                );
                most_used = most_used.max(used);
            }
        }
        assert!(
            most_used > 1e-3,
            "at most {most_used} of the bound was used"
        );
    }
}
