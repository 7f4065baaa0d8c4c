//! `[[cuboid]]`

use std::ops::Range;

use glam::{DMat3, DVec3};
use toml::Spanned;

use super::{SceneSolid, SolidKeys, with_span};
use crate::math::Orientation;
use crate::scene::error::SceneError;
use crate::scene::record::SolidRecord;
use crate::scene::rigid_motion::RigidMotion;
use crate::scene::save::Entry;
use crate::scene::solid_keys::solid_table;
use crate::scene::solid_lists::Stored;
use crate::scene::source::Source;
use crate::scene::values::{List, Number, Triple, vector};
use crate::solid::{AnySolid, Cuboid, CuboidError};

solid_table! {
    /// `[[cuboid]]`
    CuboidKeys {
        center: Option<Triple>,
        half_widths: Triple,
        axes: Option<Spanned<List<List<Number, 3>, 3>>>,
    }
}

impl Stored for Cuboid {
    type List = Vec<SolidRecord<Self>>;
}

impl SceneSolid for Cuboid {
    type Keys = CuboidKeys;
    type Error = CuboidError;

    fn moved(&self, motion: &RigidMotion) -> Result<Self, CuboidError> {
        let orientation = motion.orientation(self.orientation());
        Self::new(motion.point(self.center()), self.half_widths(), orientation)
    }

    fn state(&self, entry: &mut Entry) {
        entry.vector("center", self.center());
        entry.vector("half_widths", self.half_widths());
        let axes = self.orientation().world_from_object();
        let bits = |axes: DMat3| axes.to_cols_array().map(f64::to_bits);
        if bits(axes) != bits(DMat3::IDENTITY) {
            entry.rows("axes", axes.to_cols_array_2d());
        }
    }
}

impl SolidKeys for CuboidKeys {
    fn place(&self) -> Range<usize> {
        self.half_widths.span()
    }

    fn unmoved(&self, source: &Source) -> Result<AnySolid, SceneError> {
        let center = self.center.as_ref().map_or(DVec3::ZERO, vector);
        let orientation = self.axes.as_ref().map(|axes| {
            let [x, y, z] = axes
                .get_ref()
                .0
                .map(|List(axis)| DVec3::from(axis.map(|number| number.0)));
            Orientation::from_axes(x, y, z).ok_or_else(|| {
                source.error_with_help(
                    axes.span(),
                    "the axes are not orthonormal and right-handed to within the roundings of f64",
                    "rotate_x, rotate_y, rotate_z and rotate turn a cuboid by degrees",
                )
            })
        });
        let orientation = orientation.transpose()?.unwrap_or_default();
        let cuboid = Cuboid::new(center, vector(&self.half_widths), orientation);
        with_span(source, cuboid, |error| match (error, &self.center) {
            (CuboidError::Center { .. }, Some(center)) => center.span(),
            _ => self.half_widths.span(),
        })
    }
}
