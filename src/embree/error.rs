//! The errors of this layer, with Embree's own message where it gives one.
//!
//! Embree calls its error function on the thread of the failing call, before that call returns.
//! The message is kept in a thread-local until the wrapper of the call reads it, so threads
//! that build at the same time do not mix their messages.

use std::cell::RefCell;
use std::ffi::{CStr, c_char, c_void};
use std::fmt;

use super::abort::AbortOnPanic;
use super::sys;
use super::types::{GREATEST_COORDINATE, GeometryId, Version};

/// Why Embree could not be set up, or a scene could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Embree reported an error in a step.
    #[error("Embree could not {step}: {message} ({code})")]
    Embree {
        /// The step, as it follows "could not".
        step: &'static str,
        /// Embree's own message, or a note that it gave none.
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
    /// The library writes hits in a layout that differs from its headers.
    #[error(
        "the loaded Embree {loaded} does not answer in the layout of the headers this program was built with ({found}): build it with the library's own headers"
    )]
    HitLayout {
        /// The version of the library.
        loaded: Version,
        /// What the probe saw.
        found: &'static str,
    },
    /// The installed Embree was built without a required feature.
    #[error("the installed Embree was built without {missing}")]
    Unsupported {
        /// What is missing.
        missing: &'static str,
    },
    /// A map that is invalid for an instance.
    #[error(
        "the instance's map {map:?} must be of finite numbers below {GREATEST_COORDINATE:e}, with a determinant that is not zero and within the range of f32"
    )]
    InstanceMap {
        /// Its rows.
        map: [[f32; 4]; 3],
    },
    /// An instance of a scene on another device.
    #[error("an instanced scene must be of the same device as the scene it is placed in")]
    OtherDevice,
    /// An instance of a scene that contains instances.
    #[error("an instanced scene must not contain instances itself")]
    NestedInstance,
    /// A primitive of a user geometry has bounds that Embree would skip.
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
    /// A normal of a disk that Embree would not accept.
    #[error(
        "disk {disk} has the normal {value:?}: every component must be finite and below {GREATEST_COORDINATE:e}"
    )]
    Normal {
        /// The number of the disk.
        disk: usize,
        /// Its normal.
        value: [f32; 3],
    },
    /// A triangle or curve segment uses a vertex that does not exist.
    #[error("primitive {primitive} uses vertex {vertex}, and there are {vertices}")]
    VertexIndex {
        /// The triangle or segment.
        primitive: usize,
        /// The vertex that it uses; for a segment, the second one.
        vertex: u64,
        /// The number of vertices.
        vertices: usize,
    },
    /// The number of neighbour flags differs from that of the segments.
    #[error("{flags} neighbour flags were given for {segments} segments")]
    FlagCount {
        /// The number of flags.
        flags: usize,
        /// The number of segments.
        segments: usize,
    },
    /// The number of normals differs from that of the disks.
    #[error("{normals} normals were given for {disks} disks")]
    NormalCount {
        /// The number of normals.
        normals: usize,
        /// The number of disks.
        disks: usize,
    },
}

/// Embree's error code. Unknown codes are kept.
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

/// Embree's error function: stores the message for [`check`].
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

/// Returns the error of the last call on this thread to `device`, if it failed. `step` is what
/// the call was to do. `device` is live, or null right after creating one failed.
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
