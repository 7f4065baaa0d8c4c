//! What the check has to know about each kind of solid.

pub(crate) mod scene_solid;
