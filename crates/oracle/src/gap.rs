//! How far the numbers of a case are from another answer.
//!
//! An answer (hit or miss, and which part) changes only at an *event*:
//!
//! - **tangency**: the line touches the wall, `D = r²|n|² - w² = 0` with
//!   `n = a × d`, `w = x·n`, at a height within the slab between the disks;
//! - **rim**: the line meets the edge of a disk, `G = |P|² - r² (a·d)² = 0`
//!   with `P = x (a·d) - d (a·x)`, `x` from that disk's middle;
//! - **range**: a finite end of the range is on the surface.
//!
//! The first two count only where the event is in the ray's range and not
//! after the hit. With `a = p1 - p0`, `x = o - p0` all of these are
//! polynomials F of the inputs `v` (end points, radius, origin, direction,
//! end of range). To first order the least change, the same *relative* change
//! for every input, that brings F to zero is
//!
//! ```text
//! gap(F) = |F| / Σ |v ∂F/∂v|                                               (1)
//! ```
//!
//! An event needs all of its conditions at once: its gap is the greatest of
//! theirs, 0 for one that is true. The gap of the case is the least of its
//! events'. F is computed exactly and rounded; the derivatives and the
//! positions of events along the ray are computed in f64, which a first-order
//! measure has no need to exceed.
//!
//! **The half-ulp band.** Half an ulp of a number is between `u/2` and `u` of
//! it, u being half an ulp of 1 (2^-24 for f32, 2^-53 for f64). So a case
//! whose answer changes when every input moves by at most half an ulp has a
//! gap of at most u, and one with a gap of u/2 or less is such a case:
//! `gap <= u` is the half-ulp band, at most twice as wide.

use glam::DVec3;

use super::cylinder::TrueHit;
use super::number::{Exact, ExactVector, exact, long, to_f64};
use cyltrace::math::{Ray, power_of_two_below};
use cyltrace::solid::Cylinder;

/// The gap of a case, relative to its numbers: 0 where the answer changes at
/// the least change, about 1 where it takes other numbers altogether.
/// `hit` is the true answer.
///
/// # Panics
/// When the ray is not valid ([`Ray::is_valid`]).
#[must_use]
pub fn gap(cylinder: &Cylinder, ray: &Ray, hit: Option<&TrueHit>) -> f64 {
    assert!(
        ray.is_valid(),
        "a gap is of a valid ray, and this is {ray:?}"
    );
    let case = Case::new(cylinder, ray, hit.map(TrueHit::t_f64));
    let mut gap = case.tangency().min(case.rim(false)).min(case.rim(true));
    for end in [case.t_min, case.t_max] {
        if end.is_finite() && !(end > case.t_end) {
            gap = gap.min(case.range_end(end));
        }
    }
    gap
}

/// The numbers of a case, scaled by powers of two such that nothing overflows.
struct Case {
    caps: [bool; 2],
    p0: DVec3,
    p1: DVec3,
    r: f64,
    o: DVec3,
    d: DVec3,
    t_min: f64,
    t_max: f64,
    /// The hit, or the end of the range.
    t_end: f64,
    exact_a: ExactVector,
    exact_x: ExactVector,
    exact_d: ExactVector,
    a: DVec3,
    x: DVec3,
}

/// The derivatives of a condition by the vectors that it is made of.
#[derive(Default)]
struct Gradient {
    /// By `x`, the way from `p0` to the origin.
    x: DVec3,
    /// By `a`, the axis.
    a: DVec3,
    d: DVec3,
    r: f64,
}

impl Case {
    fn new(cylinder: &Cylinder, ray: &Ray, t_hit: Option<f64>) -> Self {
        let sizes = [cylinder.p0(), cylinder.p1(), ray.origin].map(|v| v.abs().max_element());
        let unit = power_of_two_below(sizes.into_iter().fold(cylinder.radius(), f64::max));
        let speed = power_of_two_below(ray.direction.abs().max_element());
        let [p0, p1, o] = [cylinder.p0(), cylinder.p1(), ray.origin].map(|v| v / unit);
        let d = ray.direction / speed;
        // t counts in lengths of the direction.
        let time = |t: f64| t * speed / unit;
        let [exact_p0, exact_p1, exact_o] = [p0, p1, o].map(ExactVector::new);
        let caps = cylinder.caps();
        Self {
            caps: [caps.at_p0(), caps.at_p1()],
            p0,
            p1,
            r: cylinder.radius() / unit,
            o,
            d,
            t_min: time(ray.t_min),
            t_max: time(ray.t_max),
            t_end: time(t_hit.unwrap_or(ray.t_max)),
            exact_a: &exact_p1 - &exact_p0,
            exact_x: &exact_o - &exact_p0,
            exact_d: ExactVector::new(d),
            a: p1 - p0,
            x: o - p0,
        }
    }

