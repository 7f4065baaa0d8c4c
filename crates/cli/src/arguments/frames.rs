//! The arguments of films.

use std::num::NonZeroU32;

use clap::Args;

use super::numbers::count_up_to;

/// Most pictures of a film: an hour at 28 a second.
const MOST_FRAMES: u64 = 100_000;

/// Most degrees of an orbit.
const GREATEST_DEGREES: f64 = 36_000.0;

/// Makes a film of a picture.
#[derive(Args, Clone, Debug)]
pub struct FrameArguments {
    /// Render N pictures of an `--orbit`, 1 to 10^5. With `-o turn.png`, they are
    /// `turn_0000.png`, `turn_0001.png` and so on. The scene is loaded once
    #[arg(long, value_name = "N", value_parser = count_up_to::<NonZeroU32>(MOST_FRAMES), requires = "orbit", conflicts_with = "divided", allow_negative_numbers = true)]
    pub frames: Option<NonZeroU32>,
    /// Turn the camera by DEGREES in all, such as `--orbit=90`, about the axis through the point that it looks at along
    /// its `up`, counterclockwise as seen from above. By full turns, the last of N pictures is a
    /// step before the first one; by other angles, the first and the last are at their ends
    /// [default of DEGREES: 360]
    #[arg(long, value_name = "DEGREES", num_args = 0..=1, require_equals = true, default_missing_value = "360", value_parser = parse_degrees, requires = "frames")]
    pub orbit: Option<f64>,
}

/// An angle of an orbit.
fn parse_degrees(text: &str) -> Result<f64, String> {
    let degrees = text.parse().ok();
    degrees
        .filter(|degrees: &f64| *degrees != 0.0 && degrees.abs() <= GREATEST_DEGREES)
        .ok_or_else(|| {
            format!(
                "it must be a number from -{GREATEST_DEGREES} to {GREATEST_DEGREES} other than 0"
            )
        })
}
