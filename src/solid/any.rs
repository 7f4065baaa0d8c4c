//! A solid of whichever kind.

use glam::DVec3;

use super::{
    Caps, Chord, Cone, ConvexSolid, Cuboid, Cylinder, Disk, Location, Part, RoundedCone, SolidKind,
    SpawnMargin, Sphere, SurfacePoint,
};
use crate::math::Bounds;

/// A solid of whichever kind, where kinds are mixed and few: each list of a scene
/// is of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnySolid {
    /// A circular cylinder.
    Cylinder(Cylinder),
    /// A part of a circular cone.
    Cone(Cone),
    /// Two balls and what is between them.
    RoundedCone(RoundedCone),
    /// A ball.
    Sphere(Sphere),
    /// A box.
    Cuboid(Cuboid),
    /// A flat disk.
    Disk(Disk),
}

/// The same of a solid, whatever its kind is.
macro_rules! of_each {
    ($any:expr, $solid:ident => $what:expr) => {
        match $any {
            Self::Cylinder($solid) => $what,
            Self::Cone($solid) => $what,
            Self::RoundedCone($solid) => $what,
            Self::Sphere($solid) => $what,
            Self::Cuboid($solid) => $what,
            Self::Disk($solid) => $what,
        }
    };
}

impl AnySolid {
    /// Which kind it is of.
    #[must_use]
    pub fn kind(&self) -> SolidKind {
        match self {
            Self::Cylinder(_) => SolidKind::Cylinder,
            Self::Cone(_) => SolidKind::Cone,
            Self::RoundedCone(_) => SolidKind::RoundedCone,
            Self::Sphere(_) => SolidKind::Sphere,
            Self::Cuboid(_) => SolidKind::Cuboid,
            Self::Disk(_) => SolidKind::Disk,
        }
    }

    /// The radius of its thickest part; of a cuboid half of its least width.
    #[must_use]
    pub fn radius(&self) -> f64 {
        match self {
            Self::Cylinder(one) => one.radius(),
            Self::Cone(one) => one.radius0().max(one.radius1()),
            Self::RoundedCone(one) => one.radius0().max(one.radius1()),
            Self::Sphere(one) => one.radius(),
            Self::Cuboid(one) => one.half_widths().min_element(),
            Self::Disk(one) => one.radius(),
        }
    }

    /// Its own center, about which it is turned: the middle of the axis, where it
    /// has one, rounded.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        // Halves are exact, so only their sum is rounded.
        let middle = |p0: DVec3, p1: DVec3| p0 * 0.5 + p1 * 0.5;
        match self {
            Self::Cylinder(cylinder) => middle(cylinder.p0(), cylinder.p1()),
            Self::Cone(cone) => middle(cone.p0(), cone.p1()),
            Self::RoundedCone(cone) => middle(cone.p0(), cone.p1()),
            Self::Sphere(sphere) => sphere.center(),
            Self::Cuboid(cuboid) => cuboid.center(),
            Self::Disk(disk) => disk.center(),
        }
    }

    /// As [`ConvexSolid::anchor`].
    #[must_use]
    pub fn anchor(&self) -> DVec3 {
        of_each!(self, solid => solid.anchor())
    }

    /// As [`ConvexSolid::chord`].
    #[must_use]
    pub fn chord(&self, from_anchor: DVec3, direction: DVec3) -> Option<Chord> {
        of_each!(self, solid => solid.chord(from_anchor, direction))
    }

    /// As [`ConvexSolid::rejects`].
    #[must_use]
    pub fn rejects(&self, from_anchor: DVec3, direction: DVec3) -> bool {
        of_each!(self, solid => solid.rejects(from_anchor, direction))
    }

    /// As [`ConvexSolid::surface_point`].
    #[must_use]
    pub fn surface_point(&self, part: Part, from_anchor: DVec3) -> SurfacePoint {
        of_each!(self, solid => solid.surface_point(part, from_anchor))
    }

    /// As [`ConvexSolid::locate`].
    #[must_use]
    pub fn locate(&self, point: DVec3) -> Location {
        of_each!(self, solid => solid.locate(point))
    }

    /// Whether a point of the boundary is on the surface of a part, exactly. A point on an
    /// edge is on that of several.
    #[must_use]
    pub(super) fn is_on(&self, part: Part, point: DVec3) -> bool {
        match self {
            Self::Cylinder(cylinder) => cylinder.as_cone().is_on(part, point),
            Self::Cone(cone) => cone.is_on(part, point),
            Self::RoundedCone(cone) => cone.is_on(part, point),
            Self::Cuboid(cuboid) => cuboid.is_on(part, point),
            Self::Sphere(_) | Self::Disk(_) => part == Part::Side,
        }
    }

    /// As [`ConvexSolid::size`].
    #[must_use]
    pub fn size(&self) -> f64 {
        of_each!(self, solid => solid.size())
    }

    /// As [`SpawnMargin::of_solid`].
    #[must_use]
    pub fn spawn_margin(&self, surface: &SurfacePoint) -> SpawnMargin {
        of_each!(self, solid => SpawnMargin::of_solid(solid, surface))
    }

    /// Whether its surface is the boundary of a solid with an inside.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        match self {
            Self::Cylinder(cylinder) => cylinder.caps() == Caps::Both,
            Self::Cone(cone) => cone.caps() == Caps::Both,
            Self::RoundedCone(_) | Self::Sphere(_) | Self::Cuboid(_) => true,
            Self::Disk(_) => false,
        }
    }

    /// A box that holds it, rounded outward.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        of_each!(self, solid => solid.bounds())
    }
}

macro_rules! from_kinds {
    ($($kind:ident)*) => {$(
        impl From<$kind> for AnySolid {
            fn from(solid: $kind) -> Self {
                Self::$kind(solid)
            }
        }
    )*};
}

from_kinds!(Cylinder Cone RoundedCone Sphere Cuboid Disk);
