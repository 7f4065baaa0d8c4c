//! Whole checks: all rays of all classes, and one ray again.

pub(crate) mod compare;
pub(crate) mod plan;
pub(crate) mod replay;
pub(crate) mod subject;
