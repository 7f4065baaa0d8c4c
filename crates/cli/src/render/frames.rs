//! The pictures of a film: the camera goes round the scene.

use std::path::{Path, PathBuf};

use cyltrace_render::{RayCounts, Reached};
use serde_json::{Value, json};

use crate::arguments::FrameArguments;
use crate::reached;

/// Least digits of a picture's number.
const LEAST_DIGITS: usize = 4;

/// A picture of a film.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    pub output: PathBuf,
    /// The angle by which the camera is turned.
    pub degrees: f64,
}

/// The pictures that the command writes, one without `--frames`.
///
/// Over full turns, the last picture is a step before the first one, so that the film repeats
/// without a jump. Over other angles, the first and the last picture are at their ends.
pub fn frames(arguments: &FrameArguments, output: &Path) -> Vec<Frame> {
    let Some(count) = arguments.frames.map(u32::from) else {
        return vec![Frame {
            output: output.to_owned(),
            degrees: 0.0,
        }];
    };
    let whole = arguments.orbit.unwrap_or_default();
    let steps = match whole % 360.0 == 0.0 {
        true => count,
        false => (count - 1).max(1),
    };
    let digits = (count - 1).to_string().len().max(LEAST_DIGITS);
    let frame = |number| Frame {
        output: numbered(output, number, digits),
        degrees: whole * f64::from(number) / f64::from(steps),
    };
    (0..count).map(frame).collect()
}

/// The path with a number before its extension.
fn numbered(output: &Path, number: u32, digits: usize) -> PathBuf {
    let mut name = output.file_stem().unwrap_or_default().to_owned();
    name.push(format!("_{number:0digits$}"));
    if let Some(extension) = output.extension() {
        name.push(".");
        name.push(extension);
    }
    output.with_file_name(name)
}

/// What a picture of a film took.
pub struct FrameFigures {
    pub output: PathBuf,
    pub degrees: f64,
    pub seconds: f64,
    /// The time that removing the noise took, if that was requested.
    pub denoise_seconds: Option<f64>,
    pub rays: RayCounts,
    pub reached: Option<Reached>,
}

impl FrameFigures {
    /// Its entry in the JSON of `--json`.
    pub fn json(&self) -> Value {
        let mut figures = json!({
            "output": self.output,
            "degrees": self.degrees,
            "render_s": self.seconds,
            "rays": self.rays.total(),
        });
        if let Some(seconds) = self.denoise_seconds {
            figures["denoise_s"] = json!(seconds);
        }
        if let Some(reached) = &self.reached {
            figures[reached::KEY] = reached::figures(reached);
        }
        figures
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use super::*;

    fn film(count: u32, orbit: f64) -> Vec<Frame> {
        let arguments = FrameArguments {
            frames: NonZeroU32::new(count),
            orbit: Some(orbit),
        };
        frames(&arguments, Path::new("a/turn.png"))
    }

    #[test]
    fn full_turns_end_before_their_start_and_others_at_their_ends() {
        let degrees = |count, orbit| -> Vec<f64> {
            let frames = film(count, orbit).into_iter();
            frames.map(|frame| frame.degrees).collect()
        };
        assert_eq!(degrees(4, 360.0), [0.0, 90.0, 180.0, 270.0]);
        assert_eq!(degrees(4, -720.0), [0.0, -180.0, -360.0, -540.0]);
        assert_eq!(degrees(4, 90.0), [0.0, 30.0, 60.0, 90.0]);
        assert_eq!(degrees(1, 90.0), [0.0]);
    }

    #[test]
    fn pictures_are_numbered_before_the_extension() {
        let frames = film(12_345, 360.0);
        assert_eq!(frames[7].output, Path::new("a/turn_00007.png"));
        assert_eq!(film(2, 360.0)[1].output, Path::new("a/turn_0001.png"));
    }
}
