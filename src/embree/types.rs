//! Plain values that the other files of this folder share; this file uses none of them.

use std::fmt;

use super::sys;

/// Coordinates of rays, boxes and vertices must be below this: Embree's own limit for a finite
/// value, 1.844e18.
pub const GREATEST_COORDINATE: f32 = 1.844e18;

/// The number of a geometry in its scene: counted from 0 in the order of attachment, except for
/// instances with given numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GeometryId(pub u32);

/// The number of rays that Embree traverses together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PacketWidth {
    /// For SSE2 and NEON.
    Four,
    /// For AVX.
    Eight,
    /// For AVX-512.
    Sixteen,
}

impl PacketWidth {
    /// All widths, the least first.
    pub const ALL: [Self; 3] = [Self::Four, Self::Eight, Self::Sixteen];

    /// The number of rays.
    #[must_use]
    pub fn rays(self) -> usize {
        match self {
            Self::Four => 4,
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }
}

/// A version of Embree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version {
    /// 3 or 4.
    pub major: u32,
    /// Counts features.
    pub minor: u32,
    /// Counts corrections.
    pub patch: u32,
}

impl Version {
    /// The version of the headers this program was built with.
    pub const BUILT_FOR: Self = Self {
        major: sys::RTC_VERSION_MAJOR,
        minor: sys::RTC_VERSION_MINOR,
        patch: sys::RTC_VERSION_PATCH,
    };
}

impl fmt::Display for Version {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}
