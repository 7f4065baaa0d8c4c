//! What makes a picture easier to read than a photograph of the scene: a bar of a known length,
//! the axes of the world, lines round solids, and a fading distance.

use glam::DVec3;

use super::inset::Inset;

/// The parts of an illustration that a scene states, each by a table of its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Illustration {
    /// `[scale_bar]`
    pub scale_bar: Option<ScaleBar>,
    /// `[axes]`
    pub axes: Option<Axes>,
    /// `[outlines]`
    pub outlines: Option<Outlines>,
    /// `[depth_cue]`
    pub depth_cue: Option<DepthCue>,
}

/// A bar that shows a length. The camera is no panorama.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaleBar {
    /// The length in scene units, greater than 0. `None` is a round number for which the bar
    /// takes near a fifth of the picture's width.
    pub length: Option<f64>,
    /// The text after the number; none if empty.
    pub unit: String,
    /// Its place and look.
    pub inset: Inset,
}

/// The axes of the world as the camera sees them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// Whether their names are at their ends.
    pub labels: bool,
    /// Their place and look; the color is that of the names.
    pub inset: Inset,
}

/// Lines round solids and along their edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outlines {
    /// The width in pixels, greater than 0 and at most [`Outlines::GREATEST_WIDTH`].
    pub width: f64,
    /// Linear RGB, each component in [0, 1].
    pub color: DVec3,
    /// The angle between the normals of neighboring points above which there is a line, greater
    /// than 0 and at most 180.
    pub crease_degrees: f64,
    /// Whether there are lines between solids that continue each other smoothly.
    pub between_solids: bool,
}

impl Outlines {
    /// The greatest width. The rays that a line takes grow with it.
    pub const GREATEST_WIDTH: f64 = 32.0;
    pub(super) const DEFAULT: Self = Self {
        width: 1.0,
        color: DVec3::ZERO,
        crease_degrees: 30.0,
        between_solids: true,
    };
}

/// The fading of surfaces with their distance along the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthCue {
    /// What surfaces fade to, linear RGB, each component in [0, 1]. `None` is the background if
    /// that is a constant color, and white otherwise.
    pub color: Option<DVec3>,
    /// The distance where fading begins, 0 or more. `None` is that of the nearest part of the
    /// scene's box.
    pub start: Option<f64>,
    /// The distance from which on fading is greatest, greater than the start. `None` is that of
    /// the farthest part of the scene's box.
    pub end: Option<f64>,
    /// The share of the color at the end, in [0, 1].
    pub strength: f64,
}

impl DepthCue {
    pub(super) const DEFAULT_STRENGTH: f64 = 0.8;
}
