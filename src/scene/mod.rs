//! The scene as the user states it, in f64, and the files it is read from.
//!
//! [`load`] reads a scene file in TOML (`docs/scene-file.md`) in three steps:
//! `document` contains the keys as written, with their places; the
//! entries are lowered one kind a file (`solids`, with their `pose`,
//! `set_operations`, the `formats` of files, `placing`, `scatter`,
//! `camera`, `settings`), streaming the rows of tables, which `table` reads and
//! `named_table` opens for them; `solid_collector` collects the
//! solids of a prototype and numbers them; `graph` checks how prototypes place each
//! other. `scene_file` knows the file between the two
//! first steps, and `contents` what it will hold, so that a scene which is too
//! large is refused early. `cylinder_list` keeps cylinders in f64 or f32,
//! `solid_lists` the other kinds; `aimed_camera` aims the camera. The result is a [`Scene`] that needs no
//! further checks and knows nothing of files.
//!
//! [`save`] writes a scene as such files.
//!
//! `number_table` and `hit_table` read what else comes as tables: rays, points, and the
//! hits of another program.

mod aimed_camera;
mod camera;
mod contents;
mod cylinder_list;
mod defaults;
mod description;
mod document;
mod error;
mod formats;
mod graph;
mod hit_table;
mod instance_rows;
mod limits;
mod lines;
mod load;
mod named_table;
mod names;
mod number_table;
mod origins;
mod placing;
mod pose;
mod regular_file;
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
pub use contents::{ExpectedCounts, ExpectedSolids, PlacedCount};
pub(crate) use cylinder_list::SharedRecords;
pub use cylinder_list::{CylinderList, CylinderRecord32, Iter as CylinderIter, Records};
pub use description::{
    Camera, CylinderRecord, Film, Frame, Integrator, Material, MaterialIndex, Placement,
    Projection, Prototype, PrototypeIndex, RenderSettings, Scene, Sky, Sun,
};
pub use error::{SceneError, Statement};
pub use formats::{SOLID_FORMATS, SolidFormatInfo, beams_of_model, check_swc};
pub use hit_table::{GivenHit, GivenHits};
pub use limits::*;
pub use load::load;
pub use number_table::{NumberColumns, NumberRow, NumberTable};
pub use origins::{Origin, Origins};
pub use save::{SaveError, save};
pub use scene_file::SceneFile;
pub use scene_stats::SceneStats;
pub use solid_lists::{CompositionRecord, Listed, SolidList, SolidRecord, Solids, Stored};
pub use table::{
    Block, Column, ColumnKey, Decimal, Delimiter, Fault, Layout, Row, Rows, Table, TableFormat,
};
pub use view_volume::ViewVolume;

pub use crate::solid::Composition;
