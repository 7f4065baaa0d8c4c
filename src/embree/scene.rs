//! Scenes: one owner builds them, any number of threads query them.

use std::cell::Cell;
use std::marker::PhantomData;
use std::ptr;
use std::sync::Arc;

use super::device::Device;
use super::error::Error;
use super::geometry::{GeometryHandle, UserData};
use super::query::Query;
use super::ray::{Box32, NativeHit, Ray32};
use super::sys;
use super::types::GeometryId;

/// One reference to an Embree scene.
struct SceneHandle(sys::RTCScene);

// SAFETY: invariant 5: while it is written to, one builder owns it; afterwards
// it is only read.
unsafe impl Send for SceneHandle {}
// SAFETY: as for `Send`; a shared builder offers no function that writes.
unsafe impl Sync for SceneHandle {}

impl Drop for SceneHandle {
    fn drop(&mut self) {
        if !self.0.is_null() {
            // SAFETY: invariant 1: the one reference that `SceneBuilder::new` made.
            unsafe { sys::rtcReleaseScene(self.0) }
        }
    }
}

/// A scene that others have instances of, whatever its queries.
trait Instanced: Send + Sync {}

impl<Q: Query> Instanced for Scene<Q> {}

/// An Embree scene and what has to outlive it; the order of the fields is the
/// order in which they are dropped (invariant 2).
pub(super) struct Parts {
    handle: SceneHandle,
    /// Shared pointers because, unlike a box, one may be moved while Embree
    /// keeps a pointer into it. There is no second owner.
    user_data: Vec<(GeometryId, Arc<dyn UserData>)>,
    /// Scenes that this one has instances of.
    instanced: Vec<Arc<dyn Instanced>>,
    device: Device,
}

/// A scene that is being put together, for queries with a state of type `Q`.
///
/// Whatever is attached belongs to the scene and is dropped with it, exactly
/// once, also when the scene is never committed.
///
/// A builder may move to another thread, but not be shared between threads:
/// ```compile_fail,E0277
/// fn shared<T: Sync>() {}
/// shared::<cyltrace::embree::SceneBuilder<()>>();
/// ```
pub struct SceneBuilder<Q: Query> {
    parts: Parts,
    query: PhantomData<fn(&mut Q)>,
    /// A `Cell` may not be shared between threads, so a builder may not.
    unshared: PhantomData<Cell<()>>,
}

impl<Q: Query> SceneBuilder<Q> {
    /// An empty scene.
    ///
    /// # Errors
    /// When Embree refuses, for example for lack of memory.
    pub fn new(device: &Device) -> Result<Self, Error> {
        // SAFETY: invariant 1.
        let handle = SceneHandle(unsafe { sys::rtcNewScene(device.handle()) });
        device.check("make a scene")?;
        // Meshes are the witness of exact answers, so no ray may slip between
        // two triangles. User geometry is the same with and without.
        // SAFETY: invariants 1 and 5.
        unsafe { sys::rtcSetSceneFlags(handle.0, sys::RTC_SCENE_FLAG_ROBUST) };
        device.check("set a scene's flags")?;
        Ok(Self {
            parts: Parts {
                handle,
                user_data: Vec::new(),
                instanced: Vec::new(),
                device: device.clone(),
            },
            query: PhantomData,
            unshared: PhantomData,
        })
    }

    /// Attaches a geometry and keeps what its data pointer points to.
    pub(super) fn attach_with(
        &mut self,
        data: Arc<dyn UserData>,
        geometry: &GeometryHandle,
    ) -> Result<GeometryId, Error> {
        let id = self.attach(geometry);
        // Kept with the scene also after an error: the geometry may have been
        // attached all the same.
        let kept_for = *id.as_ref().unwrap_or(&GeometryId(u32::MAX));
        self.parts.user_data.push((kept_for, data));
        id
    }

    pub(super) fn device(&self) -> &Device {
        &self.parts.device
    }

    /// Keeps a scene as long as this one.
    pub(super) fn keep(&mut self, scene: Arc<Scene<Q>>) {
        self.parts.instanced.push(scene);
    }

    /// Commits a geometry and gives the scene a reference to it.
    pub(super) fn attach(&mut self, geometry: &GeometryHandle) -> Result<GeometryId, Error> {
        self.commit_geometry(geometry)?;
        // SAFETY: invariants 1 and 5.
        let id = unsafe { sys::rtcAttachGeometry(self.parts.handle.0, geometry.raw()) };
        self.device().check("attach a geometry")?;
        Ok(GeometryId(id))
    }

    /// As [`attach`](Self::attach), with a number that is chosen.
    pub(super) fn attach_as(
        &mut self,
        number: GeometryId,
        geometry: &GeometryHandle,
    ) -> Result<(), Error> {
        self.commit_geometry(geometry)?;
        // SAFETY: invariants 1 and 5.
        unsafe { sys::rtcAttachGeometryByID(self.parts.handle.0, geometry.raw(), number.0) };
        self.device().check("attach a geometry by its number")
    }

