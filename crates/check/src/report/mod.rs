//! What is said of a check: before it, in tables, on the page.

pub(crate) mod figures;
pub(crate) mod pictures;
pub(crate) mod plan;
pub(crate) mod report;
pub(crate) mod words;
