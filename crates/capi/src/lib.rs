//! The C interface, as `include/cyltrace.h` documents it for its callers.
//!
//! Programs in C, and in every language that can call C, load scene files, trace rays and
//! check intersectors with it. `sh scripts/capi.sh PREFIX` builds and installs the shared
//! and the static library, the header and a pkg-config file.
//!
//! # Invariants
//! Every `unsafe` block of this layer rests on one or more of these:
//!
//! 1. **Pointers are good or null.** The header requires that a pointer is null or points to
//!    the stated number of whole, aligned values, which live and are not written to elsewhere
//!    during the call. Null is refused here unless the header allows it.
//! 2. **Handles are ours.** This layer made the handle with
//!    `Box::into_raw` or `CString::into_raw`, and it comes back once.
//! 3. **No unwinding.** Every function runs in `status::guarded`: a panic is
//!    caught and becomes an error. A callback of the caller must not unwind
//!    into Rust; `extern "C"` ends the process if one does.
//! 4. **Layouts agree.** The structures are `repr(C)`; `tests/capi` compares sizes and
//!    offsets with those of a C compiler, and [`CyltraceLayout`] refuses programs that were
//!    compiled for others.

#![allow(
    unsafe_code,
    reason = "the C interface takes pointers; each block names the invariants it rests on"
)]

mod check;
mod outcome;
mod scene;
mod status;
mod types;
mod version;

pub use check::{CyltraceClosestFunction, cyltrace_check, cyltrace_check_outcome_free};
pub use scene::{
    CyltraceScene, cyltrace_closest, cyltrace_closest_with, cyltrace_occluded, cyltrace_scene_free,
    cyltrace_scene_load_checked,
};
pub use status::{CYLTRACE_ERROR, CYLTRACE_OK, CYLTRACE_VIOLATIONS, cyltrace_last_error};
pub use types::*;
pub use version::{CYLTRACE_VERSION, CyltraceLayout, cyltrace_version};
