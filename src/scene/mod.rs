//! The scene as the user states it, in f64, and the files it is read from.
//!
//! [`load`] reads a scene file in TOML (`docs/scene-file.md`) in three steps:
//!
//! 1. `document` contains the keys as written, with their places.
//! 2. The entries are turned into solids, placements and settings, one kind in each
//!    file: `solids` with their `pose`, `set_operations`, the `formats` of files,
//!    `placing`, `scatter`, `camera`, `materials` with `material_kinds` and `colors`,
//!    `placed_lights`, `environment_file`, `clear_sky` and `settings`, with `light_values`, and
//!    `legend_keys` and `illustration_keys`, with `inset_keys`. Rows
//!    of tables are streamed;
//!    `named_table` opens the tables and `table` reads them. `solid_collector` collects
//!    and numbers the solids of a prototype.
//! 3. `graph` checks how prototypes place each other.
//!
//! `scene_file` is the state after the first step; `contents` counts what loading will
//! make, so that a scene that is too large is rejected early. `record` is what is stored of
//! a solid; `cylinder_list` stores cylinders in f64 or f32, and `solid_lists` the other
//! kinds; `aimed_camera` aims the camera. The result is a [`Scene`] that needs no further
//! checks and does not depend on files. [`save`] writes it as such files.
//!
//! `number_table` and `hit_table` read other tables: rays, points, and the hits of another
//! program.

mod aimed_camera;
mod background;
mod camera;
mod clear_sky;
mod clip;
mod clip_keys;
mod colors;
mod contents;
mod cylinder_list;
mod defaults;
mod description;
mod document;
mod environment;
mod environment_file;
mod error;
mod formats;
mod graph;
mod hit_table;
mod illustration;
mod illustration_keys;
mod inset;
mod inset_keys;
mod instance_rows;
mod legend;
mod legend_keys;
mod light;
mod light_values;
mod limits;
mod lines;
mod load;
mod material;
mod material_kinds;
mod materials;
mod named_table;
mod names;
mod number_table;
mod origins;
mod placed_lights;
mod placing;
mod point;
mod pose;
mod record;
mod regular_file;
mod rigid_motion;
mod save;
mod scatter;
mod scene_file;
mod scene_stats;
mod set_operations;
mod settings;
mod solid_collector;
mod solid_keys;
mod solid_lists;
mod solids;
mod source;
mod table;
mod toml_message;
mod transform;
mod values;
mod view_volume;

pub use aimed_camera::AimedCamera;
pub use background::Background;
pub use clip::Clip;
pub use colors::{
    Along, Checker, ColorMap, DataColor, PlacementValues, Stripes, Texture, TextureError, ValueList,
};
pub use contents::{ExpectedCounts, ExpectedSolids, PlacedCount};
pub(crate) use cylinder_list::SharedRecords;
pub use cylinder_list::{CylinderList, Iter as CylinderIter};
pub use description::{
    Camera, Film, Frame, Integrator, Lens, Placement, Projection, Prototype, PrototypeIndex,
    RenderSettings, Sampler, Scene,
};
pub use environment::{Environment, EnvironmentError};
pub use error::{SceneError, Statement};
pub use formats::{SOLID_FORMATS, SolidFormatInfo, beams_of_model, check_swc};
pub use hit_table::{GivenHit, GivenHits};
pub use illustration::{Axes, DepthCue, Illustration, Outlines, ScaleBar};
pub use inset::{Corner, Inset};
pub use legend::Legend;
pub use light::{ClearSky, Light, LightShape, Sky, Sun};
pub use limits::*;
pub use material::{Color, Material, MaterialKind};
pub use number_table::{NumberColumns, NumberRow, NumberTable};
pub use origins::{Origin, Origins};
pub use record::{
    CompositionRecord, CylinderRecord, CylinderRecord32, MaterialIndex, Records, SolidRecord,
};
pub use save::{SaveError, save};
pub use scene_file::{SceneFile, load};
pub use scene_stats::SceneStats;
pub use solid_lists::{Listed, SolidList, Solids, Stored};
pub use table::{
    Block, Column, ColumnKey, Decimal, Delimiter, Fault, Layout, Row, Rows, Table, TableFormat,
};
pub use view_volume::ViewVolume;

pub use crate::solid::Composition;
