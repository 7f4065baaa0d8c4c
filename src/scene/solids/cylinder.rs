//! `[[cylinder]]`

use std::ops::Range;

use toml::Spanned;

use super::{SceneSolid, SolidKeys, caps, with_span};
use crate::scene::cylinder_list::CylinderList;
use crate::scene::error::SceneError;
use crate::scene::rigid_motion::RigidMotion;
use crate::scene::save::Entry;
use crate::scene::solid_keys::solid_table;
use crate::scene::solid_lists::Stored;
use crate::scene::source::Source;
use crate::scene::values::{Number, Triple, vector};
use crate::solid::{AnySolid, Cylinder, CylinderError};

solid_table! {
    /// `[[cylinder]]`
    CylinderKeys {
        p0: Triple,
        p1: Triple,
        radius: Spanned<Number>,
        caps: Option<Spanned<String>>,
    }
}

impl Stored for Cylinder {
    type List = CylinderList;
}

impl SceneSolid for Cylinder {
    type Keys = CylinderKeys;
    type Error = CylinderError;

    fn moved(&self, motion: &RigidMotion) -> Result<Self, CylinderError> {
        let [p0, p1] = [self.p0(), self.p1()].map(|end| motion.point(end));
        Self::new(p0, p1, self.radius(), self.caps())
    }

    fn state(&self, entry: &mut Entry) {
        entry.vector("p0", self.p0());
        entry.vector("p1", self.p1());
        entry.number("radius", self.radius());
        entry.caps(self.caps());
    }
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
