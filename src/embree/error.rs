//! What can go wrong, in Embree's own words where it has any.
//!
//! Embree calls its error function on the thread that made the failing call,
//! before that call returns. So the message waits in a thread-local until the
//! wrapper of the call looks for it, and two threads that build at the same
//! time don't mix theirs.

use std::cell::RefCell;
use std::ffi::{CStr, c_char, c_void};
use std::fmt;

use super::abort::AbortOnPanic;
use super::sys;
use super::types::{GREATEST_COORDINATE, GeometryId, Version};

/// Why Embree could not be set up or a scene not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Embree refused a step.
    #[error("Embree could not {step}: {message} ({code})")]
    Embree {
        /// The step, as it follows "could not".
        step: &'static str,
        /// Embree's own message, or that it gave none.
        message: String,
        /// The kind of error.
        code: ErrorCode,
    },
    /// The library that was loaded is not the one this program was built for.
    #[error(
        "this program was built for Embree {built_for} and loaded version {loaded}: build it again, or let the loader find the right library"
    )]
    Version {
        /// The version of the headers.
        built_for: Version,
        /// The version of the library.
        loaded: Version,
    },
    /// The library writes hits in another layout than its headers state.
    #[error(
        "the loaded Embree {loaded} does not answer in the layout of the headers this program was built with ({found}): build it with the library's own headers"
    )]
    HitLayout {
        /// The version of the library.
        loaded: Version,
        /// What the probe saw.
        found: &'static str,
    },
    /// The installed Embree was built without something that is needed.
    #[error("the installed Embree was built without {missing}")]
    Unsupported {
        /// What is missing.
        missing: &'static str,
    },
    /// A map that an instance cannot have.
    #[error(
        "the instance's map {map:?} must be of finite numbers below {GREATEST_COORDINATE:e}, with a determinant that is not zero and within the range of f32"
    )]
    InstanceMap {
        /// Its rows.
        map: [[f32; 4]; 3],
    },
    /// An instance of a scene of another device.
    #[error("an instanced scene must be of the same device as the scene it is placed in")]
    OtherDevice,
    /// An instance of a scene that contains instances.
    #[error("an instanced scene must not contain instances itself")]
    NestedInstance,
    /// A primitive of a user geometry has bounds that Embree would leave out.
    #[error(
        "primitive {primitive} of geometry {} has bounds that are empty, not finite or beyond {GREATEST_COORDINATE:e}",
        geometry.0
    )]
    Bounds {
        /// The geometry.
        geometry: GeometryId,
        /// The first such primitive.
        primitive: u32,
    },
    /// A vertex that Embree would not accept.
    #[error(
        "vertex {vertex} is {value:?}: every coordinate must be finite and below {GREATEST_COORDINATE:e}, a radius not negative"
    )]
    Vertex {
        /// Its number.
        vertex: usize,
        /// Its coordinates, and its radius for a curve.
        value: Vec<f32>,
    },
    /// A triangle or curve segment that names a vertex there isn't.
    #[error("primitive {primitive} uses vertex {vertex}, and there are {vertices}")]
    VertexIndex {
        /// The triangle or segment.
        primitive: usize,
        /// The vertex it names; for a segment, its second one.
        vertex: u64,
        /// How many there are.
        vertices: usize,
    },
    /// Neighbour flags that don't belong to the segments.
    #[error("{flags} neighbour flags were given for {segments} segments")]
    FlagCount {
        /// How many flags.
        flags: usize,
        /// How many segments.
        segments: usize,
    },
    /// Normals that don't belong to the disks.
    #[error("{normals} normals were given for {disks} disks")]
    NormalCount {
        /// How many normals.
        normals: usize,
        /// How many disks.
        disks: usize,
    },
}

/// Embree's kinds of errors; unknown numbers are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ErrorCode(u32);

impl fmt::Display for ErrorCode {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match sys::RTCError(self.0) {
            sys::RTC_ERROR_INVALID_ARGUMENT => formatter.write_str("invalid argument"),
            sys::RTC_ERROR_INVALID_OPERATION => formatter.write_str("invalid operation"),
            sys::RTC_ERROR_OUT_OF_MEMORY => formatter.write_str("out of memory"),
            sys::RTC_ERROR_UNSUPPORTED_CPU => formatter.write_str("unsupported processor"),
            sys::RTC_ERROR_CANCELLED => formatter.write_str("cancelled"),
            sys::RTCError(code) => write!(formatter, "error {code}"),
        }
    }
}

thread_local! {
    static MESSAGE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Embree's error function: keeps the message for [`check`].
pub(super) unsafe extern "C" fn keep_message(
    _user: *mut c_void,
    _code: sys::RTCError,
    message: *const c_char,
) {
    AbortOnPanic::run("error", || {
        if message.is_null() {
            return;
        }
        // SAFETY: invariant 7; Embree passes a string that ends in a zero byte.
        let text = unsafe { CStr::from_ptr(message) };
        MESSAGE.set(text.to_string_lossy().into_owned());
    });
}

/// Whether the last call on this thread to something of `device` went well;
/// `step` says what it was to do. `device` is alive, or null right after
/// creating one failed.
pub(super) fn check(device: sys::RTCDevice, step: &'static str) -> Result<(), Error> {
    // SAFETY: invariant 1; null means the error of creating a device.
    let code = unsafe { sys::rtcGetDeviceError(device) };
    if code == sys::RTC_ERROR_NONE {
        return Ok(());
    }
    let mut message = MESSAGE.take();
    if message.is_empty() {
        message.push_str("it gives no reason");
    }
    Err(Error::Embree {
        step,
        message,
        code: ErrorCode(code.0),
    })
}