    /// The gap (1) of a condition whose value is `value`.
    fn first_order(&self, value: f64, gradient: &Gradient) -> f64 {
        let by_p0 = gradient.x + gradient.a;
        let change = gradient.x.abs().dot(self.o.abs())
            + by_p0.abs().dot(self.p0.abs())
            + gradient.a.abs().dot(self.p1.abs())
            + gradient.d.abs().dot(self.d.abs())
            + (gradient.r * self.r).abs();
        quotient(value.abs(), change)
    }

    /// How far the parameter of an event is from those that count. `k` is the
    /// reciprocal of the sine of the angle at which the line meets what it
    /// meets, by which errors along the line grow.
    fn to_range(&self, t: f64, k: f64) -> f64 {
        let outside = (self.t_min - t).max(t - self.t_end);
        let change = (t.abs() + (self.x.length() + self.a.length()) / self.d.length()) * k;
        quotient(outside.max(0.0), change)
    }

    fn tangency(&self) -> f64 {
        let exact_n = self.exact_a.cross(&self.exact_d);
        let exact_w = self.exact_x.dot(&exact_n);
        let (n, w) = (rounded(&exact_n), rounded_number(&exact_w));
        let nn = n.dot(n);
        if nn == 0.0 {
            // Along the axis; only the edges of the disks decide.
            return f64::INFINITY;
        }
        let rr = exact(self.r) * exact(self.r);
        let value = rr * exact_n.dot(&exact_n) - &exact_w * &exact_w;
        let (a, x, d, r) = (self.a, self.x, self.d, self.r);
        let by_n = (n * (r * r) - x * w) * 2.0;
        let gradient = Gradient {
            x: n * (-2.0 * w),
            a: d.cross(by_n),
            d: by_n.cross(a),
            r: 2.0 * r * nn,
        };

        // Where the line is nearest to the axis, and at which height.
        let k = a.length() * d.length() / nn.sqrt();
        let t = -a.cross(x).dot(n) / nn;
        let height = (x + d * t).dot(a);
        let outside = (-height).max(height - a.length_squared()).max(0.0);
        let reach = (x.length() + a.length() + t.abs() * d.length()) * a.length() * k;
        self.first_order(rounded_number(&value), &gradient)
            .max(quotient(outside, reach))
            .max(self.to_range(t, k))
    }

    /// The edge of the disk at `p0`, or at `p1`.
    fn rim(&self, at_p1: bool) -> f64 {
        let from_middle = if at_p1 {
            &self.exact_x - &self.exact_a
        } else {
            self.exact_x.clone()
        };
        let exact_ad = self.exact_a.dot(&self.exact_d);
        let exact_ay = self.exact_a.dot(&from_middle);
        let point = &from_middle.times(&exact_ad) - &self.exact_d.times(&exact_ay);
        let reach = exact(self.r) * &exact_ad;
        let value = point.dot(&point) - &reach * &reach;

        let (a, d, r) = (self.a, self.d, self.r);
        let (y, p) = (rounded(&from_middle), rounded(&point));
        let (ad, ay) = (rounded_number(&exact_ad), rounded_number(&exact_ay));
        let by_y = (p * ad - a * p.dot(d)) * 2.0;
        let by_a = (d * p.dot(y) - y * p.dot(d)) * 2.0 - d * (2.0 * r * r * ad);
        let gradient = Gradient {
            x: by_y,
            // y = x - a for the disk at p1.
            a: if at_p1 { by_a - by_y } else { by_a },
            d: (a * p.dot(y) - p * ay) * 2.0 - a * (2.0 * r * r * ad),
            r: 2.0 * r * ad * ad,
        };
        let k = a.length() * d.length() / ad.abs();
        self.first_order(rounded_number(&value), &gradient)
            .max(self.to_range(-ay / ad, k))
    }

