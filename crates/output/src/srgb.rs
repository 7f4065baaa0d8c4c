//! The sRGB transfer curve of IEC 61966-2-1.

/// The 8-bit code of a linear value: the exact curve, rounded to nearest.
///
/// There is no tone mapping: values below 0 and NaN give 0, values above 1
/// give 255.
#[must_use]
pub fn encode(linear: f32) -> u8 {
    let linear = f64::from(linear).clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    };
    (encoded * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encode_end_points_and_outside_values_clamp() {
        for (linear, code) in [
            (0.0, 0),
            (-0.0, 0),
            (-1.0, 0),
            (f32::NEG_INFINITY, 0),
            (f32::NAN, 0),
            (1.0, 255),
            (1.5, 255),
            (f32::INFINITY, 255),
        ] {
            assert_eq!(encode(linear), code, "{linear}");
        }
    }

    #[test]
    fn encode_known_values_match_the_standard() {
        // Middle grey and the codes on both sides of the curve's joint.
        assert_eq!(encode(0.215_860_5), 128);
        assert_eq!(encode(0.5), 188);
        assert_eq!(encode(0.003_130_8), 10);
        assert_eq!(encode(0.003_3), 11);
    }

    #[test]
    fn encode_rising_values_never_fall_and_reach_every_code() {
        let mut reached = [false; 256];
        let mut last = 0;
        for step in 0..=100_000 {
            let code = encode(step as f32 / 100_000.0);
            assert!(code >= last, "code falls at step {step}");
            reached[usize::from(code)] = true;
            last = code;
        }
        assert!(reached.iter().all(|&code| code));
    }
}
