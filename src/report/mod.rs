//! What people look at: figures, tables and pages, as text.

mod table;

pub use table::{Table, figure};
