//! Every triangle that a ray meets, from one traversal.
//!
//! Embree looks for the closest hit: each candidate would shorten the ray and
//! hide what lies behind it. A filter function is asked about every candidate
//! before that, and here it writes the candidate down and refuses it, so the
//! ray keeps its length and the traversal reaches all triangles.
//!
//! Embree may ask about a triangle more than once (a hierarchy with spatial
//! splits holds it in several leaves) and in an order that depends on the
//! processor. Hits are therefore sorted and told apart by their triangle
//! before anyone sees them.

use super::abort::AbortOnPanic;
use super::device::Device;
use super::error::Error;
use super::ray::Ray32;
use super::scene::{GeometryId, Scene, SceneBuilder};
use super::sys::{self, word};

/// A triangle that a ray meets, in f32 as Embree computes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshHit {
    /// The mesh.
    pub geometry: GeometryId,
    /// The triangle's number in the mesh.
    pub primitive: u32,
    /// The ray's parameter.
    pub t: f32,
    /// Geometric normal, not normalised; it points to the side from which the
    /// vertices run counter-clockwise.
    pub normal: [f32; 3],
}

impl SceneBuilder<Vec<MeshHit>> {
    /// Adds a triangle mesh as [`attach_triangles`](Self::attach_triangles)
    /// does; [`Scene::every_hit`] finds its triangles, and a query for the
    /// closest hit passes through them.
    ///
    /// # Errors
    /// As for [`attach_triangles`](Self::attach_triangles), and when the
    /// installed Embree was built without filter functions or does not see the
    /// back of a triangle.
    pub fn attach_collecting_triangles(
        &mut self,
        vertices: &[[f32; 3]],
        triangles: &[[u32; 3]],
    ) -> Result<GeometryId, Error> {
        check_support(self.device())?;
        let mesh = self.new_triangles(vertices, triangles)?;
        // SAFETY: invariants 1 and 5; by invariant 4 `collect` may take the
        // query for what it is, since this builder's `Q` is `Vec<MeshHit>`.
        unsafe { sys::rtcSetGeometryIntersectFilterFunction(mesh.raw(), Some(collect)) };
        self.device().check("set a mesh's filter function")?;
        self.attach(&mesh)
    }
}

impl Scene<Vec<MeshHit>> {
    /// Replaces `hits` by all triangles of collecting meshes that Embree finds
    /// the ray to meet with `t` in its range: front and back, each once, sorted
    /// by mesh and triangle.
    ///
    /// Like all of Embree's answers they are those of f32 arithmetic. A ray in
    /// the plane of a triangle does not meet it; one through an edge meets one
    /// neighbour at least, and maybe both.
    pub fn every_hit(&self, ray: &Ray32, hits: &mut Vec<MeshHit>) {
        hits.clear();
        self.closest(ray, hits);
        hits.sort_unstable_by_key(triangle);
        hits.dedup_by_key(|hit| triangle(hit));
    }
}

fn triangle(hit: &MeshHit) -> (GeometryId, u32) {
    (hit.geometry, hit.primitive)
}

/// Whether all triangles would be found.
fn check_support(device: &Device) -> Result<(), Error> {
    let is_set = |property| device.property(property) != 0;
    let missing = if !is_set(sys::RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED) {
        "filter functions"
    } else if is_set(sys::RTC_DEVICE_PROPERTY_BACKFACE_CULLING_ENABLED) {
        "hits with the back of triangles"
    } else {
        return Ok(());
    };
    Err(Error::Unsupported { missing })
}

/// Writes the candidate down and refuses it.
unsafe extern "C" fn collect(args: *const sys::RTCFilterFunctionNArguments) {
    AbortOnPanic::run("filter", || {
        // SAFETY: invariant 7.
        let args = unsafe { &*args };
        assert_eq!(args.N, 1, "only single rays are traced");
        // SAFETY: invariant 4: this filter is set in scenes for this query only.
        let hits: &mut Vec<MeshHit> =
            unsafe { &mut *(*args.context.cast::<sys::cyltrace_context>()).query.cast() };
        // SAFETY: invariant 7: the candidate's `t` stands as the ray's end.
        let t = unsafe { *args.ray.cast::<f32>().add(word::RAY_T_FAR) };
        // SAFETY: invariant 7: one lane of hits is the structure of one hit.
        let hit = unsafe { &*args.hit.cast::<sys::RTCHit>() };
        hits.push(MeshHit {
            geometry: GeometryId(hit.geomID),
            primitive: hit.primID,
            t,
            normal: [hit.Ng_x, hit.Ng_y, hit.Ng_z],
        });
        // SAFETY: invariant 7: one mask a lane; zero refuses.
        unsafe { *args.valid = 0 };
    });
}
