//! Quantiles of errors that span many powers of ten, in little memory.
//!
//! Numbers are counted in bins of equal width in their leading 12 bits, so a
//! quantile is known to 2^-12 of itself. It is given as the upper end of its
//! bin, so that an error is never understated, and never beyond the greatest
//! number, which is kept exactly. Counts add, so that the order in which
//! numbers come does not show.

use std::collections::HashMap;

/// Bits of an f64 below its sign, its exponent and the 12 bits that count.
const DROPPED_BITS: u32 = 40;

/// Counts of numbers that are not negative.
#[derive(Clone, Debug, Default)]
pub struct Quantiles {
    bins: HashMap<u32, u64>,
    count: u64,
    greatest: f64,
}

impl Quantiles {
    /// Counts the size of `x`, which is not NaN.
    pub fn push(&mut self, x: f64) {
        let x = x.abs();
        *self
            .bins
            .entry((x.to_bits() >> DROPPED_BITS) as u32)
            .or_insert(0) += 1;
        self.count += 1;
        self.greatest = self.greatest.max(x);
    }

    /// Counts all that `other` counted.
    pub fn merge(&mut self, other: Self) {
        for (bin, count) in other.bins {
            *self.bins.entry(bin).or_insert(0) += count;
        }
        self.count += other.count;
        self.greatest = self.greatest.max(other.greatest);
    }

    /// How many numbers were counted.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The greatest number; 0 if there was none.
    #[must_use]
    pub fn greatest(&self) -> f64 {
        self.greatest
    }

    /// Bounds the numbers but a share `1 - share` of them; 0 if there were
    /// none. `share` is in [0, 1].
    #[must_use]
    pub fn at(&self, share: f64) -> f64 {
        let mut bins: Vec<(u32, u64)> = self
            .bins
            .iter()
            .map(|(&bin, &count)| (bin, count))
            .collect();
        bins.sort_unstable();
        let wanted = share * self.count as f64;
        let mut seen = 0;
        for (bin, count) in bins {
            seen += count;
            if seen as f64 >= wanted {
                let above = f64::from_bits((u64::from(bin) + 1) << DROPPED_BITS);
                return above.min(self.greatest);
            }
        }
        self.greatest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_known_numbers_are_close_and_not_below() {
        let (mut odd, mut even) = (Quantiles::default(), Quantiles::default());
        for i in 1..=1000 {
            if i % 2 == 0 { &mut even } else { &mut odd }.push(f64::from(-i) * 1e-3);
        }
        odd.merge(even);
        assert_eq!((odd.count(), odd.greatest()), (1000, 1.0));
        for (share, expected) in [(0.5, 0.5), (0.99, 0.99), (0.999, 0.999), (1.0, 1.0)] {
            let found = odd.at(share);
            assert!(
                (expected..=expected * 1.0003).contains(&found),
                "{share}: {found}"
            );
        }
        assert_eq!(Quantiles::default().at(0.5), 0.0);
    }
}
