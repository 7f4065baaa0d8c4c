//! How the values of a tile's pixels spread, and how many samples an error needs.
//!
//! `until_error` defines the variances `v` and the halves of a tile.
//!
//! # The promise
//! A tile stops where the error is small enough with a probability of about 95 %. With `S` the
//! sum of `v` over the pixels of a half, normal `a` and `b` make each `v` its variance `σ²`
//! times a chi-squared variable of one degree of freedom, so that `E v² = 3 σ⁴`. The squared
//! error that the half will have varies by `2 Σ σ⁴`, `S` itself by as much, together by
//! `4/3 Σ v²`. Of a tile of two such halves the relative deviation is `1/√2` of that:
//! `δ = √(2/3 Σ v²)/S`. What matters is the ratio of the error to its estimate, whose logarithm
//! varies by about `δ²`. So a half stops where `B = S exp(1.645 δ)` is at most the target's. The
//! components of a color are taken as one value, since they vary together.
//!
//! That holds for many pixels of similar variance. Where the noise is in a few pixels, the promise is
//! kept less often. That there are several decisions, and that `p` below is an estimate, is not in the
//! derivation: `docs/performance.md` has how often the promise was kept.
//!
//! # The number of samples
//! The spread is estimated at 4 samples of a sequence and at greater powers of two. If it falls from
//! 4 to `c` samples as `m^-p`, `m` samples have the variance `v(m) = (c/m)^p v(c)`. Here `p` is at
//! least 1, as for independent samples.
//!
//! Up to `2c`, the samples are an aligned block of `c` and blocks of `c/2`, `c/4`, `c/8` and `c/16`,
//! each at most once. An aligned block of a scrambled sequence is scrambled like the first block of
//! its length, so that its mean has the variance `v(m)`. Two neighbouring blocks of `m` are a block
//! of `2m`: `v(2m) = (v(m) + k)/2`, where `k = -q v(m)` with the anticorrelation `q = 1 - 2^(1-p)` is
//! the covariance of their means. It is there because a sample of the second block is in the box of one of the first, in the
//! other half of the box. So the covariance of the sums is in proportion to the samples of the
//! second block, and that of the means remains `k` if the second is shorter. So `n = Σ m` samples in
//! blocks of `m` have the variance
//!
//! `v(n) = Σ m v(m) (m - 2 r q)/n²`,
//!
//! where `r` is the number of samples in shorter blocks than `m`. For independent samples that is
//! `c v(c)/n`. (Of a wave that repeats in the pixel the variance was up to 1.3 times that, of a
//! smooth surface with an edge up to 1.2 times; see the test.) A half stops at the first of `n = c`, `17/16 c`, `18/16 c` and so on up to `31/16 c`
//! for which `B v(n)/v(c)` is small enough. If it is for none, a greater power of two decides: the
//! last that is likely to be needed ([`SpreadHistory::next`]). So most steps have many samples of a
//! pixel, whose rays share more.

/// The greatest exponent `p` for which numbers of samples between powers of two are considered. A
/// smooth picture has greater ones, and is little better there than at the power of two below.
const GREATEST_EXPONENT: f64 = 2.0;

/// Samples of a sequence where the spread is first estimated. Fewer would decide by luck.
const FIRST: u32 = 4;

/// How fast the squared error is taken to fall, `N^(-1/FALL)`. It falls as `N^-1` or faster; less
/// is expected of more samples than they do, so that few tiles take more than they need.
const FALL: f64 = 0.8;

/// Most growth of a number of samples between two estimates: the first ones are rough.
const MOST_GROWTH: f64 = 8.0;

/// Mean below which the error of a tile is no longer relative to it: 1 % of white. Black tiles
/// would never be done.
pub(super) const DARK: f64 = 0.01;

/// The one-sided quantile of 95 % of a normal variable.
const QUANTILE: f64 = 1.644_853_626_951_472_7;

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

    /// The sum of squared errors that is not exceeded with the probability of the promise, `B`.
    fn greatest(&self) -> f64 {
        if self.variances == 0.0 {
            return 0.0;
        }
        let deviation = (2.0 / 3.0 * self.squares).sqrt() / self.variances;
        self.variances * libm::exp(QUANTILE * deviation)
    }

    /// The greatest sum of squared errors for a relative error.
    fn permitted(&self, error: f64) -> f64 {
        let limit = error * self.scale();
        limit * limit * self.pixels
    }
}

/// How the values of a half spread at some numbers of samples of a sequence: powers of two, from
/// [`FIRST`] on.
#[derive(Clone, Debug, Default)]
pub(super) struct SpreadHistory(Vec<(u32, Spread)>);

impl SpreadHistory {
    /// The bytes of the estimates for up to 2^18 samples of a pixel, 2^17 of each sequence.
    pub const MOST_BYTES: usize = 16 * size_of::<(u32, Spread)>();

