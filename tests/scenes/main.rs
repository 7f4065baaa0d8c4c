//! Scene files, the formats that they name, and meshes of scenes.

mod colors;
mod environments;
mod formats_table;
mod generated_scenes;
mod keys;
mod lattices;
mod nesting;
mod picture_keys;
mod real_data;
mod sample_scenes;
mod save;
mod solids;
mod stated_exactly;
mod tessellate;
mod tessellate_kinds;
