//! A solid of any kind.

use glam::DVec3;

use super::{Chord, ConvexSolid, Location, Part, SolidKind, SpawnMargin, SurfacePoint};
use crate::math::Bounds;
use crate::{for_each_solid, with_solid};

macro_rules! any_solid {
    ($({ $type:ident $name:ident $list:ident $code:literal $description:literal })*) => {
        /// A solid of any kind, for a few solids of mixed kinds: each list of a scene contains
        /// one kind. [`with_solid!`](crate::with_solid) matches it.
        ///
        /// A new kind is a new variant. A match without a wildcard then fails to compile, which
        /// is intended.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum AnySolid {
            $(#[doc = $description] $type(super::$type),)*
        }

        impl AnySolid {
            /// Its kind.
            #[must_use]
            pub fn kind(&self) -> SolidKind {
                match self {
                    $(Self::$type(_) => SolidKind::$type,)*
                }
            }
        }

        $(impl From<super::$type> for AnySolid {
            fn from(solid: super::$type) -> Self {
                Self::$type(solid)
            }
        })*
    };
}

for_each_solid!(any_solid);

impl AnySolid {
    /// As [`ConvexSolid::radius`].
    #[must_use]
    pub fn radius(&self) -> f64 {
        with_solid!(self, solid => ConvexSolid::radius(solid))
    }

    /// As [`ConvexSolid::center`].
    #[must_use]
    pub fn center(&self) -> DVec3 {
        with_solid!(self, solid => ConvexSolid::center(solid))
    }

    /// As [`ConvexSolid::anchor`].
    #[must_use]
    pub fn anchor(&self) -> DVec3 {
        with_solid!(self, solid => solid.anchor())
    }

    /// As [`ConvexSolid::chord`].
    #[must_use]
    pub fn chord(&self, from_anchor: DVec3, direction: DVec3) -> Option<Chord> {
        with_solid!(self, solid => solid.chord(from_anchor, direction))
    }

    /// As [`ConvexSolid::rejects`].
    #[must_use]
    pub fn rejects(&self, from_anchor: DVec3, direction: DVec3) -> bool {
        with_solid!(self, solid => solid.rejects(from_anchor, direction))
    }

    /// As [`ConvexSolid::surface_point`].
    #[must_use]
    pub fn surface_point(&self, part: Part, from_anchor: DVec3) -> SurfacePoint {
        with_solid!(self, solid => solid.surface_point(part, from_anchor))
    }

    /// As [`ConvexSolid::locate`].
    #[must_use]
    pub fn locate(&self, point: DVec3) -> Location {
        with_solid!(self, solid => solid.locate(point))
    }

    /// As [`ConvexSolid::is_on`].
    #[must_use]
    pub fn is_on(&self, part: Part, point: DVec3) -> bool {
        with_solid!(self, solid => solid.is_on(part, point))
    }

    /// As [`ConvexSolid::size`].
    #[must_use]
    pub fn size(&self) -> f64 {
        with_solid!(self, solid => solid.size())
    }

    /// As [`SpawnMargin::of_solid`].
    #[must_use]
    pub fn spawn_margin(&self, surface: &SurfacePoint) -> SpawnMargin {
        with_solid!(self, solid => SpawnMargin::of_solid(solid, surface))
    }

    /// As [`ConvexSolid::is_closed`].
    #[must_use]
    pub fn is_closed(&self) -> bool {
        with_solid!(self, solid => solid.is_closed())
    }

    /// As [`ConvexSolid::bounds`].
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        with_solid!(self, solid => ConvexSolid::bounds(solid))
    }
}
