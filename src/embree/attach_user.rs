//! Registers user geometries with Embree.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use super::abort::AbortOnPanic;
use super::callback::Callbacks;
use super::device::Device;
use super::error::Error;
use super::float_mode::with_default_float_mode;
use super::geometry::{GeometryHandle, UserData};
use super::query::Query;
use super::ray::Box32;
use super::scene::SceneBuilder;
use super::sys;
use super::types::GeometryId;
use super::user::{Registered, UserGeometry};

impl<Q: Query> SceneBuilder<Q> {
    /// Adds a geometry whose primitives `geometry` bounds and intersects.
    ///
    /// # Errors
    /// When Embree reports an error.
    pub fn attach_user<G>(&mut self, geometry: G) -> Result<GeometryId, Error>
    where
        G: UserGeometry<Query = Q>,
    {
        // Declared before the handle, hence dropped after it on an error.
        let (data, handle) = new_user_geometry(self.device(), geometry)?;
        self.attach_with(data, &handle)
    }
}

/// Creates an Embree geometry that calls `geometry`. The data has to outlive the handle and the
/// scene that the geometry is attached to.
fn new_user_geometry<G: UserGeometry>(
    device: &Device,
    geometry: G,
) -> Result<(Arc<dyn UserData>, GeometryHandle), Error> {
    let primitives = geometry.primitive_count();
    let data = Arc::new(Registered {
        geometry,
        refused: AtomicU32::new(u32::MAX),
    });
    let handle = GeometryHandle::new(device, sys::RTC_GEOMETRY_TYPE_USER)?;
    let raw = handle.raw();
    let callbacks = Callbacks::of::<G>(device.isa_in_use());
    // SAFETY: invariants 1, 3, 5 and 9: the pointer and the callbacks are set for
    // the same `G`.
    unsafe {
        sys::rtcSetGeometryUserPrimitiveCount(raw, primitives);
        sys::rtcSetGeometryUserData(raw, Arc::as_ptr(&data).cast_mut().cast());
        sys::rtcSetGeometryBoundsFunction(raw, Some(bounds::<G>), std::ptr::null_mut());
        sys::rtcSetGeometryIntersectFunction(raw, Some(callbacks.intersect));
        sys::rtcSetGeometryOccludedFunction(raw, Some(callbacks.occluded));
    }
    device.check("set up a user geometry")?;
    Ok((data, handle))
}

unsafe extern "C" fn bounds<G: UserGeometry>(args: *const sys::RTCBoundsFunctionArguments) {
    AbortOnPanic::run("bounds", || {
        // SAFETY: invariant 7.
        let args = unsafe { &*args };
        // SAFETY: invariants 2 and 3.
        let data = unsafe { &*args.geometryUserPtr.cast::<Registered<G>>() };
        let mut bounds = with_default_float_mode(|| data.geometry.bounds(args.primID));
        if !bounds.is_legal() {
            // The commit returns an error for it. Until then Embree gets a box that it accepts.
            data.refused.fetch_min(args.primID, Ordering::Relaxed);
            bounds = Box32 {
                lower: [0.0; 3],
                upper: [0.0; 3],
            };
        }
        // SAFETY: invariant 7: Embree reads the box from there.
        unsafe { *args.bounds_o = bounds.to_embree() };
    });
}
