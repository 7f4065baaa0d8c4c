//! Hits from elsewhere, of another program or of a mesh from a file, held
//! against the exact ones within a stated distance.

pub(in crate::check) mod agreement;
mod depth;
pub(in crate::check) mod deviation;
mod hit_solid;
mod nearness;
pub(in crate::check) mod rays_around;
mod surfaces;
pub(in crate::check) mod tolerance;
mod triangle;
pub(in crate::check) mod user_hits;
pub(in crate::check) mod user_mesh;
