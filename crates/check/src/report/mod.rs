//! The outcome of a check as text, as JSON and as a page.

pub(crate) mod json;
pub(crate) mod page;
pub(crate) mod pictures;
pub(crate) mod text;
pub(crate) mod words;