    fn commit_geometry(&self, geometry: &GeometryHandle) -> Result<(), Error> {
        // SAFETY: invariants 1 and 5.
        unsafe { sys::rtcCommitGeometry(geometry.raw()) };
        self.device().check("commit a geometry")
    }

    /// Builds the hierarchy. `bounds` of user geometries is called from this
    /// thread and from Embree's own.
    ///
    /// # Errors
    /// When Embree refuses, for example for lack of memory, or when a primitive of a
    /// user geometry has bounds that it would leave out.
    pub fn commit(self) -> Result<Scene<Q>, Error> {
        let parts = self.parts;
        // SAFETY: invariants 1 and 5: this builder was the only owner, and it
        // has been taken.
        unsafe { sys::rtcCommitScene(parts.handle.0) };
        parts.device.check("commit a scene")?;
        parts.into_scene()
    }

    /// What was attached so far.
    pub(super) fn into_parts(self) -> Parts {
        self.parts
    }
}

impl Parts {
    /// The Embree scene, for as long as these parts are kept.
    pub(super) fn raw(&self) -> sys::RTCScene {
        self.handle.0
    }

    pub(super) fn device(&self) -> &Device {
        &self.device
    }

    /// The scene of parts that were committed.
    pub(super) fn into_scene<Q: Query>(self) -> Result<Scene<Q>, Error> {
        for (geometry, data) in &self.user_data {
            if let Some(primitive) = data.refused() {
                return Err(Error::Bounds {
                    geometry: *geometry,
                    primitive,
                });
            }
        }
        let mut bounds = sys::RTCBounds::default();
        // SAFETY: invariant 1; `bounds` is written during the call only.
        unsafe { sys::rtcGetSceneBounds(self.handle.0, &raw mut bounds) };
        self.device.check("report a scene's bounds")?;
        Ok(Scene {
            parts: self,
            bounds: Some(Box32::from_embree(&bounds)).filter(Box32::is_legal),
            query: PhantomData,
        })
    }
}

/// A built scene, which never changes and which any number of threads may
/// query at a time, also from within a callback of another query. Each level
/// of such nesting takes 5 to 12 kB of the thread's stack for a single ray, and 24
/// to 65 kB for a packet.
pub struct Scene<Q: Query> {
    parts: Parts,
    bounds: Option<Box32>,
    query: PhantomData<fn(&mut Q)>,
}

impl<Q: Query> Scene<Q> {
    /// Traverses the scene for the closest hit. User geometries answer through
    /// `query`; what Embree finds by itself is not reported.
    #[inline]
    pub fn closest(&self, ray: &Ray32, query: &mut Q) {
        self.trace(ray, query);
    }

    /// Traverses the scene until anything is hit, and says whether it was.
    #[inline]
    pub fn any(&self, ray: &Ray32, query: &mut Q) -> bool {
        let mut ray = ray.to_embree();
        // SAFETY: invariants 1, 4, 5 and 6.
        unsafe {
            sys::cyltrace_occluded1(
                self.parts.handle.0,
                &raw mut ray,
                ptr::from_mut(query).cast(),
            );
        }
        ray.tfar == f32::NEG_INFINITY
    }

    /// The closest hit as Embree reports it. A user geometry that shrank the
    /// ray last is named, its answer is in `query`.
    #[inline]
    pub fn closest_native(&self, ray: &Ray32, query: &mut Q) -> Option<NativeHit> {
        NativeHit::from_embree(&self.trace(ray, query))
    }

    /// The box of all primitives; `None` when there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<Box32> {
        self.bounds
    }

    pub(super) fn raw(&self) -> sys::RTCScene {
        self.parts.handle.0
    }

    #[inline]
    pub(super) fn device(&self) -> &Device {
        &self.parts.device
    }

    pub(super) fn is_of(&self, device: &Device) -> bool {
        self.parts.device.handle() == device.handle()
    }

    pub(super) fn has_instances(&self) -> bool {
        !self.parts.instanced.is_empty()
    }

    #[inline]
    fn trace(&self, ray: &Ray32, query: &mut Q) -> sys::RTCRayHit {
        let mut rayhit = ray.to_query();
        // SAFETY: the pointer is to a whole ray and hit, which by invariant 6
        // is all that Embree writes to.
        unsafe { self.trace_into(&raw mut rayhit, query) };
        rayhit
    }

    /// Traverses the scene with a ray and hit of Embree's.
    ///
    /// # Safety
    /// `rayhit` is valid for all that the loaded library writes to it.
    #[inline]
    pub(super) unsafe fn trace_into(&self, rayhit: *mut sys::RTCRayHit, query: &mut Q) {
        // SAFETY: invariants 1, 4 and 5; the caller answers for `rayhit`.
        unsafe {
            sys::cyltrace_intersect1(self.parts.handle.0, rayhit, ptr::from_mut(query).cast());
        }
    }
}
