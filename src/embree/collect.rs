//! All hits of a ray with triangles or curves, from one traversal.
//!
//! Embree searches for the closest hit: each candidate would shorten the ray and hide what is
//! behind it. A filter function sees every candidate before that. The filter function here
//! records the candidate and rejects it, so the ray keeps its length and the traversal visits
//! everything.
//!
//! Embree may report a triangle more than once (a hierarchy with spatial splits has it in
//! several leaves), in an order that depends on the processor. Hits are therefore sorted by
//! triangle, and duplicates removed.

use super::abort::AbortOnPanic;
use super::device::Device;
use super::error::Error;
use super::geometry::GeometryHandle;
use super::native::Curve;
use super::ray::{NativeHit, Ray32};
use super::scene::{Scene, SceneBuilder};
use super::sys::{self, word};
use super::types::GeometryId;

/// A triangle that a ray hits, in f32 as Embree computes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshHit {
    /// The mesh.
    pub geometry: GeometryId,
    /// The triangle's number in the mesh.
    pub primitive: u32,
    /// The ray's parameter.
    pub t: f32,
    /// Geometric normal, not normalized; it points to the side from which the
    /// vertices run counter-clockwise.
    pub normal: [f32; 3],
}

/// What is recorded of a candidate.
trait Collected {
    fn new(hit: NativeHit) -> Self;
}

impl Collected for MeshHit {
    fn new(hit: NativeHit) -> Self {
        Self {
            geometry: hit.geometry,
            primitive: hit.primitive,
            t: hit.t,
            normal: hit.normal,
        }
    }
}

impl Collected for NativeHit {
    fn new(hit: NativeHit) -> Self {
        hit
    }
}

impl SceneBuilder<Vec<MeshHit>> {
    /// Adds a triangle mesh as [`attach_triangles`](Self::attach_triangles) does.
    /// [`Scene::every_hit`] reports its triangles; a query for the closest hit passes through
    /// them.
    ///
    /// # Errors
    /// As for [`attach_triangles`](Self::attach_triangles), and when the installed Embree was
    /// built without filter functions or culls back faces.
    pub fn attach_collecting_triangles(
        &mut self,
        vertices: &[[f32; 3]],
        triangles: &[[u32; 3]],
    ) -> Result<GeometryId, Error> {
        let mesh = self.new_triangles(vertices, triangles)?;
        attach_collecting(self, &mesh)
    }
}

impl SceneBuilder<Vec<NativeHit>> {
    /// Adds cone curves as [`attach_cone_curves`](Self::attach_cone_curves) does.
    /// [`Scene::every_hit`] reports where the ray enters and leaves each segment.
    ///
    /// # Errors
    /// As for [`attach_cone_curves`](Self::attach_cone_curves), and when the installed Embree
    /// was built without filter functions or culls back faces.
    pub fn attach_collecting_cone_curves(
        &mut self,
        vertices: &[[f32; 4]],
        segments: &[u32],
        neighbours: Option<&[u8]>,
    ) -> Result<GeometryId, Error> {
        let curves = self.new_curves(Curve::Cone, vertices, segments, neighbours)?;
        attach_collecting(self, &curves)
    }
}

/// Attaches a geometry whose hits are recorded and rejected.
fn attach_collecting<H: Collected + 'static>(
    builder: &mut SceneBuilder<Vec<H>>,
    geometry: &GeometryHandle,
) -> Result<GeometryId, Error> {
    check_support(builder.device())?;
    // SAFETY: invariants 1 and 5; by invariant 4 `collect` may cast the query, since the
    // builder's `Q` is `Vec<H>`.
    unsafe { sys::rtcSetGeometryIntersectFilterFunction(geometry.raw(), Some(collect::<H>)) };
    builder.device().check("set a geometry's filter function")?;
    builder.attach(geometry)
}

impl Scene<Vec<MeshHit>> {
    /// Replaces `hits` with all triangles of collecting meshes that the ray hits with `t` in
    /// its range: from the front and from the back, each once, sorted by mesh and triangle.
    ///
    /// Like all results of Embree, they are those of f32 arithmetic. A ray in the plane of a
    /// triangle does not hit it. A ray through an edge hits at least one of its triangles, and
    /// maybe both.
    pub fn every_hit(&self, ray: &Ray32, hits: &mut Vec<MeshHit>) {
        hits.clear();
        self.closest(ray, hits);
        hits.sort_unstable_by_key(triangle);
        hits.dedup_by_key(|hit| triangle(hit));
    }
}

impl Scene<Vec<NativeHit>> {
    /// Replaces `hits` with all hits of collecting curves with `t` in the ray's range: at most
    /// two per segment, sorted by geometry, segment and `t`.
    pub fn every_hit(&self, ray: &Ray32, hits: &mut Vec<NativeHit>) {
        hits.clear();
        self.closest(ray, hits);
        hits.sort_unstable_by(|a, b| {
            let places = (a.geometry, a.primitive).cmp(&(b.geometry, b.primitive));
            places.then(a.t.total_cmp(&b.t))
        });
        hits.dedup();
    }
}

fn triangle(hit: &MeshHit) -> (GeometryId, u32) {
    (hit.geometry, hit.primitive)
}

/// Returns an error if the installed Embree would lose hits.
fn check_support(device: &Device) -> Result<(), Error> {
    let is_set = |property| device.property(property) != 0;
    let missing = if !is_set(sys::RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED) {
        "filter functions"
    } else if is_set(sys::RTC_DEVICE_PROPERTY_BACKFACE_CULLING_ENABLED) {
        "hits with the back of a surface"
    } else {
        return Ok(());
    };
    Err(Error::Unsupported { missing })
}

/// Records the candidate and rejects it.
unsafe extern "C" fn collect<H: Collected>(args: *const sys::RTCFilterFunctionNArguments) {
    AbortOnPanic::run("filter", || {
        // SAFETY: invariant 7.
        let args = unsafe { &*args };
        assert_eq!(args.N, 1, "only single rays are traced");
        // SAFETY: invariant 4: this filter is set only in scenes with this type of query.
        let hits: &mut Vec<H> =
            unsafe { &mut *(*args.context.cast::<sys::cyltrace_context>()).query.cast() };
        // SAFETY: invariant 7: the candidate's `t` is the ray's end.
        let t = unsafe { *args.ray.cast::<f32>().add(word::RAY_T_FAR) };
        // SAFETY: invariant 7: one lane of hits is the structure of one hit.
        let hit = unsafe { &*args.hit.cast::<sys::RTCHit>() };
        hits.push(H::new(NativeHit::new(t, hit)));
        // SAFETY: invariant 7: one mask per lane; zero rejects.
        unsafe { *args.valid = 0 };
    });
}
