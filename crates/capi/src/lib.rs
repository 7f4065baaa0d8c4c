//! The C interface, as `include/cyltrace.h` documents it for its callers.
//!
//! It hands scene files, the tracer and the check to programs in C and in
//! whatever can call C. The functions are compiled with the crate; a shared
//! library that exports them is made by
//! `cargo rustc --release --lib --crate-type cdylib`. In Rust programs, which
//! do not call them, the linker leaves them out.
//!
//! # Invariants
//! Every `unsafe` block of this layer rests on one or more of these:
//!
//! 1. **Pointers are good or null.** The header asks callers for pointers that
//!    are null or point to as many whole, aligned values as are named, alive
//!    and not written to elsewhere during the call. Null is refused here
//!    wherever it is no choice.
//! 2. **Handles are ours.** A handle was made by this layer with
//!    `Box::into_raw` or `CString::into_raw` and is given back once.
//! 3. **No unwinding.** Every function runs in `status::guarded`: a panic is
//!    caught and becomes an error. A callback of the caller must not unwind
//!    into Rust; `extern "C"` ends the process if one does.
//! 4. **Layouts agree.** The structures are `repr(C)`; `tests/capi.rs` compares
//!    sizes and offsets with those of a C compiler.

#![allow(
    unsafe_code,
    reason = "the C interface takes pointers; each block names the invariants it rests on"
)]

mod check;
mod outcome;
mod scene;
mod status;
mod types;

pub use check::{CyltraceClosestFunction, cyltrace_check, cyltrace_check_outcome_free};
pub use scene::{
    CyltraceScene, cyltrace_closest, cyltrace_closest_with, cyltrace_occluded, cyltrace_scene_free,
    cyltrace_scene_load,
};
pub use status::{CYLTRACE_ERROR, CYLTRACE_OK, CYLTRACE_VIOLATIONS, cyltrace_last_error};
pub use types::{
    CYLTRACE_AXIAL, CYLTRACE_CAMERA, CYLTRACE_CAP0, CYLTRACE_CAP1, CYLTRACE_ENTER,
    CYLTRACE_FIELD_ALL, CYLTRACE_FIELD_ERROR, CYLTRACE_FIELD_NORMAL, CYLTRACE_FIELD_PATH,
    CYLTRACE_FIELD_POINT, CYLTRACE_FIELD_UV, CYLTRACE_GRAZING, CYLTRACE_GREATEST_DEPTH,
    CYLTRACE_INSIDE, CYLTRACE_LEAVE, CYLTRACE_SIDE, CYLTRACE_SOLID_CONE, CYLTRACE_SOLID_CUBOID,
    CYLTRACE_SOLID_CYLINDER, CYLTRACE_SOLID_DIFFERENCE, CYLTRACE_SOLID_DISK,
    CYLTRACE_SOLID_INTERSECTION, CYLTRACE_SOLID_ROUNDED_CONE, CYLTRACE_SOLID_SPHERE,
    CYLTRACE_SOLID_UNION, CYLTRACE_SPHERE, CYLTRACE_TELLS_NORMAL, CYLTRACE_TELLS_PLACE,
    CYLTRACE_X_MAX, CYLTRACE_X_MIN, CYLTRACE_Y_MAX, CYLTRACE_Y_MIN, CYLTRACE_Z_MAX, CYLTRACE_Z_MIN,
    CyltraceCheckOutcome, CyltraceCheckSettings, CyltraceHit, CyltraceRay,
};
