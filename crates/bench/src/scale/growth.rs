//! How fast something grows: the exponent of a power law.
//!
//! If `y = c n^k`, then `log y = log c + k log n`, and `k` is the slope of the
//! line of least squares through the logarithms,
//! `Σ (x - mean x)(y - mean y) / Σ (x - mean x)²`.

use super::measure::{Figures, Row, Scale, Series};

/// The exponents by which a series grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fits {
    /// Of the time to build.
    pub build_s: Option<f64>,
    /// Of the memory.
    pub bytes: Option<f64>,
    /// Of the camera's rays a second; negative where there are fewer.
    pub rays_per_s: Option<f64>,
    /// Of incoherent rays a second.
    pub incoherent_rays_per_s: Option<f64>,
}

impl Fits {
    /// Those of some rows.
    #[must_use]
    pub fn of(rows: &[Row]) -> Self {
        let fit = |of: fn(&Figures) -> f64| {
            let point = |row: &Row| Some((row.n as f64, of(row.found.as_ref().ok()?)));
            slope(&rows.iter().filter_map(point).collect::<Vec<_>>())
        };
        Self {
            build_s: fit(|found| found.build_s),
            bytes: fit(|found| found.bytes as f64),
            rays_per_s: fit(|found| found.rays_per_s),
            incoherent_rays_per_s: fit(|found| found.incoherent_rays_per_s),
        }
    }
}

impl Scale {
    /// How a series grows.
    #[must_use]
    pub fn fits(&self, series: Series) -> Fits {
        Fits::of(self.of(series))
    }
}

/// The exponent of the power law nearest to positive points; `None` if they are
/// not at two places at least.
#[must_use]
pub fn slope(points: &[(f64, f64)]) -> Option<f64> {
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
    (spread > 0.0).then(|| sum(&|x, y| x * y) / spread)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slope_of_a_power_law_is_its_exponent() {
        for exponent in [1.0, 0.0, -0.25, 1.5] {
            let point = |n: f64| (n, 7.0 * libm::pow(n, exponent));
            let found = slope(&[1e3, 1e4, 1e5, 1e7].map(point)).unwrap();
            assert!((found - exponent).abs() < 1e-12, "{found} for {exponent}");
        }
    }

    #[test]
    fn slope_is_that_of_least_squares() {
        // (0, 0), (1, 1), (2, 1) in logarithms: 1/2.
        let e = libm::exp(1.0);
        let found = slope(&[(1.0, 1.0), (e, e), (e * e, e)]).unwrap();
        assert!((found - 0.5).abs() < 1e-12, "{found}");
    }

    #[test]
    fn slope_of_one_place_is_none() {
        assert_eq!(slope(&[]), None);
        assert_eq!(slope(&[(10.0, 3.0)]), None);
    }
}
