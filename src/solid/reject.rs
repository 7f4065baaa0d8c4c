//! Rejects lines that certainly miss balls, disks and cones' walls, by a few products.
//!
//! Most of the rays that enter the box of a slender or turned solid miss the solid, and not
//! narrowly. They need neither the solvers' bounds of every term, nor a root or a branch: so a
//! row of rays is tested at once.
//!
//! A line misses a ball of radius `r` iff `|l| > r |d|`, `l = x × d`, with `x` relative to its
//! center; a disk with the normal `n` iff `|P| > r |v|`, `P = n × l`, `v = n·d` (`disk.rs`);
//! and a cone's wall, both nappes, iff `E < 0` of (4) in `cone/wall.rs`, which is
//! `√τ |w| > |k|` with `τ = (β + Δ²) / |a|²`. The errors of the computed terms are, with
//! u = 2^-53,
//!
//! ```text
//! |δl| <= 5 u |x| |d|,       |δP| <= 12 u |n| |x| |d|,   |δv| <= 6 u |n| |d|,
//! |δw| <= 6 u |x| |a| |d|,   |δk| <= 6 u |d| (r0 |a| + |Δ| |x|)
//! ```
//!
//! (one u of `l` is for an `x` that is itself a rounded difference). So the miss is certain if
//! the left side exceeds the right one by their errors, `p > q + ε`; and squared, since
//! `(q + ε)² <= (1 + η) q² + (1 + 1/η) ε²` for any `η > 0`, if
//!
//! ```text
//! |l|² > (1 + η) r² |d|² + ρ |d|² |x|²
//! |P|² > (1 + η) r² v² + ρ |d|² |n|² (|x|² + r²)
//! τ w² > (1 + η) |k|² + ρ |d|² (r0² |a|² + Δ² |x|² + τ |x|² |a|²)
//! ```
//!
//! and a hit of the disk is certain by the second with its sides exchanged. `ε²` is the square
//! of a sum of two terms, so at most twice the sum of their squares, and for `k` twice that:
//! `2 (12 u)²` and `4 (6 u)²` times the factor of `ρ`. With `η` = 2^-20, `ρ` = 2^-77 is above
//! `(1 + 1/η) · 288 u²`. Lines that miss by less than 2^-19 of the radius, or 2^-38 of their
//! distance, are left to the solver.
//!
//! **Underflow.** Lines are rejected only if `|l|²`, `|P|²` or `w²` is above 2^-400. The loss
//! of the sides is then too small to matter. For the wall `|x| |a| |d| >= |w|`, so `|x|² |a|²`
//! is above 2^-602 and `|x|²` above 2^-906, and the last of its terms is more than 2^-478,
//! while products that lost all bits add up to less than 2^-870. That requires an `|a|²` that
//! is not lost. If `|a|` is below 2^-171, the hull of two balls is within the margin of the
//! greater one's test, for radii are at least 2^-150.

use glam::DVec3;

use super::cone::taper::{Fit, Taper};
use crate::math::power_of_two;

/// `1 + η`, with four times the `η` for the roundings of the squares.
const WIDER: f64 = 1.0 + power_of_two(-18);

/// `ρ`, doubled for its roundings.
const ROUNDINGS: f64 = power_of_two(-76);

/// Squares up to this are left to the solver: the terms compared with them may have been lost
/// to underflow.
const LEAST: f64 = power_of_two(-400);

/// A line `x + t d`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    x: DVec3,
    d: DVec3,
    /// `x × d`.
    across: DVec3,
    xx: f64,
    dd: f64,
}

impl Line {
    #[inline(always)]
    pub fn new(x: DVec3, d: DVec3) -> Self {
        Self {
            x,
            d,
            across: x.cross(d),
            xx: x.dot(x),
            dd: d.dot(d),
        }
    }

    /// Whether it certainly misses the ball about the origin. `false` is inconclusive, and
    /// returned for values that are not finite.
    #[inline(always)]
    pub fn misses_ball(&self, radius: f64) -> bool {
        let beside = self.across.dot(self.across);
        (beside > LEAST) & is_above(beside, radius * radius * self.dd, self.dd * self.xx)
    }

    /// Whether it certainly misses the disk about the origin across a nonzero normal. `false`
    /// is inconclusive.
    #[inline(always)]
    pub fn misses_disk(&self, normal: DVec3, radius: f64) -> bool {
        let [beside, reach, sizes] = self.disk(normal, radius);
        (beside > LEAST) & is_above(beside, reach, sizes)
    }

    /// Whether it certainly hits that disk. `false` is inconclusive.
    #[inline(always)]
    pub fn hits_disk(&self, normal: DVec3, radius: f64) -> bool {
        let [beside, reach, sizes] = self.disk(normal, radius);
        (reach > LEAST) & is_above(reach, beside, sizes)
    }

    /// `|P|²`, `r² v²` and the sizes of their roundings.
    #[inline(always)]
    fn disk(&self, normal: DVec3, radius: f64) -> [f64; 3] {
        let (p, slope) = (normal.cross(self.across), normal.dot(self.d));
        let rr = radius * radius;
        let sizes = self.dd * normal.dot(normal) * (self.xx + rr);
        [p.dot(p), rr * (slope * slope), sizes]
    }

