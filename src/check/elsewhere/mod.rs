//! Hits from elsewhere, of another program or of a mesh from a file, held
//! against the exact ones within a stated distance.

pub(in crate::check) mod agreement;
pub(in crate::check) mod mesh_file;
pub(in crate::check) mod nearness;
pub(in crate::check) mod user_hits;
pub(in crate::check) mod user_mesh;
