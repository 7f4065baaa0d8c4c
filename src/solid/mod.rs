//! Solids, and the solvers that intersect rays with them.

mod any;
mod ball;
mod chord;
mod composition;
mod cone;
mod convex;
mod counts;
mod cuboid;
mod cylinder;
mod disk;
pub mod exact;
pub mod lanes;
mod linear;
mod offset;
pub mod quick;
mod registry;
mod reject;
mod rounded_cone;
pub mod settled;
pub mod slab;
mod spawn;
mod sphere;
mod surface;
pub mod tessellation;
mod ties;
pub mod triple_product;

pub use any::AnySolid;
pub use chord::{Chord, ChordEnd, Intersection};
pub use composition::{ComposedIntersection, Composition, Operand};
pub use cone::{Cone, ConeError};
pub use convex::{ConvexSolid, Location};
pub use counts::SolidCounts;
pub use cuboid::{Cuboid, CuboidError};
pub use cylinder::{Caps, Cylinder, CylinderError};
pub use disk::{Disk, DiskError};
pub use offset::RayOrigin;
pub use registry::{SolidKind, UnknownSolid};
pub use rounded_cone::{RoundedCone, RoundedConeError};
pub use spawn::{SpawnMargin, spawned_ray};
pub use sphere::{Sphere, SphereError};
pub use surface::{SurfacePoint, angle_frame, surface_point};

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
