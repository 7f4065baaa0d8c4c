//! The certificate that the f64 solver is right.
//!
//! The quantities of `triple_product` and their error bounds, with u = 2^-53, `A = |a|`,
//! `X = |x|`, `K = |a| |d|`, `N = |n|`. `a` and `x` are rounded differences, with a relative
//! error of u each:
//!
//! | quantity | bound | from |
//! |---|---|---|
//! | `n` | `5 u K` | two products and a difference a component, `2√2 + 1`, and a |
//! | `\|n\|²` | `13 u K N'`, `N' = N + 5 u K` | `2 N · 5 u K`, three roundings |
//! | `w = x·n` | `9 u X K` | `X · 5 u K`, x, three roundings |
//! | `D` | `u (20 r² K N' + 21 X K \|w\|) + (10 u X K)²` | `r² \|n\|²`, `w²` and their roundings |
//! | `m` | `6 u A X` | as n, and x |
//! | `m·n` | `14 u A X K` | `6 + 5 + 3` |
//! | `s = A √D` | `s (0.54 E_D / D + 6 u)` for `D > 4 E_D` | root of a sum |
//! | `C = \|m\|² - r² A²` | `17 u A² X² + 8 u r² A²` | `2 A X · 6 u A X`, roundings |
//! | `x·a`, `d·a`, `a·a` | `5 u A X`, `4 u K`, `5 u A²` | products, sums, a and x |
//!
//! A quotient `p / q` with `E_q <= |q| / 4` is off by at most
//! `4/3 (E_p + |p/q| E_q) / |q| + u |p/q|`. The factor [`MARGIN`] covers the roundings of the
//! bounds themselves.
//!
//! The bounds are written for speed, as they are computed for every ray: the sums of the
//! components' sizes replace the lengths of `x` and `d`. They are at most √3 times as long and
//! take no root.

use super::ExactHit;
use super::decide::At;
use crate::math::{Ray, UNIT_ROUNDOFF as U};
use crate::solid::linear::sum_of_sizes;
use crate::solid::slab::Slab;
use crate::solid::triple_product::{self, Axis, Line, Quotient, Root, Roots, StatedAxis};
use crate::solid::{Crossing, Cylinder, Part};

/// Room for the roundings of the bounds, some 30 operations of positive numbers each: 1 + 2^-40
/// would suffice.
const MARGIN: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// A number and its error bound.
#[derive(Clone, Copy)]
struct Near {
    value: f64,
    error: f64,
}

impl Near {
    /// Whether the number is certainly above the limit.
    #[inline(always)]
    fn above(&self, limit: f64) -> bool {
        self.value - self.error * MARGIN > limit
    }

    /// Whether the number is certainly below the limit.
    #[inline(always)]
    fn below(&self, limit: f64) -> bool {
        self.value + self.error * MARGIN < limit
    }

    /// The quotient by a number that is certainly not zero.
    #[inline(always)]
    fn over(&self, denominator: Self) -> Option<Self> {
        let size = denominator.value.abs();
        let value = self.value / denominator.value;
        let factor = (4.0 / 3.0) / size;
        (denominator.error * MARGIN <= 0.25 * size).then(|| Self {
            value,
            error: factor * (self.error + value.abs() * denominator.error) + U * value.abs(),
        })
    }
}

/// The intersections of a line with the wall and the disks' planes, with error bounds.
struct Certifier<'a> {
    cylinder: &'a Cylinder,
    ray: &'a Ray,
    roots: Roots<f64, StatedAxis<f64>>,
    slab: Slab<f64>,
    nn: Near,
    /// The error bound of a sum `-(m·n) ∓ s`.
    sum_error: f64,
    /// The error bound of the constant term.
    constant_error: f64,
    /// The error bound of `x·a` and of the roundings of a height, apart from `t` and the slope.
    position_error: f64,
    /// The error bound of `d·a`.
    slope_error: f64,
}

/// The position of a height relative to the disks, in the ray's direction.
#[derive(Clone, Copy, PartialEq)]
enum Height {
    Before,
    Inside,
    Beyond,
}

/// The exact result, if the numbers of the f64 solver prove it.
#[inline(always)]
pub(super) fn first(cylinder: &Cylinder, ray: &Ray) -> Option<Option<ExactHit>> {
    let (x, d) = (ray.origin - cylinder.p0(), ray.direction);
    let axis = StatedAxis::of(cylinder);
    let line = Line::new(&axis, x, d);

    let rr = axis.radius * axis.radius;
    let (aa, a_size) = (axis.aa(), axis.length());
    let x_size = sum_of_sizes(x);
    let k = a_size * sum_of_sizes(d);
    let n_size = line.nn.sqrt() + 5.0 * U * k;
    let off = 10.0 * U * x_size * k;
    let discriminant = Near {
        value: line.discriminant,
        error: U * k * (20.0 * rr * n_size + 21.0 * x_size * line.w.abs()) + off * off,
    };
    if discriminant.below(0.0) {
        return Some(None);
    }
    if line.is_parallel() || !(discriminant.value > 4.0 * discriminant.error * MARGIN) {
        return None;
    }

    let roots = Roots::new(&axis, x, d, &line);
    let s_error = roots.s * (0.54 * discriminant.error / discriminant.value + 6.0 * U);
    let slab = triple_product::slab(&axis, x, d);
    Certifier {
        cylinder,
        ray,
        nn: Near {
            value: line.nn,
            error: 13.0 * U * k * n_size,
        },
        sum_error: 14.0 * U * a_size * x_size * k + s_error + U * (roots.mn.abs() + roots.s),
        constant_error: U * aa * (17.0 * x_size * x_size + 8.0 * rr),
        position_error: U * (8.0 * a_size * x_size + 6.0 * aa),
        slope_error: 4.0 * U * k,
        roots,
        slab,
    }
    .first()
}

