//! The keys that the tables of all solids have, as written.

use serde::Deserialize;
use toml::Spanned;

use super::colors::ValueKeys;
use super::values::{Keys, Number, Triple, Whole};
use crate::solid::Caps;

/// The keys of a solid's rotations and translation.
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

/// The names of closed ends.
pub(super) const CAPS: [(&str, Caps); 4] = [
    ("none", Caps::None),
    ("p0", Caps::P0),
    ("p1", Caps::P1),
    ("both", Caps::Both),
];

/// The keys that every solid's table has.
pub(super) trait SolidTable {
    fn material(&self) -> Option<&Spanned<String>>;
    fn primitive(&self) -> Option<&Spanned<Whole>>;
    fn values(&self) -> Option<&Spanned<ValueKeys>>;
    fn pose(&self) -> PoseKeys<'_>;
}

/// Declares the keys of a solid's table, followed by the keys that every solid has,
/// because serde cannot reject unknown keys in a flattened struct.
macro_rules! solid_table {
    ($(#[$meta:meta])* $name:ident { $($key:ident: $kind:ty,)* }) => {
        $(#[$meta])*
        #[derive(serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(in crate::scene) struct $name {
            $($key: $kind,)*
            material: Option<toml::Spanned<String>>,
            primitive: Option<toml::Spanned<$crate::scene::values::Whole>>,
            values: Option<toml::Spanned<$crate::scene::colors::ValueKeys>>,
            rotate_x: Option<$crate::scene::values::Number>,
            rotate_y: Option<$crate::scene::values::Number>,
            rotate_z: Option<$crate::scene::values::Number>,
            rotate: Option<Vec<$crate::scene::values::Keys<$crate::scene::solid_keys::RotationKeys>>>,
            translate: Option<$crate::scene::values::Triple>,
        }

        impl $crate::scene::solid_keys::SolidTable for $name {
            fn material(&self) -> Option<&toml::Spanned<String>> {
                self.material.as_ref()
            }

            fn primitive(&self) -> Option<&toml::Spanned<$crate::scene::values::Whole>> {
                self.primitive.as_ref()
            }

            fn values(&self) -> Option<&toml::Spanned<$crate::scene::colors::ValueKeys>> {
                self.values.as_ref()
            }

            fn pose(&self) -> $crate::scene::solid_keys::PoseKeys<'_> {
                $crate::scene::solid_keys::PoseKeys {
                    about_axes: [self.rotate_x, self.rotate_y, self.rotate_z],
                    rotate: self.rotate.as_deref().unwrap_or_default(),
                    translate: self.translate.as_ref(),
                }
            }
        }
    };
}

pub(super) use solid_table;
