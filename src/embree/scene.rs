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

// SAFETY: invariant 5: while it is written to, one builder owns it; afterwards it is only read.
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

/// A scene that other scenes have instances of, with any type of query.
trait Instanced: Send + Sync {}

impl<Q: Query> Instanced for Scene<Q> {}

/// An Embree scene and what has to outlive it. The fields are dropped in their order (invariant
/// 2).
pub(super) struct Parts {
    handle: SceneHandle,
    /// `Arc` because, unlike a `Box`, it may be moved while Embree stores a pointer into it.
    /// There is no second owner.
    user_data: Vec<(GeometryId, Arc<dyn UserData>)>,
    /// Scenes that this one has instances of.
    instanced: Vec<Arc<dyn Instanced>>,
    device: Device,
}

/// A scene under construction, for queries with a state of type `Q`.
///
/// The scene owns what is attached, and drops it exactly once, also if the scene is never
/// committed.
///
/// A builder may be sent to another thread, but not shared between threads:
/// ```compile_fail,E0277
/// fn shared<T: Sync>() {}
/// shared::<cyltrace::embree::SceneBuilder<()>>();
/// ```
pub struct SceneBuilder<Q: Query> {
    parts: Parts,
    query: PhantomData<fn(&mut Q)>,
    /// Makes the builder `!Sync`.
    unshared: PhantomData<Cell<()>>,
}

impl<Q: Query> SceneBuilder<Q> {
    /// An empty scene.
    ///
    /// # Errors
    /// When Embree reports an error, for example that memory ran out.
    pub fn new(device: &Device) -> Result<Self, Error> {
        // SAFETY: invariant 1.
        let handle = SceneHandle(unsafe { sys::rtcNewScene(device.handle()) });
        device.check("make a scene")?;
        // Meshes verify exact results, so no ray may pass between two triangles. User geometry
        // is the same with and without this flag.
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

    /// Attaches a geometry and takes ownership of its user data.
    pub(super) fn attach_with(
        &mut self,
        data: Arc<dyn UserData>,
        geometry: &GeometryHandle,
    ) -> Result<GeometryId, Error> {
        let id = self.attach(geometry);
        // Kept also after an error: the geometry may have been attached anyway.
        let kept_for = *id.as_ref().unwrap_or(&GeometryId(u32::MAX));
        self.parts.user_data.push((kept_for, data));
        id
    }

    pub(super) fn device(&self) -> &Device {
        &self.parts.device
    }

    /// Keeps a scene alive as long as this one.
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

    /// As [`attach`](Self::attach), with a given number.
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

    /// Builds the hierarchy. Calls `bounds` of user geometries from this thread and from
    /// Embree's threads.
    ///
    /// # Errors
    /// When Embree reports an error, for example that memory ran out, or when a primitive of a
    /// user geometry has bounds that Embree would skip.
    pub fn commit(self) -> Result<Scene<Q>, Error> {
        let parts = self.parts;
        // SAFETY: invariants 1 and 5: this builder was the only owner, and it is consumed.
        unsafe { sys::rtcCommitScene(parts.handle.0) };
        parts.device.check("commit a scene")?;
        parts.into_scene()
    }

    /// The parts that were attached so far.
    pub(super) fn into_parts(self) -> Parts {
        self.parts
    }
}

impl Parts {
    /// The Embree scene, valid as long as these parts.
    pub(super) fn raw(&self) -> sys::RTCScene {
        self.handle.0
    }

    pub(super) fn device(&self) -> &Device {
        &self.device
    }

    /// The scene of committed parts.
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

/// A built scene. It never changes, and any number of threads may query it at the same time,
/// also from within a callback of another query. Each level of such nesting takes 5 to 12 kB of
/// stack for a single ray, and 24 to 65 kB for a packet.
pub struct Scene<Q: Query> {
    parts: Parts,
    bounds: Option<Box32>,
    query: PhantomData<fn(&mut Q)>,
}

impl<Q: Query> Scene<Q> {
    /// Traverses the scene for the closest hit. User geometries store their results in `query`;
    /// hits that Embree finds itself are not reported.
    #[inline]
    pub fn closest(&self, ray: &Ray32, query: &mut Q) {
        self.trace(ray, query);
    }

    /// Traverses the scene until anything is hit. Returns whether there was a hit.
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

    /// The closest hit as Embree reports it. It names the user geometry that shortened the ray
    /// last; that geometry's own result is in `query`.
    #[inline]
    pub fn closest_native(&self, ray: &Ray32, query: &mut Q) -> Option<NativeHit> {
        NativeHit::from_embree(&self.trace(ray, query))
    }

    /// The box of all primitives; `None` if there are none.
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

    /// Traverses the scene with Embree's structure of a ray and a hit.
    ///
    /// # Safety
    /// `rayhit` is valid for all that the loaded library writes to it.
    #[inline]
    pub(super) unsafe fn trace_into(&self, rayhit: *mut sys::RTCRayHit, query: &mut Q) {
        // SAFETY: invariants 1, 4 and 5; the caller guarantees `rayhit`.
        unsafe {
            sys::cyltrace_intersect1(self.parts.handle.0, rayhit, ptr::from_mut(query).cast());
        }
    }
}
