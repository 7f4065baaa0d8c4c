//! `[[cone]]`

use std::ops::Range;

use toml::Spanned;

use super::{SceneSolid, SolidKeys, caps, with_span};
use crate::scene::error::SceneError;
use crate::scene::record::SolidRecord;
use crate::scene::rigid_motion::RigidMotion;
use crate::scene::save::Entry;
use crate::scene::solid_keys::solid_table;
use crate::scene::solid_lists::Stored;
use crate::scene::source::Source;
use crate::scene::values::{Number, Triple, vector};
use crate::solid::{AnySolid, Cone, ConeError};

solid_table! {
    /// `[[cone]]`
    ConeKeys {
        p0: Triple,
        p1: Triple,
        radius0: Spanned<Number>,
        radius1: Spanned<Number>,
        caps: Option<Spanned<String>>,
    }
}

/// The places of the keys shared by cones and rounded cones.
pub(super) struct ConePlaces<'a>(pub [&'a Triple; 2], pub [&'a Spanned<Number>; 2]);

impl ConePlaces<'_> {
    /// The place of an error.
    pub fn of(&self, error: &ConeError) -> Range<usize> {
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

impl Stored for Cone {
    type List = Vec<SolidRecord<Self>>;
}

impl SceneSolid for Cone {
    type Keys = ConeKeys;
    type Error = ConeError;

    fn moved(&self, motion: &RigidMotion) -> Result<Self, ConeError> {
        let [p0, p1] = [self.p0(), self.p1()].map(|end| motion.point(end));
        Self::new(p0, p1, self.radius0(), self.radius1(), self.caps())
    }

    fn state(&self, entry: &mut Entry) {
        entry.vector("p0", self.p0());
        entry.vector("p1", self.p1());
        entry.number("radius0", self.radius0());
        entry.number("radius1", self.radius1());
        entry.caps(self.caps());
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
