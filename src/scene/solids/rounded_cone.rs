//! `[[rounded_cone]]`

use std::ops::Range;

use toml::Spanned;

use super::cone::ConePlaces;
use super::{SceneSolid, SolidKeys, with_span};
use crate::scene::error::SceneError;
use crate::scene::record::SolidRecord;
use crate::scene::rigid_motion::RigidMotion;
use crate::scene::save::Entry;
use crate::scene::solid_keys::solid_table;
use crate::scene::solid_lists::Stored;
use crate::scene::source::Source;
use crate::scene::values::{Number, Triple, vector};
use crate::solid::{AnySolid, RoundedCone, RoundedConeError};

solid_table! {
    /// `[[rounded_cone]]`
    RoundedConeKeys {
        p0: Triple,
        p1: Triple,
        radius0: Spanned<Number>,
        radius1: Spanned<Number>,
    }
}

impl Stored for RoundedCone {
    type List = Vec<SolidRecord<Self>>;
}

impl SceneSolid for RoundedCone {
    type Keys = RoundedConeKeys;
    type Error = RoundedConeError;

    fn moved(&self, motion: &RigidMotion) -> Result<Self, RoundedConeError> {
        let [p0, p1] = [self.p0(), self.p1()].map(|end| motion.point(end));
        Self::new(p0, p1, self.radius0(), self.radius1())
    }

    fn state(&self, entry: &mut Entry) {
        entry.vector("p0", self.p0());
        entry.vector("p1", self.p1());
        entry.number("radius0", self.radius0());
        entry.number("radius1", self.radius1());
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
