//! Clear skies in a scene file, and the sun that belongs to one.
//!
//! **The sun.** Sunlight of the irradiance `E` above the atmosphere arrives as
//!
//! ```text
//! E exp(-m (0.008735 λ^-4.08 + β λ^-1.3 + 0.35 k(λ)))
//! β = 0.04608 T - 0.04586
//! m = 1 / (sin h + 0.15 (h + 3.885)^-1.253)
//! ```
//!
//! at the turbidity `T` and the sun's elevation `h` in degrees: scattering by air (Rayleigh), by
//! aerosols (Ångström) and absorption by 3.5 mm of ozone, along `m` atmospheres. Source: A. J.
//! Preetham, P. Shirley, B. Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999, appendix
//! A.1, without mixed gases and water vapor, which absorb in the far red. `λ` is in micrometers: one
//! wavelength for each component, the dominant wavelengths of the primaries of sRGB (0.611, 0.549 and
//! 0.464), which replaces integrals over the spectrum. Above the atmosphere, the color is that of a
//! black body of 5778 K.
//!
//! **Units.** An irradiance of 5 in luminance is that of the sun above the atmosphere, 133.3 klx, so
//! that 1 is 26.66 klx. The sun at the default elevation of 40 degrees then has about the
//! default strength, 3.

use glam::DVec3;

use super::document::SkyKeys;
use super::error::SceneError;
use super::light::ClearSky;
use super::light_values::{color, strength};
use super::source::Source;

/// Turbidities that the model of the sky is made for.
const TURBIDITIES: std::ops::RangeInclusive<f64> = 2.0..=10.0;

/// The clear sky of `[sky]`; `None` if the sky is the same in all directions.
pub(super) fn clear_sky(source: &Source, keys: &SkyKeys) -> Result<Option<ClearSky>, SceneError> {
    let is_clear = match &keys.model {
        None => false,
        Some(word) => source.choose("model", word, &[("constant", false), ("clear", true)])?,
    };
    if !is_clear {
        let turbidity = keys.turbidity.as_ref().map(|key| ("turbidity", key.span()));
        let ground = keys.ground.as_ref().map(|key| ("ground", key.span()));
        return match turbidity.or(ground) {
            None => Ok(None),
            Some((name, place)) => Err(source.error(
                place,
                format!("{name} is for the clear sky: state model = \"clear\" too"),
            )),
        };
    }
    if let Some(key) = &keys.color {
        return Err(source.error(
            key.span(),
            "color is for the constant sky: the colors of a clear one follow from the turbidity",
        ));
    }
    let turbidity = keys.turbidity.as_ref();
    let turbidity_or_default = turbidity.map_or(ClearSky::TURBIDITY, |key| key.get_ref().0);
    if let Some(key) = turbidity
        && !TURBIDITIES.contains(&turbidity_or_default)
    {
        return Err(source.error(
            key.span(),
            format!(
                "turbidity is {turbidity_or_default}: it must be between {} (clear) and {} (hazy)",
                TURBIDITIES.start(),
                TURBIDITIES.end()
            ),
        ));
    }
    let ground = color(source, keys.ground.as_ref(), ClearSky::GROUND)?;
    if let Some(key) = &keys.ground
        && ground.cmpgt(DVec3::ONE).any()
    {
        return Err(source.error(
            key.span(),
            format!(
                "ground is [{}, {}, {}]: a reflectance must be in [0, 1]",
                ground.x, ground.y, ground.z
            ),
        ));
    }
    Ok(Some(ClearSky {
        turbidity: turbidity_or_default,
        ground,
        strength: strength(source, keys.strength.as_ref(), 1.0)?,
    }))
}

/// The luminance of the sun's irradiance above the atmosphere.
const ABOVE: f64 = 5.0;

/// The color of a black body of 5778 K in linear sRGB, of luminance 1.
const ABOVE_COLOR: DVec3 = DVec3::new(1.113, 0.975, 0.914);

/// The wavelengths of the components in micrometers.
const WAVELENGTHS: DVec3 = DVec3::new(0.611, 0.549, 0.464);

/// What ozone absorbs at these wavelengths, per centimeter.
const OZONE: DVec3 = DVec3::new(0.119, 0.084, 0.007);

impl ClearSky {
    /// The turbidity of a clear day.
    pub const TURBIDITY: f64 = 3.0;

    /// The reflectance of the ground where the scene file states none.
    pub const GROUND: DVec3 = DVec3::splat(0.2);

    /// The luminance in kcd/m² of a radiance of luminance 1, and the illuminance in klx of such
    /// an irradiance.
    pub const KILOLUX: f64 = 133.3 / ABOVE;

    /// The irradiance of the sun on a surface that faces it, linear RGB. `direction` is a unit
    /// vector towards the sun; the irradiance is zero below the horizon.
    #[must_use]
    pub fn sun_irradiance(&self, direction: DVec3) -> DVec3 {
        if direction.z < 0.0 {
            return DVec3::ZERO;
        }
        let degrees = libm::asin(direction.z.min(1.0)).to_degrees();
        let air_mass = 1.0 / (direction.z + 0.15 * libm::pow(degrees + 3.885, -1.253));
        let haze = 0.04608 * self.turbidity - 0.04586;
        let component = |index: usize| {
            let wavelength = WAVELENGTHS[index];
            let depth = 0.008_735 * libm::pow(wavelength, -4.08)
                + haze * libm::pow(wavelength, -1.3)
                + 0.35 * OZONE[index];
            ABOVE * ABOVE_COLOR[index] * libm::exp(-air_mass * depth)
        };
        DVec3::new(component(0), component(1), component(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kilolux(turbidity: f64, degrees: f64) -> f64 {
        let sky = ClearSky {
            turbidity,
            ground: ClearSky::GROUND,
            strength: 1.0,
        };
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        let irradiance = sky.sun_irradiance(DVec3::new(cosine, 0.0, sine));
        irradiance.dot(DVec3::new(0.2126, 0.7152, 0.0722)) * ClearSky::KILOLUX
    }

    /// The illuminance of direct sunlight on a surface that faces the sun on clear days, by the
    /// formula of the IES for clear skies: `127.5 exp(-0.21 m)` klx.
    #[test]
    fn sunlight_of_a_clear_day_has_its_illuminance() {
        for degrees in [20.0, 40.0, 60.0, 90.0_f64] {
            let expected = 127.5 * libm::exp(-0.21 / libm::sin(degrees.to_radians()));
            let found = kilolux(2.5, degrees);
            assert!(
                (found / expected - 1.0).abs() < 0.15,
                "{degrees}: {found}, {expected}"
            );
        }
    }

    #[test]
    fn sunlight_is_redder_and_weaker_the_lower_and_hazier() {
        let sky = |turbidity| ClearSky {
            turbidity,
            ground: DVec3::ZERO,
            strength: 1.0,
        };
        let high = sky(3.0).sun_irradiance(DVec3::Z);
        let low = sky(3.0).sun_irradiance(DVec3::new(0.98, 0.0, 0.2));
        let hazy = sky(8.0).sun_irradiance(DVec3::Z);
        for weaker in [low, hazy] {
            assert!(weaker.cmplt(high).all(), "{weaker} {high}");
            assert!(weaker.z / weaker.x < high.z / high.x, "{weaker} {high}");
        }
        assert!(sky(2.0).sun_irradiance(DVec3::X).is_finite());
        assert_eq!(sky(2.0).sun_irradiance(DVec3::NEG_Z), DVec3::ZERO);
    }
}
