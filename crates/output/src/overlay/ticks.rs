//! Round numbers in a range, and their text.

/// The step between round numbers, 1, 2 or 5 times a power of ten: the least for which a range
/// of this length has at most `most` steps.
fn step(length: f64, most: u32) -> (f64, i32) {
    let least = length / f64::from(most);
    let exponent = libm::floor(libm::log10(least)) as i32;
    // The logarithm may be off by a rounding.
    let steps = (exponent - 1..=exponent + 1)
        .flat_map(|exponent| [1.0, 2.0, 5.0].map(|digit| (digit, exponent)));
    let mut steps = steps.map(|(digit, exponent)| (digit * power_of_ten(exponent), exponent));
    let found = steps.find(|&(step, _)| step >= least * (1.0 - 1e-9));
    found.unwrap_or((length, exponent))
}

/// 10 to a power, the nearest f64.
pub(super) fn power_of_ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::INFINITY)
}

/// The text of a number greater than 0, with all its digits.
pub(super) fn number_text(number: f64) -> String {
    let text = match (1e-4..1e6).contains(&number) {
        true => format!("{number}"),
        false => format!("{number:e}"),
    };
    text.replace('-', "\u{2212}")
}

/// The round numbers from `first` to `last`, and their texts.
pub(super) fn ticks([first, last]: [f64; 2], most: u32) -> Vec<(f64, String)> {
    let (step, exponent) = step(last - first, most);
    let slack = 1e-9;
    let (from, to) = ((first / step - slack).ceil(), (last / step + slack).floor());
    // Beyond 2^53 neighboring multiples are not distinct.
    if !(to - from <= f64::from(2 * most)) {
        return Vec::new();
    }
    let multiples = (0..=(to - from) as u32).map(|index| from + f64::from(index));
    let greatest = first.abs().max(last.abs());
    let is_plain = greatest < 1e6 && exponent >= -4;
    let decimals = (-exponent).max(0) as usize;
    let ticks = multiples.map(|multiple| {
        let number = multiple * step;
        let text = match is_plain {
            _ if multiple == 0.0 => "0".to_owned(),
            true => format!("{number:.decimals$}"),
            false => scientific(number, exponent),
        };
        (number, text.replace('-', "\u{2212}"))
    });
    ticks.collect()
}

/// A number in the form 1.5e6, with the digits down to a power of ten.
fn scientific(number: f64, exponent: i32) -> String {
    let own = libm::floor(libm::log10(number.abs()) + 1e-9) as i32;
    let decimals = (own - exponent).clamp(0, 15) as usize;
    format!("{number:.decimals$e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(ends: [f64; 2]) -> Vec<String> {
        ticks(ends, 5).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        assert_eq!(texts([0.0, 7.0]), ["0", "2", "4", "6"]);
        assert_eq!(texts([0.0, 812.4]), ["0", "200", "400", "600", "800"]);
        assert_eq!(texts([-1.0, 1.0]), ["−1.0", "−0.5", "0", "0.5", "1.0"]);
        assert_eq!(
            texts([0.1, 0.35]),
            ["0.10", "0.15", "0.20", "0.25", "0.30", "0.35"]
        );
        assert_eq!(texts([0.0, 3e7]), ["0", "1e7", "2e7", "3e7"]);
        assert_eq!(
            texts([1.5e6, 2e6]),
            ["1.5e6", "1.6e6", "1.7e6", "1.8e6", "1.9e6", "2.0e6"]
        );
        // The digits go down to the step.
        assert_eq!(
            texts([0.0, 1e-6]),
            ["0", "2e−7", "4e−7", "6e−7", "8e−7", "1.0e−6"]
        );
    }

    #[test]
    fn ranges_of_any_size_have_a_few_ticks_within() {
        for exponent in -300..300 {
            for digit in [1.0, 1.7, 3.3, 9.99] {
                let length = digit * power_of_ten(exponent);
                for first in [0.0, -0.3 * length, 5.0 * length] {
                    let all = ticks([first, first + length], 5);
                    assert!((2..=6).contains(&all.len()), "{first} {length}: {all:?}");
                    for (number, _) in all {
                        let beyond = (first - number).max(number - first - length);
                        assert!(beyond < 1e-8 * length, "{first} {length} {number}");
                    }
                }
            }
        }
    }
}