    /// Whether it certainly misses the wall on both sides of the apex. `false` is inconclusive.
    #[inline(always)]
    pub fn misses_wall(&self, taper: &Taper) -> bool {
        let (a, r0) = (taper.a, taper.radius0);
        let (aa, delta) = (a.dot(a), taper.radius1 - r0);
        let squared = delta * delta;
        let tau = match taper.fit {
            Fit::Disks => 1.0 + squared / aa,
            Fit::Balls => 1.0,
        };
        let n = a.cross(self.d);
        let (w, k) = (self.x.dot(n), n * r0 + self.across * delta);
        let sizes = r0 * r0 * aa + squared * self.xx + tau * self.xx * aa;
        let ww = w * w;
        (ww > LEAST) & is_above(tau * ww, k.dot(k), self.dd * sizes)
    }
}

/// Whether a square is certainly above another; `sizes` is multiplied by [`ROUNDINGS`].
#[inline(always)]
fn is_above(one: f64, other: f64, sizes: f64) -> bool {
    one > WIDER * other + ROUNDINGS * sizes
}

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;

    use super::*;
    use crate::math::Random;
    use crate::solid::cone::taper::{Exactly, Term};
    use crate::solid::exact::sign;

    const SEED: u64 = 41;

    #[test]
    fn balls_are_rejected_from_a_little_beyond_the_radius_on() {
        let mut random = Random::new(SEED, 0);
        for _ in 0..10_000 {
            let (away, radius) = (random.direction(), random.log_uniform(1e-3, 1e3));
            let heading = away.any_orthonormal_vector() * random.log_uniform(1e-3, 1e3);
            let back = heading * random.uniform(-1e3, 1e3) * radius;
            let at = |factor: f64| Line::new(away * (radius * factor) + back, heading);
            assert!(at(1.0001).misses_ball(radius));
            assert!(!at(1.0).misses_ball(radius));
            assert!(!at(0.9999).misses_ball(radius));
        }
    }

    #[test]
    fn disks_are_rejected_from_a_little_beyond_the_rim_on() {
        let mut random = Random::new(SEED, 2);
        for _ in 0..10_000 {
            let (axis, radius) = (random.direction(), random.log_uniform(1e-3, 1e3));
            let normal = axis * random.log_uniform(1e-3, 1e3);
            let away = axis.any_orthonormal_vector() * radius;
            let d = random.direction();
            let back = d * random.uniform(-1e3, 1e3) * radius;
            let at = |factor: f64| Line::new(away * factor + back, d);
            // Nearly along the plane the rim is too far away in the direction.
            if axis.dot(d).abs() > 0.01 {
                assert!(at(1.0001).misses_disk(normal, radius));
            }
            assert!(!at(1.0).misses_disk(normal, radius));
            assert!(!at(0.9999).misses_disk(normal, radius));
        }
    }

    /// The radii are chosen for `E` = 0, up to a factor. Numbers of any length give the sign of
    /// `E`.
    #[test]
    fn walls_are_rejected_from_a_little_beyond_the_radii_on() {
        let mut random = Random::new(SEED, 1);
        let mut rejected = 0;
        for _ in 0..10_000 {
            let a = random.direction() * random.log_uniform(1e-3, 1e3);
            let (x, d) = (random.direction() * a.length() * 9.0, random.direction());
            let (one, other) = (random.unit(), random.unit());
            let (n, w) = (a.cross(d), x.dot(a.cross(d)));
            let k = n * one + x.cross(d) * (other - one);
            for factor in [0.9999, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.0001] {
                let scale = factor * w.abs() / k.length();
                let taper = Taper {
                    a,
                    radius0: scale * one,
                    radius1: scale * other,
                    fit: Fit::Balls,
                };
                let misses = Line::new(x, d).misses_wall(&taper);
                let e = sign(&Exactly {
                    taper: &taper,
                    x,
                    d,
                    term: Term::E,
                });
                assert!(!misses || e == Ordering::Less, "{taper:?} {x} {d}");
                assert!(misses || factor > 0.99995, "{taper:?} {x} {d}");
                rejected += usize::from(misses);
            }
        }
        assert_eq!(rejected, 10_000, "within 2^-19 nothing is rejected");
    }

    #[test]
    fn what_is_no_number_or_too_small_is_left_to_the_solver() {
        let far = DVec3::new(0.0, 9.0, 0.0);
        assert!(Line::new(far, DVec3::X).misses_ball(1.0));
        assert!(!Line::new(far * f64::INFINITY, DVec3::X).misses_ball(1.0));
        assert!(!Line::new(far * f64::NAN, DVec3::X).misses_ball(1.0));
        assert!(!Line::new(far * power_of_two(-460), DVec3::X).misses_ball(0.0));
    }

    /// Lines that enter the cone, with products most of which underflow.
    #[test]
    fn lines_at_an_apex_are_not_rejected_by_what_underflow_left() {
        let cone = |a, radius1| Taper {
            a,
            radius0: 0.0,
            radius1,
            fit: Fit::Disks,
        };
        let beside = DVec3::Y * 7.233324068983989e-161;
        let d = DVec3::new(0.9998796021390856, 0.0, 0.015517126866271849);
        let wide = cone(DVec3::Z, power_of_two(90));
        assert!(!Line::new(beside, d).misses_wall(&wide));
        let d = DVec3::new(0.3, 0.5, 0.7);
        let long = cone(DVec3::new(0.7, 0.2, -0.4) * power_of_two(149), 1.0);
        assert!(!Line::new(d * -power_of_two(-540), d).misses_wall(&long));
    }
}
