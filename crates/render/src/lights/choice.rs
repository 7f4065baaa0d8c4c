//! Chooses one of many lights.
//!
//! Half of the choices are in proportion to the power, and half are equal among the lights that
//! have any: a lamp in a wide scene has a tiny part of the sun's power and may be all the light
//! in a room.

/// Cumulative probabilities of a list.
#[derive(Clone, Debug, Default)]
pub(super) struct Choice {
    /// The sum of the probabilities up to and including each; the last is 1.
    sums: Vec<f64>,
}

impl Choice {
    /// The probabilities of lights of these powers, which are 0 or greater. Equal ones if all
    /// are 0.
    pub fn new(powers: &[f64]) -> Self {
        let total: f64 = powers.iter().sum();
        let shining = powers.iter().filter(|&&power| power > 0.0).count() as f64;
        let mut sum = 0.0;
        let probability = |power: f64| match (total > 0.0, power > 0.0) {
            (true, true) => 0.5 * (power / total + 1.0 / shining),
            (true, false) => 0.0,
            (false, _) => 1.0 / powers.len() as f64,
        };
        let mut sums: Vec<f64> = powers
            .iter()
            .map(|&power| {
                sum += probability(power);
                sum
            })
            .collect();
        if let Some(last) = sums.last_mut() {
            *last = 1.0;
        }
        Self { sums }
    }

    /// The position for a number in [0, 1), and its probability.
    pub fn choose(&self, number: f64) -> (usize, f64) {
        if self.sums.len() == 1 {
            return (0, 1.0);
        }
        let position = self.sums.partition_point(|&sum| sum <= number);
        let position = position.min(self.sums.len() - 1);
        (position, self.probability(position))
    }

    /// The probability of a position.
    pub fn probability(&self, position: usize) -> f64 {
        let before = if position == 0 {
            0.0
        } else {
            self.sums[position - 1]
        };
        self.sums[position] - before
    }

    pub fn is_empty(&self) -> bool {
        self.sums.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_chosen_by_their_powers_and_their_number() {
        let choice = Choice::new(&[1.0, 0.0, 3.0, 4.0]);
        let mut counts = [0; 4];
        for number in 0..8000 {
            let (position, probability) = choice.choose(f64::from(number) / 8000.0);
            assert_eq!(probability, choice.probability(position));
            counts[position] += 1;
        }
        // A sixth for each of the three, and half of an eighth, three eighths and a half.
        assert_eq!(counts, [1834, 0, 2833, 3333]);
        assert_eq!(Choice::new(&[0.0, 0.0]).probability(1), 0.5);
    }
}
