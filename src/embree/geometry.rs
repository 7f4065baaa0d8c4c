//! Embree geometries of any kind.

use super::device::Device;
use super::error::Error;
use super::sys;

/// One reference to an Embree geometry. Attaching it adds a reference for the scene.
pub(super) struct GeometryHandle(sys::RTCGeometry);

impl GeometryHandle {
    /// A geometry of the given kind with a mask that no ray misses.
    pub fn new(device: &Device, kind: sys::RTCGeometryType) -> Result<Self, Error> {
        // SAFETY: invariant 1.
        let geometry = Self(unsafe { sys::rtcNewGeometry(device.handle(), kind) });
        device.check("make a geometry")?;
        // The default mask differs between Embree 3 and 4.
        // SAFETY: invariant 1.
        unsafe { sys::rtcSetGeometryMask(geometry.0, u32::MAX) };
        device.check("set a geometry's mask")?;
        Ok(geometry)
    }

    pub fn raw(&self) -> sys::RTCGeometry {
        self.0
    }
}

impl Drop for GeometryHandle {
    fn drop(&mut self) {
        if !self.0.is_null() {
            // SAFETY: invariant 1: the one reference that `new` made.
            unsafe { sys::rtcReleaseGeometry(self.0) }
        }
    }
}

/// What a scene stores for a user geometry of any type.
pub(super) trait UserData: Send + Sync {
    /// The least primitive whose bounds were not legal.
    fn refused(&self) -> Option<u32>;
}
