//! This library on larger and larger scenes: the time to build, the memory and
//! the rays a second against the number of cylinders and of placements.

mod growth;
mod measure;
mod outputs;

pub use growth::{Fits, slope};
pub use measure::{Figures, Plan, Resident, Row, Scale, Series};
pub use outputs::{SUMMARY_HEADINGS, figures, growths, page, summary, table};
