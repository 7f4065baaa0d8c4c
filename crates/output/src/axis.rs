//! The logarithmic axes of a figure: the pixels of values, and the numbers with a line.

/// A logarithmic axis.
pub struct Axis {
    /// The decimal logarithms at its ends.
    pub low: f64,
    pub high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// From the decimal logarithm `low` at pixel `from` to `high` at `to`.
    pub fn new((low, high): (f64, f64), from: f64, to: f64) -> Self {
        Self {
            low,
            high,
            from,
            to,
        }
    }

    /// The pixel of a value; the nearer edge for one beyond the axis, the far
    /// one for NaN.
    pub fn pixel(&self, value: f64) -> f64 {
        let logarithm = if value.is_nan() {
            self.high
        } else {
            libm::log10(value).clamp(self.low, self.high)
        };
        self.from + (self.to - self.from) * (logarithm - self.low) / (self.high - self.low)
    }
}

/// The least and greatest decimal logarithm of those numbers that have one.
pub fn extent(numbers: impl Iterator<Item = f64>) -> (f64, f64) {
    let logarithms = numbers
        .filter(|x| *x > 0.0 && x.is_finite())
        .map(libm::log10);
    let (low, high) = logarithms.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    if low <= high { (low, high) } else { (0.0, 1.0) }
}

/// A number at which an axis has a line.
pub struct Step {
    pub logarithm: f64,
    pub text: String,
}

/// 1, 2, 5, 10, 20 ... from the decade of a decimal logarithm on.
pub fn steps(from: f64) -> impl Iterator<Item = Step> {
    let decade = from.floor() as i32;
    (decade..).flat_map(|exponent| {
        [1_u8, 2, 5].map(|digit| Step {
            logarithm: f64::from(exponent) + libm::log10(f64::from(digit)),
            text: match exponent {
                0.. => format!("{digit}{}", "0".repeat(exponent as usize)),
                _ => format!("{digit}e{exponent}"),
            },
        })
    })
}

/// A power of ten as it is written.
pub fn power_of_ten(exponent: i32) -> String {
    let raised = exponent
        .to_string()
        .chars()
        .map(|digit| match digit {
            '-' => '\u{207b}',
            '1' => '\u{b9}',
            '2' => '\u{b2}',
            '3' => '\u{b3}',
            other => char::from_u32('\u{2070}' as u32 + other as u32 - '0' as u32).unwrap_or(other),
        })
        .collect::<String>();
    format!("10{raised}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axis_middle_of_the_decades_is_the_middle_of_the_pixels() {
        let axis = Axis::new((-3.0, 1.0), 500.0, 100.0);
        assert!((axis.pixel(0.1) - 300.0).abs() < 1e-9);
        assert_eq!(axis.pixel(0.0), 500.0);
        assert_eq!(axis.pixel(f64::INFINITY), 100.0);
        assert_eq!(axis.pixel(f64::NAN), 100.0);
    }

    #[test]
    fn power_of_ten_is_raised() {
        assert_eq!(power_of_ten(-12), "10⁻¹²");
        assert_eq!(power_of_ten(0), "10⁰");
        assert_eq!(power_of_ten(3), "10³");
        assert_eq!(power_of_ten(456), "10⁴⁵⁶");
    }
}
