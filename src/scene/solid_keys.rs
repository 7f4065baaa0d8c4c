//! The keys of solids in a scene file, as they stand there.

use serde::Deserialize;
use serde::de::IgnoredAny;
use toml::Spanned;

use super::document::{ThreeColumns, Triple};
use super::table::ColumnKey;
use super::values::{Keys, Number};

/// How an object is turned and moved.
#[derive(Clone, Copy)]
pub(super) struct PoseKeys<'a> {
    /// Degrees about x, y and z, applied in this order and before the others.
    pub about_axes: [Option<Number>; 3],
    pub rotate: &'a [Keys<RotationKeys>],
    pub translate: Option<&'a Triple>,
}

/// One rotation of `rotate`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RotationKeys {
    pub axis: Triple,
    pub degrees: Number,
}

/// What every solid's table has.
pub(super) trait SolidTable {
    fn material(&self) -> Option<&Spanned<String>>;
    fn pose(&self) -> PoseKeys<'_>;
}

/// Declares the keys of a solid's table, those that every solid has behind its own,
/// because serde cannot refuse unknown keys in a flattened struct.
macro_rules! solid_table {
    ($(#[$meta:meta])* $name:ident { $(pub $key:ident: $kind:ty,)* }) => {
        $(#[$meta])*
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $name {
            $(pub $key: $kind,)*
            material: Option<Spanned<String>>,
            rotate_x: Option<Number>,
            rotate_y: Option<Number>,
            rotate_z: Option<Number>,
            rotate: Option<Vec<Keys<RotationKeys>>>,
            translate: Option<Triple>,
        }

        impl SolidTable for $name {
            fn material(&self) -> Option<&Spanned<String>> {
                self.material.as_ref()
            }

            fn pose(&self) -> PoseKeys<'_> {
                PoseKeys {
                    about_axes: [self.rotate_x, self.rotate_y, self.rotate_z],
                    rotate: self.rotate.as_deref().unwrap_or_default(),
                    translate: self.translate.as_ref(),
                }
            }
        }
    };
}

solid_table! {
    /// `[[cylinder]]`
    CylinderKeys {
        pub p0: Triple,
        pub p1: Triple,
        pub radius: Spanned<Number>,
        pub caps: Option<Spanned<String>>,
    }
}

solid_table! {
    /// `[[cone]]`
    ConeKeys {
        pub p0: Triple,
        pub p1: Triple,
        pub radius0: Spanned<Number>,
        pub radius1: Spanned<Number>,
        pub caps: Option<Spanned<String>>,
    }
}

solid_table! {
    /// `[[rounded_cone]]`
    RoundedConeKeys {
        pub p0: Triple,
        pub p1: Triple,
        pub radius0: Spanned<Number>,
        pub radius1: Spanned<Number>,
    }
}

solid_table! {
    /// `[[sphere]]`
    SphereKeys {
        pub center: Triple,
        pub radius: Spanned<Number>,
    }
}

solid_table! {
    /// `[[cuboid]]`
    CuboidKeys {
        pub center: Option<Triple>,
        pub half_widths: Triple,
    }
}

solid_table! {
    /// `[[disk]]`
    DiskKeys {
        pub center: Triple,
        pub normal: Triple,
        pub radius: Spanned<Number>,
    }
}

solid_table! {
    /// `[[union]]`, `[[intersection]]`, `[[difference]]`
    CompositionKeys {
        pub of: Spanned<Vec<Spanned<Keys<OperandKeys>>>>,
    }
}

/// An operand of a set operation: one of these.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OperandKeys {
    pub cylinder: Option<Keys<CylinderKeys>>,
    pub cone: Option<Keys<ConeKeys>>,
    pub rounded_cone: Option<Keys<RoundedConeKeys>>,
    pub sphere: Option<Keys<SphereKeys>>,
    pub cuboid: Option<Keys<CuboidKeys>>,
    pub union: Option<Keys<CompositionKeys>>,
    pub intersection: Option<Keys<CompositionKeys>>,
    pub difference: Option<Keys<CompositionKeys>>,
    /// No operand, but worth a message of its own.
    pub disk: Option<Spanned<IgnoredAny>>,
}

/// `[[cylinder_table]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CylinderTableKeys {
    pub file: Spanned<String>,
    pub columns: Spanned<Keys<CylinderColumns>>,
    pub delimiter: Option<Spanned<String>>,
    pub decimal: Option<Spanned<String>>,
    pub degenerate: Option<Spanned<String>>,
    pub caps: Option<Spanned<String>>,
    pub material: Option<Spanned<String>>,
}

/// `columns` of `[[cylinder_table]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CylinderColumns {
    #[serde(alias = "start")]
    pub p0: ThreeColumns,
    pub p1: Option<ThreeColumns>,
    pub axis: Option<ThreeColumns>,
    pub length: Option<Spanned<ColumnKey>>,
    pub radius: Option<Spanned<ColumnKey>>,
    pub diameter: Option<Spanned<ColumnKey>>,
}

/// `[[swc]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SwcKeys {
    pub file: Spanned<String>,
    pub joints: Option<Spanned<String>>,
    pub soma: Option<Spanned<String>>,
    pub degenerate: Option<Spanned<String>>,
    pub caps: Option<Spanned<String>>,
    pub material: Option<Spanned<String>>,
}

/// `[[beam_lattice]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BeamLatticeKeys {
    pub file: Spanned<String>,
    pub unit: Option<Spanned<String>>,
    pub meshes: Option<Spanned<String>>,
    pub degenerate: Option<Spanned<String>>,
    pub material: Option<Spanned<String>>,
}