    /// Adds what was estimated at more samples than before.
    pub fn push(&mut self, samples: u32, spread: Spread) {
        self.0.push((samples, spread));
    }

    /// The number of samples at which the spread should be estimated next.
    pub fn next(&self, error: f64) -> u32 {
        let Some((samples, spread)) = self.0.last() else {
            return FIRST;
        };
        let excess = spread.greatest() / spread.permitted(error);
        let growth = libm::pow(excess, FALL).min(MOST_GROWTH);
        let expected = (f64::from(*samples) * growth) as u32;
        let power = expected.checked_ilog2().map_or(0, |exponent| 1 << exponent);
        power.max(samples.saturating_mul(2))
    }

    /// The number of samples that an error needs. `None` if that is at least twice the last number
    /// where the spread was estimated, or is unknown: from one estimate, from a fall faster than
    /// [`GREATEST_EXPONENT`], or without pixels.
    pub fn enough(&self, error: f64) -> Option<u32> {
        let (taken, last) = self.0.last().filter(|(_, spread)| spread.pixels > 0.0)?;
        let (greatest, permitted) = (last.greatest(), last.permitted(error));
        if greatest <= permitted {
            return Some(*taken);
        }
        let exponent = self
            .exponent()
            .filter(|&exponent| exponent <= GREATEST_EXPONENT)?;
        let more = (17..32).filter(|sixteenths| u64::from(*taken) * sixteenths % 16 == 0);
        let mut enough =
            more.filter(|&number| greatest * fall(exponent, number as u32) <= permitted);
        let number = enough.next()? * u64::from(*taken) / 16;
        u32::try_from(number).ok()
    }

    /// The exponent `p` of the fall of the variance; `None` from one estimate.
    fn exponent(&self) -> Option<f64> {
        let [(few, first), .., (many, last)] = &self.0[..] else {
            return None;
        };
        let fall = libm::log2(first.variances / last.variances);
        Some((fall / f64::from((many / few).ilog2())).max(1.0))
    }
}

/// The variance of some sixteenths of `c` samples, 16 to 31, over that of `c`: `v(n)/v(c)`.
fn fall(exponent: f64, sixteenths: u32) -> f64 {
    let anticorrelation = 1.0 - libm::exp2(1.0 - exponent);
    let mut rest = sixteenths;
    let mut sum = 0.0;
    for shorter in 0..5_u8 {
        let block = 16 >> shorter;
        if sixteenths & block != 0 {
            rest -= block;
            let variance = libm::exp2(exponent * f64::from(shorter));
            sum += f64::from(block)
                * variance
                * (f64::from(block) - 2.0 * f64::from(rest) * anticorrelation);
        }
    }
    sum / f64::from(sixteenths * sixteenths)
}

#[cfg(test)]
mod tests {
    use cyltrace::scene::Sampler;

    use super::*;
    use crate::sampler::PixelSampler;

    /// 100 pixels of the value 2 whose variances have this sum.
    fn spread(variances: f64) -> Spread {
        Spread {
            pixels: 100.0,
            values: 200.0,
            variances,
            squares: variances * variances / 100.0,
        }
    }

    /// Spreads at 4 samples, 8 and so on, whose variances have these sums.
    fn spreads(variances: &[f64]) -> SpreadHistory {
        let numbers = (0..).map(|exponent| FIRST << exponent);
        SpreadHistory(
            numbers
                .zip(variances.iter().map(|&sum| spread(sum)))
                .collect(),
        )
    }

    /// The error for which a sum of variances is just small enough.
    fn error_of(variances: f64) -> f64 {
        let spread = spread(variances);
        (spread.greatest() / spread.permitted(1.0)).sqrt()
    }

    #[test]
    fn spread_of_no_pixels_or_black_ones_says_nothing_or_enough() {
        let of = |spread| SpreadHistory(vec![(FIRST, spread)]).enough(0.0);
        assert_eq!(of(Spread::default()), None);
        assert_eq!(SpreadHistory::default().enough(1e9), None);
        let black = Spread {
            pixels: 128.0,
            ..Spread::default()
        };
        assert_eq!(of(black), Some(4));
        assert_eq!(black.error(), 0.0);
    }

    /// A variance of 0.01 for each pixel is an error of 5 %; the promise needs
    /// `exp(1.645 √(2/3)/10)` times the variance.
    #[test]
    fn error_is_relative_and_the_promise_has_a_margin() {
        assert!((spread(1.0).error() - 0.05).abs() < 1e-15);
        let needed = 0.05 * libm::exp(0.5 * 1.644_854 * (2.0_f64 / 3.0).sqrt() * 0.1);
        assert!((error_of(1.0) / needed - 1.0).abs() < 1e-6, "{needed}");
        assert_eq!(spreads(&[1.0]).enough(needed * 0.9999), None);
        assert_eq!(spreads(&[1.0]).enough(needed * 1.0001), Some(4));
    }

