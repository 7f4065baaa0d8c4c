//! The Embree device: its options, version and memory.

use std::ffi::{CString, c_void};
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicIsize, Ordering};

use super::abort::AbortOnPanic;
use super::error::{Error, check, keep_message};
use super::isa::MaxIsa;
use super::kernel::Instructions;
use super::sys;
use super::types::{PacketWidth, Version};

/// How a device is set up. The default leaves all choices to Embree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DeviceOptions {
    /// The number of threads that build scenes; `None` is one per processor. Queries run on the
    /// caller's threads.
    pub threads: Option<NonZeroUsize>,
    /// The greatest instruction set to use; `None` is the processor's best.
    pub max_isa: Option<MaxIsa>,
}

impl DeviceOptions {
    /// Embree's configuration string.
    fn config(&self) -> String {
        let mut config = String::new();
        if let Some(threads) = self.threads {
            let _ = write!(config, "threads={threads},");
        }
        if let Some(isa) = self.max_isa {
            let _ = write!(config, "max_isa={isa},");
        }
        config
    }
}

/// Embree's entry point. Clones share one device, which lives until the last clone and the last
/// scene built on it are dropped.
#[derive(Clone, Debug)]
pub struct Device {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    handle: sys::RTCDevice,
    memory: Arc<Memory>,
    isa: Option<MaxIsa>,
    packet_width: Option<PacketWidth>,
}

// SAFETY: invariant 1, and Embree's device functions may be called on any
// thread, several at a time; the counters are atomic.
unsafe impl Send for Shared {}
// SAFETY: as for `Send`.
unsafe impl Sync for Shared {}

impl Drop for Shared {
    fn drop(&mut self) {
        // SAFETY: invariant 1: this is the one reference that `Device::open` made. Invariant 2:
        // Embree updates `memory` while it frees, and `memory` is dropped after this body.
        unsafe { sys::rtcReleaseDevice(self.handle) }
    }
}

impl Device {
    /// Sets up Embree without checking the layout of its hits.
    ///
    /// # Errors
    /// When Embree reports an error, or its major or minor version differs from that of the
    /// headers.
    pub(super) fn open(options: &DeviceOptions) -> Result<Self, Error> {
        const STEP: &str = "set up a device";
        let config = CString::new(options.config()).expect("the options contain no zero byte");
        // SAFETY: the string ends in a zero byte and outlives the call.
        let handle = unsafe { sys::rtcNewDevice(config.as_ptr()) };
        if handle.is_null() {
            check(handle, STEP)?;
        }
        assert!(!handle.is_null(), "Embree made no device and no error");
        let device = Self {
            shared: Arc::new(Shared {
                handle,
                memory: Arc::default(),
                isa: MaxIsa::in_use(options.max_isa),
                packet_width: widest_packets(handle),
            }),
        };
        let memory = Arc::as_ptr(&device.shared.memory).cast_mut().cast();
        // SAFETY: invariant 1; the function needs no data of its own.
        unsafe { sys::rtcSetDeviceErrorFunction(handle, Some(keep_message), std::ptr::null_mut()) };
        // SAFETY: invariants 1 and 2: the counters outlive the handle; `count_memory` casts the
        // pointer to the same type.
        unsafe { sys::rtcSetDeviceMemoryMonitorFunction(handle, Some(count_memory), memory) };
        check(handle, STEP)?;

        let (built_for, loaded) = (Version::BUILT_FOR, device.version());
        if (loaded.major, loaded.minor) != (built_for.major, built_for.minor) {
            return Err(Error::Version { built_for, loaded });
        }
        Ok(device)
    }

    /// The version of the library that was loaded.
    #[must_use]
    pub fn version(&self) -> Version {
        let number = |property| u32::try_from(self.property(property)).unwrap_or(0);
        Version {
            major: number(sys::RTC_DEVICE_PROPERTY_VERSION_MAJOR),
            minor: number(sys::RTC_DEVICE_PROPERTY_VERSION_MINOR),
            patch: number(sys::RTC_DEVICE_PROPERTY_VERSION_PATCH),
        }
    }

