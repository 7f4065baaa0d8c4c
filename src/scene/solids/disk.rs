//! `[[disk]]`

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
use crate::solid::{AnySolid, Disk, DiskError};

solid_table! {
    /// `[[disk]]`
    DiskKeys {
        center: Triple,
        normal: Triple,
        radius: Spanned<Number>,
    }
}

impl Stored for Disk {
    type List = Vec<SolidRecord<Self>>;
}

impl SceneSolid for Disk {
    type Keys = DiskKeys;
    type Error = DiskError;

    fn moved(&self, motion: &RigidMotion) -> Result<Self, DiskError> {
        let normal = motion.direction(self.normal());
        Self::new(motion.point(self.center()), normal, self.radius())
    }

    fn state(&self, entry: &mut Entry) {
        entry.vector("center", self.center());
        entry.vector("normal", self.normal());
        entry.number("radius", self.radius());
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
