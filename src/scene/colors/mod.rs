//! Colors of surfaces that differ from place to place: patterns and images over the parameters
//! of a surface, and colors that show data.
//!
//! `keys` reads the key `color` of a material, with `key_types`; `pattern` has checkers and stripes, `texture`
//! images, `srgb` the decoding of their codes. `data` is a color that shows the values of a
//! column through a `map`; `value_list` stores the values of a prototype's solids or placements,
//! and `columns` tracks, while a scene is loaded, which columns are read and found.

mod columns;
mod data;
mod key_types;
mod keys;
mod map;
mod pattern;
mod srgb;
mod texture;
mod value_list;

pub(super) use columns::{DataColumn, DataColumns, Found, ValueKeys, union};
pub use data::DataColor;
pub(super) use key_types::ColorKeys;
pub(super) use keys::{color, reflectance};
pub use map::ColorMap;
pub use pattern::{Along, Checker, Stripes};
pub(super) use texture::header_bytes;
pub use texture::{Texture, TextureError};
pub use value_list::{PlacementValues, ValueList};
