//! The roots of a line and the wall of a cone, (4) of `wall.rs`.

/// The interval of `t` in which a line is inside the wall. Either end may be infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::solid) struct Inside {
    /// Where the line enters.
    pub enter: f64,
    /// Where the line leaves.
    pub leave: f64,
}

/// The terms of the roots of (2).
#[derive(Clone, Copy, Debug)]
pub(super) struct Roots {
    /// `A`.
    pub a: f64,
    /// `B`.
    pub b: f64,
    /// `|a|² √(E/β)`.
    pub s: f64,
}

impl Roots {
    /// From `A`, `B` and `E`, and from `|a|²` and `β`.
    #[inline(always)]
    pub fn new([a, b, e]: [f64; 3], aa: f64, beta: f64) -> Self {
        let s = aa * (e / beta).sqrt();
        Self { a, b, s }
    }

    /// The numerators of (4).
    #[inline(always)]
    pub fn sums(&self) -> [f64; 2] {
        [-self.b - self.s, self.s - self.b]
    }

    /// `q`, the numerator whose terms do not cancel.
    #[inline(always)]
    pub fn noncancelling(&self) -> f64 {
        let [minus, plus] = self.sums();
        if self.b < 0.0 { plus } else { minus }
    }

    /// Whether the terms of a numerator cancel.
    #[inline(always)]
    pub fn cancels(&self, sum: f64) -> bool {
        sum.abs() < 0.5 * self.b.abs()
    }

    /// The interval between the roots, on the solid's nappe. `rises` is whether that nappe
    /// extends in the line's direction, for a line that is less steep than the wall.
    /// `constant_term` is called if terms cancel.
    #[inline(always)]
    pub fn inside(&self, rises: bool, constant_term: impl Fn() -> f64) -> Inside {
        let root = |sum: f64| {
            let (numerator, denominator) = if self.cancels(sum) {
                (constant_term(), self.noncancelling())
            } else {
                (sum, self.a)
            };
            numerator / denominator
        };
        let [minus, plus] = self.sums();
        let is_half = !(self.a > 0.0);
        Inside {
            enter: if is_half & !rises {
                f64::NEG_INFINITY
            } else {
                root(minus)
            },
            leave: if is_half & rises {
                f64::INFINITY
            } else {
                root(plus)
            },
        }
    }
}
