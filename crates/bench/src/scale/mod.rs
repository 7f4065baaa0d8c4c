//! This library on growing scenes: build time, memory and rays per second against the
//! number of cylinders and of placements.

mod growth;
mod measure;
mod outputs;

pub use growth::Fits;
pub use measure::{Figures, Plan, Resident, Row, Scale, Series};
pub use outputs::{Record, SUMMARY_HEADINGS, figures, growths, page, records, summary};
