//! Single solids: from the keys of a table to a solid where its pose puts it.

use std::ops::Range;

use glam::DVec3;
use toml::Spanned;

use super::document::Triple;
use super::error::SceneError;
use super::pose::Motion;
use super::settings::vector;
use super::solid_keys::{
    ConeKeys, CuboidKeys, CylinderKeys, DiskKeys, RoundedConeKeys, SolidTable, SphereKeys,
};
use super::source::Source;
use super::values::Number;
use crate::math::Orientation;
use crate::solid::{
    AnySolid, Caps, Cone, ConeError, Cuboid, CuboidError, Cylinder, CylinderError, Disk, DiskError,
    RoundedCone, Sphere, SphereError,
};

/// The table of one kind of solid.
pub(super) trait SolidKeys: SolidTable {
    /// Where to point at when the solid as a whole is meant.
    fn place(&self) -> Range<usize>;

    /// Where it says which ends are closed.
    fn caps_place(&self) -> Option<Range<usize>> {
        None
    }

    /// The solid before its pose.
    fn unmoved(&self, source: &Source) -> Result<AnySolid, SceneError>;

    /// The solid.
    fn solid(&self, source: &Source) -> Result<AnySolid, SceneError> {
        let unmoved = self.unmoved(source)?;
        let motion = Motion::new(source, &self.pose(), self.place())?;
        motion.of_solid(&unmoved, unmoved.center())
    }
}

/// Which ends are closed.
pub(super) fn caps(source: &Source, word: Option<&Spanned<String>>) -> Result<Caps, SceneError> {
    const CAPS: [(&str, Caps); 4] = [
        ("none", Caps::None),
        ("p0", Caps::P0),
        ("p1", Caps::P1),
        ("both", Caps::Both),
    ];
    word.map_or(Ok(Caps::default()), |word| {
        source.choose("caps", word, &CAPS)
    })
}

/// A solid of its kind, or the error told at its place.
fn with_span<S: Into<AnySolid>, E: ToString>(
    source: &Source,
    solid: Result<S, E>,
    place: impl FnOnce(&E) -> Range<usize>,
) -> Result<AnySolid, SceneError> {
    solid
        .map(Into::into)
        .map_err(|error| source.error(place(&error), error.to_string()))
}

impl SolidKeys for CylinderKeys {
    fn place(&self) -> Range<usize> {
        self.p0.span()
    }

    fn caps_place(&self) -> Option<Range<usize>> {
        self.caps.as_ref().map(Spanned::span)
    }

    fn unmoved(&self, source: &Source) -> Result<AnySolid, SceneError> {
        let caps = caps(source, self.caps.as_ref())?;
        let radius = self.radius.get_ref().0;
        let cylinder = Cylinder::new(vector(&self.p0), vector(&self.p1), radius, caps);
        with_span(source, cylinder, |error| match error {
            CylinderError::Endpoint { which: "p0", .. } => self.p0.span(),
            CylinderError::Endpoint { .. } | CylinderError::Length { .. } => self.p1.span(),
            CylinderError::Radius { .. } => self.radius.span(),
        })
    }
}

/// The places of the keys that cones have.
struct ConePlaces<'a>([&'a Triple; 2], [&'a Spanned<Number>; 2]);

impl ConePlaces<'_> {
    /// The place that an error is about.
    fn of(&self, error: &ConeError) -> Range<usize> {
        let Self([p0, p1], [radius0, radius1]) = self;
        match error {
            ConeError::Endpoint { which: "p0", .. } => p0.span(),
            ConeError::Endpoint { .. } | ConeError::Length { .. } => p1.span(),
            ConeError::Radius {
                which: "radius0", ..
            }
            | ConeError::NoRadius => radius0.span(),
            ConeError::Radius { .. } => radius1.span(),
        }
    }
}

impl SolidKeys for ConeKeys {
    fn place(&self) -> Range<usize> {
        self.p0.span()
    }

    fn caps_place(&self) -> Option<Range<usize>> {
        self.caps.as_ref().map(Spanned::span)
    }

    fn unmoved(&self, source: &Source) -> Result<AnySolid, SceneError> {
        let caps = caps(source, self.caps.as_ref())?;
        let [p0, p1] = [&self.p0, &self.p1].map(vector);
        let [radius0, radius1] = [&self.radius0, &self.radius1].map(|radius| radius.get_ref().0);
        let cone = Cone::new(p0, p1, radius0, radius1, caps);
        let places = ConePlaces([&self.p0, &self.p1], [&self.radius0, &self.radius1]);
        with_span(source, cone, |error| places.of(error))
    }
}

impl SolidKeys for RoundedConeKeys {
    fn place(&self) -> Range<usize> {
        self.p0.span()
    }

    fn unmoved(&self, source: &Source) -> Result<AnySolid, SceneError> {
        let [p0, p1] = [&self.p0, &self.p1].map(vector);
        let [radius0, radius1] = [&self.radius0, &self.radius1].map(|radius| radius.get_ref().0);
        let cone = RoundedCone::new(p0, p1, radius0, radius1);
        let places = ConePlaces([&self.p0, &self.p1], [&self.radius0, &self.radius1]);
        with_span(source, cone, |error| places.of(&error.0))
    }
}

impl SolidKeys for SphereKeys {
    fn place(&self) -> Range<usize> {
        self.center.span()
    }

    fn unmoved(&self, source: &Source) -> Result<AnySolid, SceneError> {
        let sphere = Sphere::new(vector(&self.center), self.radius.get_ref().0);
        with_span(source, sphere, |error| match error {
            SphereError::Center { .. } => self.center.span(),
            SphereError::Radius { .. } => self.radius.span(),
        })
    }
}

impl SolidKeys for CuboidKeys {
    fn place(&self) -> Range<usize> {
        self.half_widths.span()
    }

    fn unmoved(&self, source: &Source) -> Result<AnySolid, SceneError> {
        let center = self.center.as_ref().map_or(DVec3::ZERO, vector);
        let cuboid = Cuboid::new(center, vector(&self.half_widths), Orientation::IDENTITY);
        with_span(source, cuboid, |error| match (error, &self.center) {
            (CuboidError::Center { .. }, Some(center)) => center.span(),
            _ => self.half_widths.span(),
        })
    }
}

impl SolidKeys for DiskKeys {
    fn place(&self) -> Range<usize> {
        self.center.span()
    }

    fn unmoved(&self, source: &Source) -> Result<AnySolid, SceneError> {
        let radius = self.radius.get_ref().0;
        let disk = Disk::new(vector(&self.center), vector(&self.normal), radius);
        with_span(source, disk, |error| match error {
            DiskError::Center { .. } => self.center.span(),
            DiskError::Normal { .. } => self.normal.span(),
            DiskError::Radius { .. } => self.radius.span(),
        })
    }
}
