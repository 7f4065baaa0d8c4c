//! The meshes: windows of the scene, hulls that are proven to be inside the solids or to
//! contain them, and the crossings of rays with them.

pub(crate) mod crossings;
pub(crate) mod hull;
pub(crate) mod hull_list;
pub(crate) mod mesh_frame;
pub(crate) mod mesh_map;
pub(crate) mod meshes;
pub(crate) mod open_ends;
pub(crate) mod placed;
pub(crate) mod window;
