//! How the values of a tile's pixels spread: the error and the decision of `until_error`, whose
//! header derives both.

/// Mean below which the error of a tile is no longer relative to it: 1 % of white. Black tiles
/// would never be done.
pub(super) const DARK: f64 = 0.01;

/// The one-sided quantile of 95 % of a normal variable, over √2.
const QUANTILE: f64 = 1.644_853_626_951_472_7 * std::f64::consts::FRAC_1_SQRT_2;

/// How the values of some pixels spread.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spread {
    pub pixels: f64,
    /// The sum of the pixels' values, each the mean of its color's components.
    pub values: f64,
    /// The sum of the estimated variances `v`.
    pub variances: f64,
    /// The sum of `v²`.
    pub squares: f64,
}

impl Spread {
    pub fn and(self, other: Self) -> Self {
        Self {
            pixels: self.pixels + other.pixels,
            values: self.values + other.values,
            variances: self.variances + other.variances,
            squares: self.squares + other.squares,
        }
    }

    /// What errors are relative to.
    fn scale(&self) -> f64 {
        (self.values / self.pixels).max(DARK)
    }

    /// The relative error.
    pub fn error(&self) -> f64 {
        (self.variances / self.pixels).sqrt() / self.scale()
    }

    /// The squared error that is not exceeded with the probability of the promise, over that of
    /// `target`.
    pub fn excess(&self, target: f64) -> f64 {
        let limit = target * self.scale();
        let greatest = self.variances + QUANTILE * (4.0 / 3.0 * self.squares).sqrt();
        greatest / (limit * limit * self.pixels)
    }

    /// Whether the error is at most `target` with the probability of the promise. Without
    /// pixels nothing is decided, and no noise is enough for any target.
    pub fn is_within(&self, target: f64) -> bool {
        self.pixels > 0.0 && (self.variances == 0.0 || self.excess(target) <= 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_of_no_pixels_or_black_ones_says_nothing_or_enough() {
        assert!(!Spread::default().is_within(1e9));
        let black = Spread {
            pixels: 128.0,
            ..Spread::default()
        };
        assert!(black.is_within(1e-9));
        assert_eq!(black.error(), 0.0);
    }

    /// 100 pixels of value 2 with the variance 0.01 each have an error of 5 %; the promise needs
    /// `1 + 1.163 √(4/3 · 100)/100` times the variance.
    #[test]
    fn error_is_relative_and_the_promise_has_a_margin() {
        let spread = Spread {
            pixels: 100.0,
            values: 200.0,
            variances: 1.0,
            squares: 0.01,
        };
        assert!((spread.error() - 0.05).abs() < 1e-15);
        let needed = 0.05 * (1.0 + 1.163_087 * (4.0_f64 / 3.0).sqrt() * 0.1).sqrt();
        assert!(!spread.is_within(needed * 0.9999) && spread.is_within(needed * 1.0001));
    }
}
