//! From a scene's description to committed Embree scenes, and hits in world space.

mod hit;

pub use hit::Hit;
