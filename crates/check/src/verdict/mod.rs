//! Whether an answer is right: by the crossings of the meshes, or by the exact oracle.

pub(crate) mod answer;
pub(crate) mod composed;
pub(crate) mod exact_recheck;
pub(crate) mod judge;
pub(crate) mod sandwich;
pub(crate) mod seen;
pub(crate) mod surface;
pub(crate) mod truth;
