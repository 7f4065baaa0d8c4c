//! An answer held against what a ray meets of the prisms, or against exact
//! solids.

pub(crate) mod composed;
pub(crate) mod exact_recheck;
pub(crate) mod judge;
pub(crate) mod open_ends;
pub(crate) mod parts;
pub(crate) mod sandwich;
pub(crate) mod surface;
pub(crate) mod truth;
pub(crate) mod verdict;
