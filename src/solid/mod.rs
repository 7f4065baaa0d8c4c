//! What a solid is, and the solvers that intersect rays with it.

mod chord;
mod cylinder;
pub mod exact;
pub mod formulations;
pub mod lanes;
mod slab;
mod spawn;
mod surface;
pub mod tessellation;
pub mod triple_product;

pub use chord::{Chord, ChordEnd, Meeting};
pub use cylinder::{Caps, Cylinder, CylinderError};
pub use spawn::{SpawnMargin, spawned_ray};
pub use surface::{SurfacePoint, surface_point};

/// The kinds of solids; [`SolidKind::name`] is the `solid` column of `trace`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SolidKind {
    /// A circular cylinder, see [`Cylinder`].
    Cylinder,
}

impl SolidKind {
    /// The name in files and tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Cylinder => "cylinder",
        }
    }
}

/// The part of a solid's surface that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Part {
    /// The curved wall.
    Side,
    /// The disc at `p0`, its rim included.
    Cap0,
    /// The disc at `p1`, its rim included.
    Cap1,
}

impl Part {
    /// The name in the `part` column of `trace`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Side => "side",
            Self::Cap0 => "cap0",
            Self::Cap1 => "cap1",
        }
    }
}

/// Whether a ray goes into a solid or out of it as `t` grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Crossing {
    /// From outside to inside.
    Enter,
    /// From inside to outside.
    Leave,
}

impl Crossing {
    /// The name in the `crossing` column of `trace`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Enter => "enter",
            Self::Leave => "leave",
        }
    }
}
