//! Medians, spreads and percentiles of measured numbers.
//!
//! Times on a shared machine have a long tail to the slow side, so the middle
//! is the median and the spread the median absolute deviation: both stand
//! still until half of the samples are disturbed.

/// The median of some numbers, and their deviation from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The median.
    pub median: f64,
    /// The median of `|x - median|`, as it is (not scaled to the deviation of
    /// a normal distribution).
    pub deviation: f64,
}

impl Spread {
    /// The spread of at least one number.
    ///
    /// # Panics
    /// If there is none.
    #[must_use]
    pub fn of(numbers: &[f64]) -> Self {
        let middle = median(numbers);
        let distances: Vec<f64> = numbers.iter().map(|x| (x - middle).abs()).collect();
        Self {
            median: middle,
            deviation: median(&distances),
        }
    }
}

/// One time over another, round by round: a disturbance of a round slows both.
#[must_use]
pub fn ratios(seconds: &[f64], baseline: &[f64]) -> Vec<f64> {
    let pairs = seconds.iter().zip(baseline);
    pairs
        .map(|(seconds, baseline)| seconds / baseline)
        .collect()
}

/// The number in the middle, or between the two that are.
fn median(numbers: &[f64]) -> f64 {
    assert!(!numbers.is_empty(), "nothing has no median");
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    let half = sorted.len() / 2;
    if sorted.len() % 2 == 1 {
        sorted[half]
    } else {
        0.5 * (sorted[half - 1] + sorted[half])
    }
}

/// The 99th percentile; see [`percentile`].
#[must_use]
pub fn p99(numbers: Vec<f64>) -> Option<f64> {
    percentile(99, numbers)
}

/// The least of `numbers` that is not below a share of `percent` of them; `None`
/// when there are none. Infinities and NaN count as the greatest.
#[must_use]
pub fn percentile(percent: usize, mut numbers: Vec<f64>) -> Option<f64> {
    let rank = (numbers.len() * percent).div_ceil(100);
    numbers.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    numbers.get(rank.checked_sub(1)?).copied()
}

/// The power law `y = c n^k` nearest to some points.
///
/// As `log y = log c + k log n`, `k` is the slope of the line of least squares through the
/// logarithms, `Σ (x - mean x)(y - mean y) / Σ (x - mean x)²`. If the logarithms differ from a
/// line by independent errors of one variance, its standard error is
/// `√(Σ residual² / (points - 2) / Σ (x - mean x)²)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// The exponent `k`.
    pub exponent: f64,
    /// Its standard error; `None` for two points, which are always on a line.
    pub standard_error: Option<f64>,
}

impl PowerLaw {
    /// The power law of positive points `(n, y)`; `None` if they are not at two places at least.
    #[must_use]
    pub fn of(points: &[(f64, f64)]) -> Option<Self> {
        let logarithms = points.iter().map(|&(x, y)| (libm::log(x), libm::log(y)));
        let logarithms: Vec<(f64, f64)> = logarithms.collect();
        let count = logarithms.len() as f64;
        let mean_x = logarithms.iter().map(|(x, _)| x).sum::<f64>() / count;
        let mean_y = logarithms.iter().map(|(_, y)| y).sum::<f64>() / count;
        let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
            let terms = logarithms.iter();
            terms.map(|(x, y)| of(x - mean_x, y - mean_y)).sum()
        };
        let spread = sum(&|x, _| x * x);
        (spread > 0.0).then(|| {
            let exponent = sum(&|x, y| x * y) / spread;
            let residuals = sum(&|x, y| (y - exponent * x) * (y - exponent * x));
            let variance = (count > 2.0).then(|| residuals / (count - 2.0) / spread);
            Self {
                exponent,
                standard_error: variance.map(f64::sqrt),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_law_is_its_exponent() {
        for exponent in [1.0, 0.0, -0.25, 1.5] {
            let point = |n: f64| (n, 7.0 * libm::pow(n, exponent));
            let found = PowerLaw::of(&[1e3, 1e4, 1e5, 1e7].map(point)).unwrap();
            assert!((found.exponent - exponent).abs() < 1e-12, "{found:?}");
            assert!(found.standard_error.unwrap() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn power_law_is_that_of_least_squares() {
        // (0, 0), (1, 1), (2, 1) in logarithms: 1/2, with residuals -1/6, 1/3, -1/6.
        let e = libm::exp(1.0);
        let found = PowerLaw::of(&[(1.0, 1.0), (e, e), (e * e, e)]).unwrap();
        assert!((found.exponent - 0.5).abs() < 1e-12, "{found:?}");
        let error = (1.0_f64 / 6.0 / 2.0).sqrt();
        assert!(
            (found.standard_error.unwrap() - error).abs() < 1e-12,
            "{found:?}"
        );
        let two = PowerLaw::of(&[(1.0, 1.0), (e, e)]).unwrap();
        assert_eq!(two.standard_error, None);
    }

    #[test]
    fn power_law_of_one_place_is_none() {
        assert_eq!(PowerLaw::of(&[]), None);
        assert_eq!(PowerLaw::of(&[(10.0, 3.0)]), None);
    }

    #[test]
    fn spread_one_wild_sample_changes_nothing() {
        let calm = Spread::of(&[3.0, 1.0, 2.0, 5.0, 4.0]);
        let disturbed = Spread::of(&[3.0, 1.0, 2.0, 900.0, 4.0]);
        assert_eq!(calm.median, 3.0);
        assert_eq!(calm.deviation, 1.0);
        assert_eq!(calm, disturbed);
    }

    #[test]
    fn median_even_count_is_between_the_middle_two() {
        assert_eq!(Spread::of(&[4.0, 1.0, 2.0, 9.0]).median, 3.0);
    }

    #[test]
    fn p99_is_the_nearest_rank() {
        let numbers = |count: u32| (1..=count).rev().map(f64::from).collect();
        assert_eq!(p99(numbers(100)), Some(99.0));
        assert_eq!(p99(numbers(101)), Some(100.0));
        assert_eq!(p99(numbers(1)), Some(1.0));
        assert_eq!(p99(Vec::new()), None);
    }

    #[test]
    fn p99_more_than_a_hundredth_not_finite_is_not_finite() {
        let mut numbers = vec![1.0; 97];
        numbers.extend([f64::INFINITY; 3]);
        assert_eq!(p99(numbers), Some(f64::INFINITY));
        assert!(p99(vec![-f64::NAN; 3]).is_some_and(f64::is_nan));
    }
}
