//! The meshes: windows of the scene, and prisms that provably are held by the
//! solids or hold them.

pub(in crate::check) mod containment;
pub(in crate::check) mod mesh_frame;
pub(in crate::check) mod mesh_solid;
pub(in crate::check) mod meshes;
pub(in crate::check) mod placed;
pub(in crate::check) mod prism;
