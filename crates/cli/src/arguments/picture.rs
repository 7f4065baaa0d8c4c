//! The arguments of a picture's contents: channels, how a PNG shows colors, and when a picture
//! has enough samples.

use std::time::Duration;

use clap::Args;
use cyltrace_output::{Display, ToneMap};
use cyltrace_render::{ChannelGroup, Target};

use super::names::one_of;

/// Most stops of an exposure: beyond 2^64, no number of a picture means anything.
const GREATEST_EXPOSURE: f64 = 64.0;

#[derive(Args, Clone, Debug)]
pub struct PictureArguments {
    /// Add channels to an `.exr`. Those of the surface are of a ray through the middle of each
    /// pixel; `docs/guide.md` names the channels
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',', value_parser = one_of(ChannelGroup::ALL, ChannelGroup::name))]
    pub channels: Vec<ChannelGroup>,
    /// Multiply the colors of a `.png` by 2^EV, -64 to 64 [default: 0]
    #[arg(long, value_name = "EV", value_parser = parse_exposure, allow_negative_numbers = true)]
    pub exposure: Option<f64>,
    /// Show the light beyond white in a `.png` with this tone map [default: `none`, which
    /// clamps it]
    #[arg(long, value_name = "NAME", value_parser = one_of(ToneMap::ALL, ToneMap::name))]
    pub tonemap: Option<ToneMap>,
    /// Render until the estimated relative error of every tile of 16 x 16 pixels is at most E,
    /// such as `0.02`, above 0; `--spp` is then the most that a pixel gets, at least 2 [default
    /// of `--spp`: 16384]
    #[arg(long, value_name = "E", value_parser = parse_error, allow_negative_numbers = true)]
    pub error: Option<f64>,
    /// Render for at most this time, without loading, or each picture of `--frames` for it; `--spp` is as with `--error`. The picture
    /// depends on the speed of the machine, so it cannot have parts
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, conflicts_with = "divided", allow_negative_numbers = true)]
    pub time: Option<Duration>,
    /// Remove the noise with Open Image Denoise 2, which must be installed: for the eye, without
    /// a bound of the error. It works on whole pictures, so the picture cannot have parts
    #[arg(long, conflicts_with = "divided")]
    pub denoise: bool,
}

impl PictureArguments {
    /// How a PNG shows colors.
    pub fn display(&self) -> Display {
        Display {
            exposure: self.exposure.unwrap_or_default(),
            tone_map: self.tonemap.unwrap_or_default(),
        }
    }

    /// When the picture has enough samples.
    pub fn target(&self) -> Option<Target> {
        let is_stated = self.error.is_some() || self.time.is_some();
        is_stated.then(|| Target {
            error: self.error.unwrap_or_default(),
            time: self.time,
        })
    }
}

/// A relative error.
pub fn parse_error(text: &str) -> Result<f64, String> {
    let error = text.parse().ok();
    error
        .filter(|error: &f64| error.is_finite() && *error > 0.0)
        .ok_or_else(|| "it must be a number above 0, such as 0.02".to_owned())
}

/// An exposure in stops.
fn parse_exposure(text: &str) -> Result<f64, String> {
    let exposure = text.parse().ok();
    exposure
        .filter(|exposure: &f64| exposure.abs() <= GREATEST_EXPOSURE)
        .ok_or_else(|| {
            format!("it must be a number from -{GREATEST_EXPOSURE} to {GREATEST_EXPOSURE}")
        })
}

/// A time in seconds.
fn parse_seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok();
    seconds
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .filter(|time| !time.is_zero())
        .ok_or_else(|| "it must be a number of seconds above 0".to_owned())
}
