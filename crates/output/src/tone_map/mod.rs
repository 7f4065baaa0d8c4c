//! How linear colors become the codes of a PNG: exposure, a tone map and the display's curve.

mod agx;
mod pbr_neutral;

use crate::srgb;

/// How a PNG shows linear colors. By default as they are, clamped.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Display {
    /// The exposure in stops: colors are multiplied by 2 to this power.
    pub exposure: f64,
    /// How light beyond white is shown.
    pub tone_map: ToneMap,
}

/// How light beyond white is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneMap {
    /// As white: each component is clamped.
    #[default]
    None,
    /// The PBR Neutral tone map of the Khronos Group, which keeps colors below 0.8.
    PbrNeutral,
    /// AgX by T. Sobotka, which bleaches bright colors as film does.
    Agx,
}

impl ToneMap {
    /// All tone maps.
    pub const ALL: [Self; 3] = [Self::None, Self::PbrNeutral, Self::Agx];

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::PbrNeutral => "pbr-neutral",
            Self::Agx => "agx",
        }
    }
}

impl Display {
    /// Whether colors are shown as they are.
    #[must_use]
    pub fn is_plain(self) -> bool {
        self == Self::default()
    }

    /// The 8-bit codes of a linear color.
    #[must_use]
    pub fn codes(self, color: [f32; 3]) -> [u8; 3] {
        if self.is_plain() {
            return color.map(srgb::encode);
        }
        let factor = libm::exp2(self.exposure);
        let color = color.map(|value| f64::from(value) * factor);
        match self.tone_map {
            ToneMap::None => color.map(|value| srgb::encode(value as f32)),
            ToneMap::PbrNeutral => {
                pbr_neutral::map(non_negative(color)).map(|value| srgb::encode(value as f32))
            }
            ToneMap::Agx => agx::encode(non_negative(color))
                .map(|value| (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8),
        }
    }
}

/// The greatest value that is mapped; infinite ones would have no color.
const GREATEST: f64 = 1e30;

/// The color with values from 0 to [`GREATEST`]; NaN becomes 0.
fn non_negative(color: [f64; 3]) -> [f64; 3] {
    color.map(|value| {
        if value > 0.0 {
            value.min(GREATEST)
        } else {
            0.0
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposure_is_in_stops_before_the_tone_map() {
        let (color, twice) = ([0.1, 0.2, 0.4], [0.2, 0.4, 0.8]);
        for tone_map in ToneMap::ALL {
            let shown = |exposure, color| Display { exposure, tone_map }.codes(color);
            assert_eq!(shown(1.0, color), shown(0.0, twice), "{tone_map:?}");
            assert_eq!(shown(0.0, color), shown(-1.0, twice), "{tone_map:?}");
        }
    }

    #[test]
    fn any_number_has_codes_and_gray_stays_gray() {
        for tone_map in ToneMap::ALL {
            let display = Display {
                exposure: 0.5,
                tone_map,
            };
            for value in [
                f32::NAN,
                -1.0,
                0.0,
                1e-30,
                0.18,
                3.0,
                1e9,
                f32::MAX,
                f32::INFINITY,
            ] {
                let [red, green, blue] = display.codes([value; 3]);
                let spread = red.max(green).max(blue) - red.min(green).min(blue);
                assert!(spread <= 1, "{tone_map:?} {value}: {red} {green} {blue}");
            }
            assert_eq!(display.codes([f32::NAN, -1.0, 0.0]), [0; 3], "{tone_map:?}");
            assert_eq!(display.codes([f32::INFINITY; 3]), [255; 3], "{tone_map:?}");
        }
    }
}
