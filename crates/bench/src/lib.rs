//! Run time against error, and against size.
//!
//! [`Accuracy::measure`] runs every formulation and rival on the same cases and compares
//! the answers with the oracle's (`truth`); then it times them in turns on the ordinary
//! cases (`timing`). [`Accuracy`] is the outcome, and [`figure`], [`page`] and [`records`]
//! show it. [`traversal`] compares whole scenes, [`scale`] measures growing ones.

mod accuracy;
pub mod formulations;
mod groups;
mod machine;
mod outputs;
mod rivals;
#[cfg(test)]
mod samples;
pub mod scale;
mod statistics;
pub mod stress;
mod timing;
pub mod traversal;
mod truth;

pub use accuracy::{
    Accuracy, Contender, Row, Times, USUAL_ROUNDS, USUAL_TIMED, contenders, rival_names,
};
pub use machine::Environment;
pub use outputs::{Record, SUMMARY_HEADINGS, figure, page, records, summaries};
pub use rivals::Shape;
pub use statistics::{PowerLaw, Spread, percentile};
pub use timing::{Rounds, ThreadClock, Timer, WallClock};
pub use truth::{Errors, JudgedCases, draw};
