//! The sky on a clear day.
//!
//! The model of A. J. Preetham, P. Shirley, B. Smits, "A Practical Analytic Model for Daylight",
//! SIGGRAPH 1999. With the angles `θ` from the zenith and `γ` from the sun, and the sun at `θ_s` from
//! the zenith, the luminance and the chromaticities `x` and `y` are each
//!
//! ```text
//! v(θ, γ) = v_z F(θ, γ) / F(0, θ_s)
//! F(θ, γ) = (1 + A exp(B / cos θ)) (1 + C exp(D γ) + E cos² γ)
//! ```
//!
//! with five coefficients that are linear in the turbidity `T`, and the zenith values
//!
//! ```text
//! Y_z = (4.0453 T - 4.9710) tan χ - 0.2155 T + 2.4192   kcd/m²,   χ = (4/9 - T/120) (π - 2 θ_s)
//! ```
//!
//! and, for `x_z` and `y_z`, cubics in `θ_s` whose coefficients are quadratic in `T`. The constants
//! are those of the paper's appendix A.2. `B` is negative for all three from `T = 1.3` on, so that `F`
//! has the limit without its first exponential at the horizon.
//!
//! Below the horizon is a diffuse ground, whose radiance is its reflectance over π times its
//! irradiance by the sky and the sun. Colors outside sRGB are clipped to it.
//!
//! **Limits of the model.** It is a fit to simulations for `T` from 2 to 6 and used up to 10. The sky
//! is too bright near the horizon and opposite to a low sun, and the sun's glow is too narrow at high
//! turbidity (L. Hosek, A. Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance", SIGGRAPH
//! 2012). The sun's disk itself is not part of it.

use std::f64::consts::{FRAC_1_PI, PI, TAU};

use cyltrace::scene::{ClearSky, Environment};
use glam::{DMat3, DVec3};

/// The size of the table of a sky.
const TABLE: (u32, u32) = (512, 256);

/// The boxes of equal solid angle in which the irradiance on the ground is summed: rows, columns.
const BOXES: (u32, u32) = (64, 128);

/// Slope and value at 0 over the turbidity of A, B, C, D and E.
const LUMINANCE: [(f64, f64); 5] = [
    (0.1787, -1.4630),
    (-0.3554, 0.4275),
    (-0.0227, 5.3251),
    (0.1206, -2.5771),
    (-0.0670, 0.3703),
];
const CHROMATICITY_X: [(f64, f64); 5] = [
    (-0.0193, -0.2592),
    (-0.0665, 0.0008),
    (-0.0004, 0.2125),
    (-0.0641, -0.8989),
    (-0.0033, 0.0452),
];
const CHROMATICITY_Y: [(f64, f64); 5] = [
    (-0.0167, -0.2608),
    (-0.0950, 0.0092),
    (-0.0079, 0.2102),
    (-0.0441, -1.6537),
    (-0.0109, 0.0529),
];

/// The zenith's chromaticities: factors of T², T and 1, each a polynomial in the sun's angle
/// from the highest power.
const ZENITH_X: [[f64; 4]; 3] = [
    [0.00166, -0.00375, 0.00209, 0.0],
    [-0.02903, 0.06377, -0.03202, 0.00394],
    [0.11693, -0.21196, 0.06052, 0.25886],
];
const ZENITH_Y: [[f64; 4]; 3] = [
    [0.00275, -0.00610, 0.00317, 0.0],
    [-0.04214, 0.08970, -0.04153, 0.00516],
    [0.15346, -0.26756, 0.06670, 0.26688],
];

/// Linear sRGB from XYZ (IEC 61966-2-1).
const RGB_FROM_XYZ: DMat3 = DMat3::from_cols(
    DVec3::new(3.2406, -0.9689, 0.0557),
    DVec3::new(-1.5372, 1.8758, -0.2040),
    DVec3::new(-0.4986, 0.0415, 1.0570),
);

/// A clear sky with a sun.
#[derive(Clone, Copy, Debug)]
pub struct ClearSkyModel {
    sun: DVec3,
    /// Luminance, x and y.
    parts: [Part; 3],
    ground: DVec3,
    strength: f64,
}

/// One quantity over the sky.
#[derive(Clone, Copy, Debug)]
struct Part {
    coefficients: [f64; 5],
    /// The value at the zenith over F there.
    scale: f64,
}