    /// The surface at an end of the range.
    fn range_end(&self, t: f64) -> f64 {
        let exact_q = &self.exact_x + &self.exact_d.times(&exact(t));
        let (a, r, q) = (self.a, self.r, rounded(&exact_q));
        let on_line = |by_q: DVec3, by_a: DVec3, by_r: f64| Gradient {
            x: by_q,
            a: by_a,
            d: by_q * t,
            r: by_r,
        };

        // |a × q|² - r² |a|², negative within the infinite wall.
        let exact_v = self.exact_a.cross(&exact_q);
        let rr = exact(r) * exact(r);
        let exact_wall = exact_v.dot(&exact_v) - rr * self.exact_a.dot(&self.exact_a);
        let (wall, v) = (rounded_number(&exact_wall), rounded(&exact_v));
        let by_a = (q.cross(v) - a * (r * r)) * 2.0;
        let gradient = on_line(v.cross(a) * 2.0, by_a, 2.0 * r * a.length_squared());
        let to_wall = self.first_order(wall, &gradient);

        // a·q and a·(q - a), the heights above the disks.
        let height0 = rounded_number(&self.exact_a.dot(&exact_q));
        let over_p1 = &exact_q - &self.exact_a;
        let height1 = rounded_number(&self.exact_a.dot(&over_p1));
        let to_disk0 = self.first_order(height0, &on_line(a, q, 0.0));
        let to_disk1 = self.first_order(height1, &on_line(a, rounded(&over_p1) - a, 0.0));

        let within_wall = if wall <= 0.0 { 0.0 } else { to_wall };
        let above0 = if height0 >= 0.0 { 0.0 } else { to_disk0 };
        let below1 = if height1 <= 0.0 { 0.0 } else { to_disk1 };
        let mut gap = to_wall.max(above0).max(below1);
        for (is_closed, to_disk) in self.caps.into_iter().zip([to_disk0, to_disk1]) {
            if is_closed {
                gap = gap.min(to_disk.max(within_wall));
            }
        }
        gap
    }
}

/// A quotient of two numbers that are not negative; 0 for 0 / 0.
fn quotient(value: f64, change: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value / change }
}

fn rounded(vector: &ExactVector) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|i| to_f64(&vector.0[i])))
}

fn rounded_number(x: &Exact) -> f64 {
    to_f64(&long(x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::first_hit;
    use cyltrace::solid::Caps;

    /// For a cylinder of radius 1 from z = 1 to z = 3. It does not start at 0,
    /// since a zero has no relative change.
    fn gap_of(caps: Caps, origin: [f64; 3], direction: [f64; 3]) -> f64 {
        let cylinder = Cylinder::new(DVec3::Z, DVec3::Z * 3.0, 1.0, caps).unwrap();
        let ray = Ray::new(DVec3::from(origin), DVec3::from(direction));
        gap(&cylinder, &ray, first_hit(&cylinder, &ray).hit.as_ref())
    }

    #[test]
    fn gap_of_ordinary_hits_and_misses_is_large() {
        for gap in [
            gap_of(Caps::Both, [-3.0, 0.0, 2.0], [1.0, 0.0, 0.0]),
            gap_of(Caps::Both, [-3.0, 5.0, 2.0], [1.0, 0.0, 0.0]),
            gap_of(Caps::Both, [0.0, 0.1, -5.0], [0.0, 0.0, 1.0]),
        ] {
            assert!(gap > 0.02, "{gap:e}");
        }
    }

    #[test]
    fn gap_at_each_event_is_the_distance_to_it() {
        let near = 1e-9;
        let gaps = [
            // Next to the wall; next to a rim; next to a disk's plane.
            gap_of(Caps::Both, [-3.0, 1.0 + near, 2.0], [1.0, 0.0, 0.0]),
            gap_of(Caps::Both, [-3.0, 0.0, -3.0 + near], [1.0, 0.0, 2.0]),
            gap_of(Caps::Both, [-3.0, 0.0, 1.0 + near], [1.0, 0.0, 0.0]),
            // From next to the wall, and from next to a disk.
            gap_of(Caps::Both, [-1.0 - near, 0.0, 2.0], [1.0, 0.0, 0.0]),
            gap_of(Caps::Both, [0.0, 0.0, 1.0 + near], [1.0, 0.0, 1.0]),
        ];
        for gap in gaps {
            assert!(near / 50.0 < gap && gap < near, "{gaps:?}");
        }
        assert_eq!(gap_of(Caps::Both, [-3.0, 1.0, 2.0], [1.0, 0.0, 0.0]), 0.0);
        assert_eq!(gap_of(Caps::Both, [1.0, 0.0, -5.0], [0.0, 0.0, 1.0]), 0.0);
    }

    #[test]
    fn gap_ignores_events_out_of_reach() {
        // Tangent above the cylinder; tangent behind the origin; a rim
        // behind the hit; next to an absent disk.
        for gap in [
            gap_of(Caps::Both, [-3.0, 1.0, 6.0], [1.0, 0.0, 0.0]),
            gap_of(Caps::Both, [3.0, 1.0, 2.0], [1.0, 0.0, 0.0]),
            gap_of(Caps::Both, [-2.0, 0.0, 1.5], [1.0, 0.0, 0.5]),
            gap_of(Caps::None, [0.0, 0.0, 1.0 + 1e-9], [1.0, 0.0, 1.0]),
        ] {
            assert!(gap > 1e-3, "{gap:e}");
        }
    }
}
