//! User geometry whose callbacks are in C: `src/bench/c_rival.c`, the rival of
//! the tracer's Rust ones.
//!
//! It is in this layer because C takes raw pointers. What is known of cylinders
//! here is how the header lays them out.

use std::sync::Arc;

use super::error::Error;
use super::query::{NoPackets, Query};
use super::ray::Box32;
use super::scene::{GeometryHandle, GeometryId, SceneBuilder};
use super::sys;
use super::user::UserData;

pub(crate) use sys::{cyltrace_c_cylinder as CCylinder, cyltrace_c_query as CQuery};

/// What the data pointer leads to. Embree gets the address of `table`, and that
/// points into the vectors, which nobody changes.
struct Registered {
    table: sys::cyltrace_c_geometry,
    _cylinders: Vec<CCylinder>,
    _boxes: Vec<sys::RTCBounds>,
}

// SAFETY: invariant 3: the pointers of the table lead to vectors that the same
// value owns and that are only read.
unsafe impl Send for Registered {}
// SAFETY: as for `Send`.
unsafe impl Sync for Registered {}

impl UserData for Registered {
    /// Boxes are checked before Embree gets them.
    fn refused(&self) -> Option<u32> {
        None
    }
}

impl Query for CQuery {
    type Packet = NoPackets;
}

impl SceneBuilder<CQuery> {
    /// Adds cylinders that C intersects with the f64 ray of a query.
    ///
    /// # Errors
    /// When Embree refuses, or a box is not legal.
    pub(crate) fn attach_c(
        &mut self,
        cylinders: Vec<CCylinder>,
        boxes: &[Box32],
    ) -> Result<GeometryId, Error> {
        self.attach_c_cylinders(
            cylinders,
            boxes,
            sys::cyltrace_c_intersect,
            sys::cyltrace_c_occluded,
        )
    }
}

impl SceneBuilder<()> {
    /// Adds cylinders that C intersects with Embree's f32 ray, which is all
    /// that there is in an instance.
    ///
    /// # Errors
    /// When Embree refuses, or a box is not legal.
    pub(crate) fn attach_c_narrow(
        &mut self,
        cylinders: Vec<CCylinder>,
        boxes: &[Box32],
    ) -> Result<GeometryId, Error> {
        self.attach_c_cylinders(
            cylinders,
            boxes,
            sys::cyltrace_c_intersect_narrow,
            sys::cyltrace_c_occluded_narrow,
        )
    }
}

type Intersect = unsafe extern "C" fn(*const sys::RTCIntersectFunctionNArguments);
type Occluded = unsafe extern "C" fn(*const sys::RTCOccludedFunctionNArguments);

impl<Q: Query> SceneBuilder<Q> {
    /// The callbacks find a `Q` in the context, or look for none.
    fn attach_c_cylinders(
        &mut self,
        cylinders: Vec<CCylinder>,
        boxes: &[Box32],
        intersect: Intersect,
        occluded: Occluded,
    ) -> Result<GeometryId, Error> {
        assert_eq!(cylinders.len(), boxes.len(), "a box for each cylinder");
        if let Some(refused) = boxes.iter().position(|one| !one.is_legal()) {
            return Err(Error::Bounds {
                geometry: GeometryId(u32::MAX),
                primitive: refused as u32,
            });
        }
        let boxes: Vec<sys::RTCBounds> = boxes.iter().map(|one| one.to_embree()).collect();
        let count = cylinders.len() as u32;
        let data = Arc::new(Registered {
            table: sys::cyltrace_c_geometry {
                cylinders: cylinders.as_ptr(),
                boxes: boxes.as_ptr(),
            },
            _cylinders: cylinders,
            _boxes: boxes,
        });
        let handle = GeometryHandle::new(self.device(), sys::RTC_GEOMETRY_TYPE_USER)?;
        let raw = handle.raw();
        // SAFETY: invariants 1, 2 and 5: the table is kept with the scene. The
        // callbacks read it in the layout of its header, at numbers below
        // `count`, and by invariant 4 the query that they find is a `Q`. They
        // are C, so invariant 8 holds by itself.
        unsafe {
            sys::rtcSetGeometryUserPrimitiveCount(raw, count);
            sys::rtcSetGeometryUserData(raw, (&raw const data.table).cast_mut().cast());
            sys::rtcSetGeometryBoundsFunction(
                raw,
                Some(sys::cyltrace_c_bounds),
                std::ptr::null_mut(),
            );
            sys::rtcSetGeometryIntersectFunction(raw, Some(intersect));
            sys::rtcSetGeometryOccludedFunction(raw, Some(occluded));
        }
        self.device().check("set up a user geometry in C")?;
        self.attach_with(data, &handle)
    }
}
