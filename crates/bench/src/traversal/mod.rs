//! Rays through whole scenes: this library beside everything that Embree can
//! trace in its place.
//!
//! [`Traversal::measure`] takes some scenes (`scenes`), draws rays of three
//! kinds (`rays`), has a part of them judged by the oracle (`witness`), builds
//! one representation after the other (`ours`, `native`) and runs
//! it in turns with this library (`interleave`), rivals in two orders of rays (`order`).
//! [`Best`], [`figures`], [`page`] and [`records`] show the outcome.

mod best;
mod building;
mod candidate_filter;
mod flat;
mod interleave;
mod measure;
mod native;
mod native_packets;
mod order;
mod ours;
mod outcome;
mod outputs;
mod plan;
mod random_scene;
mod rays;
mod representation;
mod scenes;
mod witness;

pub use best::{BEST_HEADINGS, BEST_NAMES, Best};
pub use interleave::Workers;
pub(super) use interleave::{Sample, interleave};
pub use order::Order;
pub(super) use ours::run as run_ours;
pub use outcome::{Figures, RIVALS, Ratio, Row, Traversal, ratio_key};
pub use outputs::{Record, SUMMARY_HEADINGS, Shown, figures, page, records, summary};
pub use plan::Plan;
pub use random_scene::sticks;
pub use rays::Kind;
pub(super) use rays::{Rays, camera_rays, random_rays};
pub use representation::{Mode, Representation};
pub use scenes::SceneName;