impl Certifier<'_> {
    /// The first end that is on the surface and in range.
    #[inline(always)]
    fn first(&self) -> Option<Option<ExactHit>> {
        let enter = self.root(Root::First)?;
        match self.height(enter)? {
            Height::Beyond => Some(None),
            Height::Inside => {
                if let Some(answer) = self.hit(enter, At::FirstRoot, Part::Side, Crossing::Enter)? {
                    return Some(Some(answer));
                }
                self.leave(self.root(Root::Second)?, enter)
            }
            Height::Before => {
                let leave = self.root(Root::Second)?;
                if self.height(leave)? == Height::Before {
                    return Some(None);
                }
                let (plane, at, part) = self.disk(self.is_forward())?;
                if let Some(answer) = self.hit(plane, at, part, Crossing::Enter)? {
                    return Some(Some(answer));
                }
                self.leave(leave, plane)
            }
        }
    }

    /// The end at which the line leaves, if it is on the surface and in range.
    #[inline]
    fn leave(&self, root: Near, enter: Near) -> Option<Option<ExactHit>> {
        let (t, at, part) = match self.height(root)? {
            Height::Before => return None,
            Height::Inside => (root, At::SecondRoot, Part::Side),
            Height::Beyond => self.disk(!self.is_forward())?,
        };
        // The solver reorders ends that rounding has swapped.
        let t = Near {
            value: t.value.max(enter.value),
            error: t.error + (enter.value - t.value).max(0.0),
        };
        self.hit(t, at, part, Crossing::Leave)
    }

    /// Whether the line passes the plane of the disk at `p0` first.
    #[inline(always)]
    fn is_forward(&self) -> bool {
        self.slab.slope > 0.0
    }

    #[inline(always)]
    fn root(&self, root: Root) -> Option<Near> {
        let Quotient {
            numerator,
            denominator,
            is_indirect,
        } = self.roots.quotient(root);
        if is_indirect {
            let constant = Near {
                value: numerator,
                error: self.constant_error,
            };
            return constant.over(Near {
                value: denominator,
                error: self.sum_error,
            });
        }
        let sum = Near {
            value: numerator,
            error: self.sum_error,
        };
        sum.over(self.nn)
    }

    /// The position of the line at a root. A height outside of the slab is certain only if the
    /// sign of `d·a` is: it selects the disk.
    #[inline(always)]
    fn height(&self, t: Near) -> Option<Height> {
        let Slab {
            height,
            position,
            slope,
        } = self.slab;
        let size = t.value.abs();
        let y = Near {
            value: position + t.value * slope,
            error: self.position_error
                + size * self.slope_error
                + slope.abs() * (t.error + 3.0 * U * size),
        };
        let (below, above) = (y.below(0.0), y.above(height));
        if below | above {
            if !(slope.abs() > 4.0 * self.slope_error * MARGIN) {
                return None;
            }
            let is_before = below == self.is_forward();
            return Some(if is_before {
                Height::Before
            } else {
                Height::Beyond
            });
        }
        (y.above(0.0) & y.below(height)).then_some(Height::Inside)
    }

    /// The parameter at which the line intersects the plane of the disk at `p0` or at `p1`.
    #[inline]
    fn disk(&self, at_p0: bool) -> Option<(Near, At, Part)> {
        let (plane, at, part) = if at_p0 {
            (0.0, At::Plane0, Part::Cap0)
        } else {
            (self.slab.height, At::Plane1, Part::Cap1)
        };
        let distance = Near {
            value: plane - self.slab.position,
            error: self.position_error,
        };
        let slope = Near {
            value: self.slab.slope,
            error: self.slope_error,
        };
        Some((distance.over(slope)?, at, part))
    }

    /// The end as a hit, if the surface exists there and `t` is in range.
    #[inline(always)]
    fn hit(&self, t: Near, at: At, part: Part, crossing: Crossing) -> Option<Option<ExactHit>> {
        let caps = self.cylinder.caps();
        let is_there = match part {
            Part::Side => true,
            Part::Cap0 => caps.at_p0(),
            Part::Cap1 => caps.at_p1(),
            part => part.not_of_a_cylinder(),
        };
        if !is_there | t.below(self.ray.t_min) | t.above(self.ray.t_max) {
            return Some(None);
        }
        (t.above(self.ray.t_min) & t.below(self.ray.t_max)).then_some(Some(ExactHit {
            // A zero is positive, as from exact numbers.
            t: t.value + 0.0,
            t_error: t.error * MARGIN,
            part,
            crossing,
            at,
        }))
    }
}