    /// The bytes that Embree uses now: hierarchies and buffers of all scenes of this device,
    /// without user data.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        as_bytes(&self.shared.memory.live)
    }

    /// The most bytes that Embree has used at any time.
    #[must_use]
    pub fn peak_memory_bytes(&self) -> usize {
        as_bytes(&self.shared.memory.peak)
    }

    /// The widest packets of rays that Embree traverses without splitting them; `None` if it
    /// was built without packets.
    #[inline]
    #[must_use]
    pub fn packet_width(&self) -> Option<PacketWidth> {
        self.shared.packet_width
    }

    /// The instructions that code of this crate may use, as Embree does.
    #[must_use]
    pub fn instructions(&self) -> Instructions {
        Instructions::of(self.isa_in_use())
    }

    /// The instruction set that Embree uses.
    pub(super) fn isa_in_use(&self) -> Option<MaxIsa> {
        self.shared.isa
    }

    pub(super) fn property(&self, property: sys::RTCDeviceProperty) -> isize {
        // SAFETY: invariant 1.
        unsafe { sys::rtcGetDeviceProperty(self.handle(), property) }
    }

    pub(super) fn handle(&self) -> sys::RTCDevice {
        self.shared.handle
    }

    /// Returns the error of the last call on this thread to this device, if it failed. `step`
    /// follows "could not" in the message.
    pub(super) fn check(&self, step: &'static str) -> Result<(), Error> {
        check(self.handle(), step)
    }
}

/// The widest packets that a live device traverses without splitting them.
fn widest_packets(device: sys::RTCDevice) -> Option<PacketWidth> {
    let native = |width| {
        let property = match width {
            PacketWidth::Four => sys::RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED,
            PacketWidth::Eight => sys::RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED,
            PacketWidth::Sixteen => sys::RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED,
        };
        // SAFETY: invariant 1.
        unsafe { sys::rtcGetDeviceProperty(device, property) != 0 }
    };
    PacketWidth::ALL
        .into_iter()
        .rev()
        .find(|&width| native(width))
}

/// The memory that Embree uses, as its monitor counts it.
#[derive(Debug, Default)]
struct Memory {
    live: AtomicIsize,
    peak: AtomicIsize,
}

/// The value of a counter. Threads report out of order, so it may be negative for a moment.
fn as_bytes(counter: &AtomicIsize) -> usize {
    usize::try_from(counter.load(Ordering::Relaxed)).unwrap_or(0)
}

/// Embree's memory monitor: `bytes` are about to be allocated, or were allocated; a negative
/// number is freed. Returning true lets Embree continue.
unsafe extern "C" fn count_memory(memory: *mut c_void, bytes: isize, _after: bool) -> bool {
    AbortOnPanic::run("memory monitor", || {
        // SAFETY: invariant 2: the pointer was made from the `Arc<Memory>` of a device that is
        // not released yet; it is only read through.
        let memory = unsafe { &*memory.cast::<Memory>() };
        let live = memory.live.fetch_add(bytes, Ordering::Relaxed) + bytes;
        memory.peak.fetch_max(live, Ordering::Relaxed);
        true
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn config_full_options_names_threads_and_isa() {
        let options = DeviceOptions {
            threads: NonZeroUsize::new(3),
            max_isa: Some(MaxIsa::Sse42),
        };
        assert_eq!(options.config(), "threads=3,max_isa=sse4.2,");
        assert_eq!(DeviceOptions::default().config(), "");
    }

    #[test]
    fn check_after_refused_call_gives_embrees_message_once() {
        let device = Device::new(&DeviceOptions::default()).unwrap();
        // SAFETY: invariant 1; Embree rejects an unknown geometry type.
        let geometry = unsafe { sys::rtcNewGeometry(device.handle(), sys::RTCGeometryType(9999)) };
        assert!(geometry.is_null());
        let error = device.check("make a geometry").unwrap_err();
        let text = error.to_string();
        assert!(
            text.starts_with("Embree could not make a geometry: "),
            "{text}"
        );
        assert!(text.contains("geometry type"), "{text}");
        assert_eq!(device.check("make a geometry"), Ok(()));
    }
}
