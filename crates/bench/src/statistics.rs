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

/// The least of `numbers` that is not below a share of 99 % of them; `None`
/// when there are none. Infinities and NaN count as the greatest.
#[must_use]
pub fn p99(mut numbers: Vec<f64>) -> Option<f64> {
    let rank = (numbers.len() * 99).div_ceil(100);
    numbers.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    numbers.get(rank.checked_sub(1)?).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

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
