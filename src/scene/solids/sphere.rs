//! `[[sphere]]`

use std::ops::Range;

use toml::Spanned;

use super::{SceneSolid, SolidKeys, with_span};
use crate::scene::error::SceneError;
use crate::scene::record::SolidRecord;
use crate::scene::rigid_motion::RigidMotion;
use crate::scene::save::Entry;
use crate::scene::solid_keys::solid_table;
use crate::scene::solid_lists::Stored;
use crate::scene::source::Source;
use crate::scene::values::{Number, Triple, vector};
use crate::solid::{AnySolid, Sphere, SphereError};

solid_table! {
    /// `[[sphere]]`
    SphereKeys {
        center: Triple,
        radius: Spanned<Number>,
    }
}

impl Stored for Sphere {
    type List = Vec<SolidRecord<Self>>;
}

impl SceneSolid for Sphere {
    type Keys = SphereKeys;
    type Error = SphereError;

    fn moved(&self, motion: &RigidMotion) -> Result<Self, SphereError> {
        Self::new(motion.point(self.center()), self.radius())
    }

    fn state(&self, entry: &mut Entry) {
        entry.vector("center", self.center());
        entry.number("radius", self.radius());
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
