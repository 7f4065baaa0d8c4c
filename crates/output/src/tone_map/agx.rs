//! The AgX tone map, base look.
//!
//! Of a linear color of Rec. 709 without negative components:
//!
//! 1. Inset: a matrix that moves the primaries towards white, so that strong light of one
//!    color reaches the other components. Its rows sum to 1 within 2e-4: gray stays gray.
//! 2. Logarithm: `x = (log2 c + 12.47393)/(12.47393 + 4.026069)`, clamped to [0, 1]: 10 stops
//!    below and 6.5 above middle gray, 0.18, which is at `x0 = 10/16.5 = 20/33`.
//! 3. Curve: through `(x0, 1/2)` with the slope 2, `y = 1/2 + 2 (x - x0)/(1 + (a |x - x0|)^p)^(1/p)`
//!    with `p = 3` below `x0` and `p = 3.25` above; `a` is such that the curve ends at (0, 0)
//!    and (1, 1): with the end `e` of the straight line, `2 |x - x0|` at 0 or 1,
//!    `1 + (a |x - x0|)^p = (e/(1/2))^p`.
//! 4. Outset: the inverse of the inset's matrix.
//!
//! The result is encoded for a display whose curve is a power of 2.2, as sRGB displays are: it
//! is the code over 255.
//!
//! Source: T. Sobotka, AgX, 2022, repository sobotka/AgX: matrix and range of the logarithm
//! from its configuration, the curve (by J. Smith) from its first table
//! `AgX_Default_Contrast.spi1d`, which the formula repeats to 1e-7; the outset as in B.
//! Wrensch, "Minimal AgX Implementation", 2023.

/// The inset's rows.
const INSET: [[f64; 3]; 3] = [
    [
        0.842_479_062_253_094,
        0.078_433_599_999_999_2,
        0.079_223_745_147_764_3,
    ],
    [
        0.042_328_242_261_012_3,
        0.878_468_636_469_772,
        0.079_166_127_460_543_4,
    ],
    [0.042_375_654_905_705_1, 0.078_433_6, 0.879_142_973_793_104],
];
/// The inverse's rows.
const OUTSET: [[f64; 3]; 3] = [
    [
        1.196_879_005_120_17,
        -0.098_020_881_140_136_8,
        -0.099_029_744_079_720_5,
    ],
    [
        -0.052_896_851_757_456_2,
        1.151_903_129_904_17,
        -0.098_961_176_844_843_3,
    ],
    [
        -0.052_971_635_514_443_8,
        -0.098_043_450_117_124_1,
        1.151_073_672_641_16,
    ],
];
/// The range of the logarithm.
const DARKEST: f64 = -12.473_93;
const BRIGHTEST: f64 = 4.026_069;
/// `x0`.
const PIVOT: f64 = 20.0 / 33.0;
const SLOPE: f64 = 2.0;
const TOE_POWER: f64 = 3.0;
const SHOULDER_POWER: f64 = 3.25;

/// The codes over 255, which may be slightly outside [0, 1].
pub(super) fn encode(color: [f64; 3]) -> [f64; 3] {
    let inset = product(&INSET, color);
    product(&OUTSET, inset.map(|value| curve(position(value))))
}

/// `x` of a linear value.
fn position(value: f64) -> f64 {
    ((libm::log2(value) - DARKEST) / (BRIGHTEST - DARKEST)).clamp(0.0, 1.0)
}

/// `y` at `x` in [0, 1].
fn curve(x: f64) -> f64 {
    let (side, power) = if x < PIVOT {
        (PIVOT, TOE_POWER)
    } else {
        (1.0 - PIVOT, SHOULDER_POWER)
    };
    let distance = x - PIVOT;
    let end = libm::pow(SLOPE * side / 0.5, power) - 1.0;
    let bend = 1.0 + end * libm::pow(distance.abs() / side, power);
    0.5 + SLOPE * distance / libm::pow(bend, 1.0 / power)
}

fn product(rows: &[[f64; 3]; 3], color: [f64; 3]) -> [f64; 3] {
    rows.map(|row| row[0] * color[0] + row[1] * color[1] + row[2] * color[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries of the published table, which has 4096.
    #[test]
    fn curve_repeats_the_published_table() {
        for (entry, published) in [
            (0, 0.0),
            (1994, 0.269_241_4),
            (1995, 0.269_671_4),
            (2482, 0.500_088_8),
            (2897, 0.700_278_3),
            (3127, 0.800_077_5),
            (3428, 0.900_086_1),
            (4092, 0.999_787_2),
            (4095, 1.0),
        ] {
            let found = curve(f64::from(entry) / 4095.0);
            assert!((found - published).abs() < 1e-7, "{entry}: {found}");
        }
    }

    #[test]
    fn middle_gray_is_shown_as_one_half_and_the_ends_as_black_and_white() {
        for (gray, expected) in [(0.0, 0.0), (0.18, 0.5), (16.3, 1.0), (1e9, 1.0)] {
            for code in encode([gray; 3]) {
                assert!((code - expected).abs() < 2e-4, "{gray}: {code}");
            }
        }
    }

    #[test]
    fn outset_is_the_inverse_of_the_inset() {
        for unit in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let back = product(&OUTSET, product(&INSET, unit));
            for (found, expected) in back.into_iter().zip(unit) {
                assert!((found - expected).abs() < 1e-12, "{unit:?}: {back:?}");
            }
        }
    }
}
