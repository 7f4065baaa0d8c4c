//! The PBR Neutral tone map.
//!
//! Of a linear color of Rec. 709 without negative components, `c`, with `F = 0.04`, the
//! reflection that a clear coat adds, `K = 0.8 - F` and `D = 0.15`:
//!
//! - `x = min(c)`, and `f = x - x²/(4 F)` where `x <= 2 F`, else `F`: the part of `c` that is
//!   taken away, so that black stays black.
//! - `p = max(c - f)`. Where `p <= K` the result is `c - f`.
//! - Elsewhere the peak becomes `q = 1 - (1 - K)²/(p + 1 - 2 K)`, below 1, with
//!   `g = 1/(D (p - q) + 1)`, and the result is `(c - f) g q/p + q (1 - g)`: less saturated the
//!   more was compressed.
//!
//! Source: Khronos Group, "Khronos PBR Neutral Tone Mapper", specification in the repository
//! KhronosGroup/ToneMapping, 2024.

/// `F`.
const CLEAR_COAT: f64 = 0.04;
/// `K`.
const START: f64 = 0.8 - CLEAR_COAT;
/// `D`.
const DESATURATION: f64 = 0.15;

/// The linear color that is shown, each component in [0, 1].
pub(super) fn map(color: [f64; 3]) -> [f64; 3] {
    let least = color.into_iter().fold(f64::INFINITY, f64::min);
    let taken = if least <= 2.0 * CLEAR_COAT {
        least - least * least / (4.0 * CLEAR_COAT)
    } else {
        CLEAR_COAT
    };
    let color = color.map(|value| value - taken);
    let peak = color.into_iter().fold(0.0, f64::max);
    if peak <= START {
        return color;
    }
    let shown = 1.0 - (1.0 - START) * (1.0 - START) / (peak + 1.0 - 2.0 * START);
    let kept = 1.0 / (DESATURATION * (peak - shown) + 1.0);
    color.map(|value| value * (shown / peak) * kept + shown * (1.0 - kept))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_near(found: [f64; 3], expected: [f64; 3]) {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
        }
    }

    /// The specification's promise: under light of strength 1, a base color up to 0.8 is shown
    /// as it is after the clear coat added 0.04.
    #[test]
    fn base_color_is_shown_as_it_is() {
        for color in [[0.04, 0.3, 0.76], [0.5, 0.6, 0.7], [0.1, 0.1, 0.1]] {
            assert_near(map(color.map(|value| value + 0.04)), color);
        }
    }

    /// By hand: black; x = 0.04 takes 0.03 away; a red of 10 has the peak 10,
    /// q = 1 - 0.0576/9.48 and g = 1/(0.15 (10 - q) + 1).
    #[test]
    fn values_by_hand() {
        assert_near(map([0.0; 3]), [0.0; 3]);
        assert_near(map([0.04, 0.04, 0.04]), [0.01; 3]);
        let shown = 1.0 - 0.0576 / 9.48;
        let kept = 1.0 / (0.15 * (10.0 - shown) + 1.0);
        assert_near(
            map([10.0, 0.0, 0.0]),
            [shown, shown * (1.0 - kept), shown * (1.0 - kept)],
        );
    }

    #[test]
    fn gray_rises_without_a_step_and_stays_below_one() {
        let mut last = [-1.0; 3];
        for step in 0..4000 {
            let mapped = map([f64::from(step) * 0.001; 3]);
            let rise = mapped[0] - last[0];
            assert!(step == 0 || (0.0..0.0011).contains(&rise), "{step}: {rise}");
            assert!(mapped[0] < 1.0);
            last = mapped;
        }
    }
}
