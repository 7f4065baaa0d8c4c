//! What is said of a check: before it, in tables, on the page.

pub(in crate::check) mod figures;
pub(in crate::check) mod pictures;
pub(in crate::check) mod plan;
pub(in crate::check) mod report;
pub(in crate::check) mod words;
