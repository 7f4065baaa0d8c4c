//! Names of what a ray hits: the parts of a surface, the ends that are closed, the direction of
//! a crossing.

/// The ends of a cylinder that are closed by a disk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Caps {
    /// A tube, open at both ends.
    None,
    /// A disk at `p0` only.
    P0,
    /// A disk at `p1` only.
    P1,
    /// Disks at both ends.
    #[default]
    Both,
}

impl Caps {
    /// The caps with disks at the given ends.
    #[must_use]
    pub fn at(p0: bool, p1: bool) -> Self {
        match (p0, p1) {
            (false, false) => Self::None,
            (true, false) => Self::P0,
            (false, true) => Self::P1,
            (true, true) => Self::Both,
        }
    }

    /// Whether there is a disk at `p0`.
    #[must_use]
    pub fn at_p0(self) -> bool {
        matches!(self, Self::P0 | Self::Both)
    }

    /// Whether there is a disk at `p1`.
    #[must_use]
    pub fn at_p1(self) -> bool {
        matches!(self, Self::P1 | Self::Both)
    }
}

/// A part of a solid's surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Part {
    /// The curved wall; for a sphere or a disk, all of it.
    Side,
    /// The disk at `p0` with its rim; for a rounded cone, the sphere there.
    Cap0,
    /// The disk at `p1` with its rim; for a rounded cone, the sphere there.
    Cap1,
    /// The face of a cuboid at its own least x.
    XMin,
    /// The face at the greatest x.
    XMax,
    /// The face at the least y.
    YMin,
    /// The face at the greatest y.
    YMax,
    /// The face at the least z.
    ZMin,
    /// The face at the greatest z.
    ZMax,
    /// The inside of a solid where a clip plane cuts it.
    Cut,
}

impl Part {
    /// The name in the `part` column of `trace`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Side => "side",
            Self::Cap0 => "cap0",
            Self::Cap1 => "cap1",
            Self::XMin => "x-",
            Self::XMax => "x+",
            Self::YMin => "y-",
            Self::YMax => "y+",
            Self::ZMin => "z-",
            Self::ZMax => "z+",
            Self::Cut => "cut",
        }
    }

    /// The panic of code for cylinders alone.
    #[cold]
    pub(crate) fn not_of_a_cylinder(self) -> ! {
        unreachable!("a cylinder has no part {}", self.name())
    }
}

/// Whether a ray enters or leaves a solid as `t` grows.
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