    #[test]
    fn number_of_samples_follows_from_the_fall_of_the_spread() {
        // The variance halves with twice the samples: 64 samples, 68 and so on.
        let halving = spreads(&[64.0, 32.0, 16.0, 8.0, 4.0]);
        for sixteenths in 16..32 {
            let needed = 4.0 * 16.0 / f64::from(sixteenths);
            let enough = halving.enough(error_of(needed * 1.0001));
            assert_eq!(enough, Some(64 * sixteenths / 16));
        }
        assert_eq!(halving.enough(error_of(2.0)), None);
        let few = SpreadHistory(vec![(4, spread(64.0)), (64, spread(4.0))]);
        assert_eq!(few.enough(error_of(2.5)), halving.enough(error_of(2.5)));
        // It is divided by four, with p = 2: a block of 32 samples has the variance 16, and the
        // covariance with the block of 64 is -2.
        let quartering = spreads(&[1024.0, 256.0, 64.0, 16.0, 4.0]);
        let limit =
            (64.0 * 64.0 * 4.0 + 32.0 * 32.0 * 16.0 - 2.0 * 64.0 * 32.0 * 2.0) / (96.0 * 96.0);
        assert_eq!(quartering.enough(error_of(limit * 0.999)), Some(112));
        assert_eq!(quartering.enough(error_of(limit * 1.001)), Some(96));
        // It falls even faster: only powers of two are worth it.
        let smooth = spreads(&[9000.0, 1000.0, 100.0, 10.0, 1.0]);
        assert_eq!(smooth.enough(error_of(0.99)), None);
        // By chance it falls more slowly than that of independent samples: 8 samples to 12.
        assert_eq!(spreads(&[4.0, 3.9]).enough(error_of(2.61)), Some(12));
        // One estimate does not show how the variance falls.
        assert_eq!(spreads(&[4.0]).enough(error_of(3.9)), None);
        assert_eq!(spreads(&[4.0, 2.0]).enough(error_of(1.7)), Some(10));
    }

    #[test]
    fn spread_is_estimated_at_powers_of_two_below_what_is_expected() {
        assert_eq!(SpreadHistory::default().next(0.1), FIRST);
        let next = |excess: f64| spreads(&[4.0 * excess]).next(error_of(4.0));
        // 4 e^0.8 for an excess of e, down to a power of two: 16 from 4^1.25, 5.66, on.
        assert_eq!(
            [1.5, 5.6, 5.7, 13.0, 14.0, 1e9].map(next),
            [8, 8, 16, 16, 32, 32]
        );
        assert_eq!(next(f64::INFINITY), 32);
        assert_eq!(spreads(&[0.0]).next(0.0), 32);
    }

    /// The variance of means of scrambled sequences against what is expected from 4 and 32 samples.
    #[test]
    fn variance_of_a_scrambled_sequence_is_as_expected() {
        type Function = fn((f64, f64)) -> f64;
        const WAVE: usize = 3;
        let functions: [Function; 5] = [
            |(x, y)| x * y + 0.2 * f64::from(u8::from(x + 0.7 * y < 0.9)),
            |(x, y)| f64::from(u8::from(x + 0.3 * y < 0.6)),
            |(x, y)| f64::from(u8::from(x * x + y * y < 1.0)),
            |(x, y)| libm::sin(40.0 * x) * libm::cos(30.0 * y),
            |(x, y)| f64::from(u8::from((9.0 * x) as u32 % 2 == (7.0 * y) as u32 % 3)),
        ];
        for (number, function) in functions.into_iter().enumerate() {
            let pixels = 4000;
            let variance = |count: u32| {
                let means: Vec<f64> = (0..pixels)
                    .map(|pixel| {
                        let sampler = PixelSampler::new(Sampler::Sobol, 5, pixel);
                        let points = (0..count).map(|sample| sampler.place(sample));
                        points.map(function).sum::<f64>() / f64::from(count)
                    })
                    .collect();
                let mean = means.iter().sum::<f64>() / pixels as f64;
                let squares = means.iter().map(|one| (one - mean) * (one - mean));
                squares.sum::<f64>() / pixels as f64
            };
            let (few, many) = (variance(4), variance(32));
            let measured = SpreadHistory(vec![(4, spread(few)), (32, spread(many))]);
            let exponent = measured.exponent().expect("two estimates");
            assert!(exponent <= GREATEST_EXPONENT, "function {number}");
            for sixteenths in (18..32_u32).step_by(2) {
                // A variance of 4000 values varies by some 3 %.
                let ratio = variance(2 * sixteenths) / (many * fall(exponent, sixteenths));
                let limit = if number == WAVE { 1.4 } else { 1.25 };
                assert!(
                    (0.7..limit).contains(&ratio),
                    "function {number}, p = {exponent:.2}, {sixteenths} sixteenths: {ratio:.3}"
                );
            }
        }
    }
}
