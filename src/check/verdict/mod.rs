//! An answer held against what a ray meets of the prisms, or against exact
//! solids.

pub(in crate::check) mod composed;
pub(in crate::check) mod exact_recheck;
pub(in crate::check) mod judge;
pub(in crate::check) mod open_ends;
pub(in crate::check) mod parts;
pub(in crate::check) mod sandwich;
pub(in crate::check) mod surface;
pub(in crate::check) mod truth;
pub(in crate::check) mod verdict;
