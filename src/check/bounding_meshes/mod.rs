//! The meshes: windows of the scene, and hulls that provably are held by the solids
//! or hold them.

pub(in crate::check) mod hull;
pub(in crate::check) mod hull_list;
pub(in crate::check) mod mesh_frame;
pub(in crate::check) mod mesh_map;
pub(in crate::check) mod meshes;
pub(in crate::check) mod placed;
pub(in crate::check) mod window;
