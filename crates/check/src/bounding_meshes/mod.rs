//! The meshes: windows of the scene, and hulls that provably are held by the solids
//! or hold them.

pub(crate) mod hull;
pub(crate) mod hull_list;
pub(crate) mod mesh_frame;
pub(crate) mod mesh_map;
pub(crate) mod meshes;
pub(crate) mod placed;
pub(crate) mod window;