impl ClearSkyModel {
    /// The model for a sun in a direction, a unit vector; a sun below the horizon counts as on it.
    #[must_use]
    pub fn new(sky: &ClearSky, sun: DVec3) -> Self {
        let turbidity = sky.turbidity;
        let angle = libm::acos(sun.z.clamp(0.0, 1.0));
        let chi = (4.0 / 9.0 - turbidity / 120.0) * (PI - 2.0 * angle);
        let luminance =
            (4.0453 * turbidity - 4.9710) * libm::tan(chi) - 0.2155 * turbidity + 2.4192;
        let part = |coefficients, zenith| Part::new(coefficients, turbidity, angle, zenith);
        let mut model = Self {
            sun,
            parts: [
                part(&LUMINANCE, luminance / ClearSky::KILOLUX),
                part(&CHROMATICITY_X, zenith(&ZENITH_X, turbidity, angle)),
                part(&CHROMATICITY_Y, zenith(&ZENITH_Y, turbidity, angle)),
            ],
            ground: DVec3::ZERO,
            strength: sky.strength,
        };
        let irradiance = model.sky_irradiance() + sky.sun_irradiance(sun) * sun.z.max(0.0);
        model.ground = sky.ground * irradiance * FRAC_1_PI;
        model
    }

    /// The radiance from a direction, a unit vector that points towards the light.
    #[must_use]
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        let radiance = match direction.z >= 0.0 {
            true => self.sky(direction),
            false => self.ground,
        };
        radiance * self.strength
    }

    /// A picture of the sky, for drawing directions.
    #[must_use]
    pub fn environment(&self) -> Environment {
        let (width, height) = TABLE;
        let pixels = (0..width * height).map(|index| {
            let (column, row) = (index % width, index / width);
            let elevation = PI * (0.5 - (f64::from(row) + 0.5) / f64::from(height));
            let azimuth = PI - TAU * (f64::from(column) + 0.5) / f64::from(width);
            let (z, level) = libm::sincos(elevation);
            let (sine, cosine) = libm::sincos(azimuth);
            let direction = DVec3::new(level * cosine, level * sine, z);
            self.radiance(direction).as_vec3().to_array()
        });
        Environment::new(width, height, pixels.collect()).expect("radiance is not negative")
    }

    /// The irradiance of a level surface by the sky alone, of strength 1.
    fn sky_irradiance(&self) -> DVec3 {
        let (rows, columns) = BOXES;
        let mut sum = DVec3::ZERO;
        for index in 0..rows * columns {
            let z = (f64::from(index / columns) + 0.5) / f64::from(rows);
            let azimuth = TAU * (f64::from(index % columns) + 0.5) / f64::from(columns);
            let (sine, cosine) = libm::sincos(azimuth);
            let level = (1.0 - z * z).sqrt();
            sum += self.sky(DVec3::new(level * cosine, level * sine, z)) * z;
        }
        sum * (TAU / f64::from(rows * columns))
    }

    /// The radiance of the sky of strength 1 at or above the horizon.
    fn sky(&self, direction: DVec3) -> DVec3 {
        let cosine = direction.dot(self.sun).clamp(-1.0, 1.0);
        let angle = libm::acos(cosine);
        let [luminance, x, y] = self
            .parts
            .map(|part| part.scale * part.distribution(direction.z, angle, cosine));
        let xyz = DVec3::new(x / y, 1.0, (1.0 - x - y) / y) * luminance;
        (RGB_FROM_XYZ * xyz).max(DVec3::ZERO)
    }
}

impl Part {
    fn new(lines: &[(f64, f64); 5], turbidity: f64, sun_angle: f64, zenith: f64) -> Self {
        let mut part = Self {
            coefficients: lines.map(|(slope, start)| slope * turbidity + start),
            scale: 1.0,
        };
        part.scale = zenith / part.distribution(1.0, sun_angle, libm::cos(sun_angle));
        part
    }

    /// `F` at the height `z` and an angle from the sun with its cosine.
    fn distribution(&self, z: f64, angle: f64, cosine: f64) -> f64 {
        let [a, b, c, d, e] = self.coefficients;
        let height = match z > 0.0 {
            true => libm::exp(b / z),
            false => 0.0,
        };
        (1.0 + a * height) * (1.0 + c * libm::exp(d * angle) + e * cosine * cosine)
    }
}

