//! How fast something grows: the exponents of power laws.

use crate::statistics::PowerLaw;

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
            let points: Vec<_> = rows.iter().filter_map(point).collect();
            PowerLaw::of(&points).map(|law| law.exponent)
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
