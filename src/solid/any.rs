//! A solid of whichever kind.

use glam::DVec3;

use super::{Caps, Cone, Cuboid, Cylinder, Disk, RoundedCone, SolidKind, Sphere};

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

    /// Its own centre, about which it is turned: the middle of the axis, where it
    /// has one, rounded.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        // Halves are exact, so only their sum is rounded.
        let middle = |p0: DVec3, p1: DVec3| p0 * 0.5 + p1 * 0.5;
        match self {
            Self::Cylinder(cylinder) => middle(cylinder.p0(), cylinder.p1()),
            Self::Cone(cone) => middle(cone.p0(), cone.p1()),
            Self::RoundedCone(cone) => middle(cone.p0(), cone.p1()),
            Self::Sphere(sphere) => sphere.centre(),
            Self::Cuboid(cuboid) => cuboid.centre(),
            Self::Disk(disk) => disk.centre(),
        }
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

    /// At least the size of every coordinate of its points, but for roundings.
    #[must_use]
    pub fn reach(&self) -> f64 {
        let size = |point: DVec3| point.abs().max_element();
        let along = |p0, p1, radius: f64| size(p0).max(size(p1)) + radius;
        match self {
            Self::Cylinder(cylinder) => along(cylinder.p0(), cylinder.p1(), cylinder.radius()),
            Self::Cone(cone) => along(cone.p0(), cone.p1(), cone.radius0().max(cone.radius1())),
            Self::RoundedCone(cone) => {
                along(cone.p0(), cone.p1(), cone.radius0().max(cone.radius1()))
            }
            Self::Sphere(sphere) => size(sphere.centre()) + sphere.radius(),
            Self::Cuboid(cuboid) => size(cuboid.centre()) + cuboid.half_widths().length(),
            Self::Disk(disk) => size(disk.centre()) + disk.radius(),
        }
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
