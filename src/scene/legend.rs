//! What a picture shows of a data color, and where.

use super::inset::Inset;
use super::record::MaterialIndex;

/// The legend of a data color, which is drawn over the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// The material whose color it explains, a [`Color::Data`](super::Color::Data).
    pub material: MaterialIndex,
    /// The line above it; none if empty.
    pub title: String,
    /// Its place and look.
    pub inset: Inset,
}