fn zenith(table: &[[f64; 4]; 3], turbidity: f64, angle: f64) -> f64 {
    let polynomial = |row: &[f64; 4]| row.iter().fold(0.0, |sum, factor| sum * angle + factor);
    let [square, linear, constant] = table.each_ref().map(polynomial);
    (square * turbidity + linear) * turbidity + constant
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::EnvironmentMap;

    const WEIGHTS: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

    fn sky(turbidity: f64) -> ClearSky {
        ClearSky {
            turbidity,
            ground: DVec3::new(0.5, 0.25, 0.0),
            strength: 1.0,
        }
    }

    fn sun(degrees: f64) -> DVec3 {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        DVec3::new(0.0, cosine, sine)
    }

    /// The zenith's luminance in kcd/m² and its chromaticities, from the paper's formulas
    /// evaluated in another language: at the turbidity 3 and a sun 50 degrees from the zenith
    /// χ = 0.585655 and tan χ = 0.663281, at 6 and 0 degrees χ = 1.239184 and tan χ = 2.904211.
    #[test]
    fn zenith_has_the_published_luminance_and_color() {
        for (turbidity, elevation, expected) in [(3.0, 40.0, 6.525_041), (6.0, 90.0, 57.179_793)] {
            let sky = sky(turbidity);
            let model = ClearSkyModel::new(&sky, sun(elevation));
            let zenith = model.radiance(DVec3::Z);
            let found = zenith.dot(WEIGHTS) * ClearSky::KILOLUX;
            assert!((found / expected - 1.0).abs() < 1e-3, "{found}, {expected}");
        }
        let zenith = ClearSkyModel::new(&sky(3.0), sun(40.0)).radiance(DVec3::Z);
        let xyz = RGB_FROM_XYZ.inverse() * zenith;
        let sum = xyz.element_sum();
        let found = (xyz.x / sum, xyz.y / sum);
        assert!((found.0 - 0.244_412).abs() < 1e-3, "{found:?}");
        assert!((found.1 - 0.250_521).abs() < 1e-3, "{found:?}");
    }

    #[test]
    fn sky_is_brightest_at_the_sun_and_finite_everywhere() {
        for turbidity in [2.0, 3.0, 6.0, 10.0] {
            for elevation in [0.0, 5.0, 40.0, 90.0] {
                let model = ClearSkyModel::new(&sky(turbidity), sun(elevation));
                let luminance = |direction| WEIGHTS.dot(model.radiance(direction));
                let name = format!("turbidity {turbidity}, sun at {elevation}");
                let opposite = DVec3::new(0.0, -model.sun.y, model.sun.z);
                if elevation < 90.0 {
                    assert!(luminance(model.sun) > luminance(opposite), "{name}");
                }
                for degree in 0..=90 {
                    let (z, level) = libm::sincos(f64::from(degree).to_radians());
                    let radiance = model.radiance(DVec3::new(level, 0.0, z));
                    assert!(
                        radiance.is_finite() && radiance.min_element() >= 0.0,
                        "{name}"
                    );
                    assert!(radiance.max_element() > 0.0, "{name} {degree}");
                }
            }
        }
    }

    /// The irradiance of the sky by a finer sum in other coordinates, and that of the table by drawn
    /// directions.
    #[test]
    fn ground_reflects_the_light_of_sky_and_sun() {
        let clear = sky(3.0);
        let model = ClearSkyModel::new(&clear, sun(40.0));
        let (rows, columns) = (900, 900);
        let mut expected = DVec3::ZERO;
        for row in 0..rows {
            let angle = 0.5 * PI * (f64::from(row) + 0.5) / f64::from(rows);
            let (level, z) = libm::sincos(angle);
            for column in 0..columns {
                let azimuth = TAU * (f64::from(column) + 0.5) / f64::from(columns);
                let (sine, cosine) = libm::sincos(azimuth);
                let direction = DVec3::new(level * cosine, level * sine, z);
                expected += model.radiance(direction) * (z * level);
            }
        }
        expected *= 0.5 * PI * TAU / f64::from(rows * columns);
        let found = model.sky_irradiance();
        assert!(
            ((found - expected) / expected).abs().max_element() < 2e-3,
            "{found} {expected}"
        );

        let map = EnvironmentMap::new(&model.environment());
        let (mut drawn, n) = (DVec3::ZERO, 400);
        for cell in 0..n * n {
            let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(n);
            let (direction, density) = map.sample((middle(cell / n), middle(cell % n)));
            drawn += map.radiance(direction) * direction.z.max(0.0) / density;
        }
        drawn /= f64::from(n * n);
        assert!(
            ((drawn - expected) / expected).abs().max_element() < 5e-3,
            "{drawn} {expected}"
        );

        let sunlight = clear.sun_irradiance(model.sun) * model.sun.z;
        let ground = clear.ground * (expected + sunlight) / PI;
        let below = model.radiance(DVec3::new(0.6, 0.0, -0.8));
        assert!(
            (below - ground).length() < 2e-3 * ground.length(),
            "{below} {ground}"
        );
        // Sunlight is most of the light of a clear day, and the sky a good part.
        let share = WEIGHTS.dot(expected) / WEIGHTS.dot(expected + sunlight);
        assert!((0.1..0.5).contains(&share), "{share}");
    }

    #[test]
    fn strength_scales_sky_and_ground() {
        let bright = ClearSky {
            strength: 2.5,
            ..sky(4.0)
        };
        let [one, other] = [sky(4.0), bright].map(|sky| ClearSkyModel::new(&sky, sun(30.0)));
        for direction in [DVec3::Z, DVec3::X, DVec3::NEG_Z] {
            assert_eq!(one.radiance(direction) * 2.5, other.radiance(direction));
        }
    }
}
