//! Plain values that the other files of this folder share. They use none of them.

use std::fmt;

use super::sys;

/// Coordinates of rays, boxes and vertices stay below this: Embree's own
/// limit for a finite value, 1.844e18.
pub const GREATEST_COORDINATE: f32 = 1.844e18;

/// The number of a geometry in its scene; they count from 0 in the order in
/// which they were attached, but for instances with numbers of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GeometryId(pub u32);

/// How many rays Embree traverses at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PacketWidth {
    /// As SSE2 and NEON have registers for.
    Four,
    /// As AVX has.
    Eight,
    /// As AVX-512 has.
    Sixteen,
}

impl PacketWidth {
    /// All of them, the least first.
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
