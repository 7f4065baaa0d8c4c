//! What people look at: figures, tables and pages, as text.

mod base64;
mod csv;
mod figure;
mod html;
mod label;
mod table;

pub use csv::csv;
pub use figure::{Figure, Mark, Series, Symbol};
pub use html::{Page, escape};
pub use table::{Table, figure, readable};
