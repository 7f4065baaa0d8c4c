//! Hits of another program or of a mesh from a file, compared with the exact ones within a
//! stated distance.

mod agreement;
pub(crate) mod compare;
mod depth;
pub(crate) mod deviation;
mod hit_solid;
mod nearness;
mod surfaces;
pub(crate) mod tolerance;
pub(crate) mod traced_mesh;
mod triangle;
