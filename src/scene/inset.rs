//! What is drawn over a corner of a picture: where, how large, and in which colors.

use glam::DVec3;

/// The place and look of what is drawn over a corner of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inset {
    /// The corner of the picture that it is in.
    pub corner: Corner,
    /// The height of its text over the height of the picture, in [0.005, 0.2].
    pub size: f64,
    /// The color of its text, linear RGB, each component in [0, 1].
    pub color: DVec3,
    /// The color behind the text, linear RGB, each component in [0, 1].
    pub background: DVec3,
    /// The opacity of the color behind, in [0, 1].
    pub opacity: f64,
}

/// A corner of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Corner {
    TopLeft,
    TopRight,
    BottomLeft,
    BottomRight,
}

impl Corner {
    /// All corners and their names in scene files.
    pub(super) const NAMES: [(&'static str, Self); 4] = [
        ("top left", Self::TopLeft),
        ("top right", Self::TopRight),
        ("bottom left", Self::BottomLeft),
        ("bottom right", Self::BottomRight),
    ];

    /// The name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        let [top_left, top_right, bottom_left, bottom_right] = Self::NAMES.map(|(name, _)| name);
        match self {
            Self::TopLeft => top_left,
            Self::TopRight => top_right,
            Self::BottomLeft => bottom_left,
            Self::BottomRight => bottom_right,
        }
    }
}
