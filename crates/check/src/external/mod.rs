//! Hits from elsewhere, of another program or of a mesh from a file, held
//! against the exact ones within a stated distance.

pub(crate) mod agreement;
mod depth;
pub(crate) mod deviation;
mod hit_solid;
mod nearness;
pub(crate) mod rays_around;
mod surfaces;
pub(crate) mod tolerance;
mod triangle;
pub(crate) mod user_hits;
pub(crate) mod user_mesh;
