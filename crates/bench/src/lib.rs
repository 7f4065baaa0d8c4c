//! Run time against error, and against size.
//!
//! [`Accuracy::measure`] asks every formulation and rival about the same cases
//! and compares the answers with the oracle's (`truth`); then it runs them in
//! turns on the ordinary ones (`timing`). [`Accuracy`] is the outcome, and
//! [`figure`], [`page`] and [`table`] show it. [`traversal`] compares whole
//! scenes, [`scale`] follows this library to large ones.

mod accuracy;
pub mod formulations;
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
pub use outputs::{SUMMARY_HEADINGS, figure, page, summary, table};
pub use rivals::{Shape, Traced};
pub use statistics::{Spread, p99};
pub use timing::{Rounds, ThreadClock, Timer, WallClock};
pub use truth::{Errors, JudgedCases, draw};
