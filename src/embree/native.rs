//! Geometry that Embree intersects itself: triangle meshes, straight curves, spheres and disks.

use super::error::Error;
use super::geometry::GeometryHandle;
use super::query::Query;
use super::ray::is_inside;
use super::scene::SceneBuilder;
use super::sys;
use super::types::GeometryId;

/// The shape of the ends of a straight curve.
#[derive(Clone, Copy)]
pub(super) enum Curve {
    /// Flat.
    Cone,
    /// Spheres.
    Round,
}

impl<Q: Query> SceneBuilder<Q> {
    /// Adds a triangle mesh. Each triangle is three vertex numbers. The vertices are copied.
    ///
    /// # Errors
    /// When a vertex is not finite or too far out, a triangle uses a vertex that does not
    /// exist, or Embree reports an error.
    pub fn attach_triangles(
        &mut self,
        vertices: &[[f32; 3]],
        triangles: &[[u32; 3]],
    ) -> Result<GeometryId, Error> {
        let mesh = self.new_triangles(vertices, triangles)?;
        self.attach(&mesh)
    }

    /// A triangle mesh that is not attached yet.
    pub(super) fn new_triangles(
        &self,
        vertices: &[[f32; 3]],
        triangles: &[[u32; 3]],
    ) -> Result<GeometryHandle, Error> {
        check_vertices(vertices, |_| true)?;
        for (primitive, corners) in triangles.iter().enumerate() {
            for &vertex in corners {
                check_index(primitive, u64::from(vertex), vertices.len())?;
            }
        }
        let mesh = GeometryHandle::new(self.device(), sys::RTC_GEOMETRY_TYPE_TRIANGLE)?;
        self.fill(
            &mesh,
            sys::RTC_BUFFER_TYPE_VERTEX,
            sys::RTC_FORMAT_FLOAT3,
            vertices,
        )?;
        self.fill(
            &mesh,
            sys::RTC_BUFFER_TYPE_INDEX,
            sys::RTC_FORMAT_UINT3,
            triangles,
        )?;
        Ok(mesh)
    }

    /// Adds Embree's straight cone segments (`CONE_LINEAR_CURVE`), the alternative to analytic
    /// cylinders. A vertex is a point and a radius; a segment goes from the given vertex to the
    /// next one. `neighbours` has a byte per segment: 1 if the segment to the left continues
    /// it, 2 if the segment to the right does, 3 if both do. An end without a neighbour is
    /// capped; `None` caps all.
    ///
    /// # Errors
    /// When a vertex is not finite, too far out or has a negative radius, a segment uses a
    /// vertex that does not exist, the number of flags differs from that of segments, or Embree
    /// reports an error.
    pub fn attach_cone_curves(
        &mut self,
        vertices: &[[f32; 4]],
        segments: &[u32],
        neighbours: Option<&[u8]>,
    ) -> Result<GeometryId, Error> {
        let curves = self.new_curves(Curve::Cone, vertices, segments, neighbours)?;
        self.attach(&curves)
    }

    /// Adds Embree's straight segments with round ends (`ROUND_LINEAR_CURVE`): cones that touch
    /// a sphere at each end. The parameters are those of
    /// [`attach_cone_curves`](Self::attach_cone_curves).
    ///
    /// # Errors
    /// As for [`attach_cone_curves`](Self::attach_cone_curves).
    pub fn attach_round_curves(
        &mut self,
        vertices: &[[f32; 4]],
        segments: &[u32],
        neighbours: Option<&[u8]>,
    ) -> Result<GeometryId, Error> {
        let curves = self.new_curves(Curve::Round, vertices, segments, neighbours)?;
        self.attach(&curves)
    }

    /// Adds Embree's spheres (`SPHERE_POINT`): points and radii. Embree reports the point where
    /// a ray enters a sphere, or where it leaves if it starts inside.
    ///
    /// # Errors
    /// When a number is not finite or too far out, a radius is negative, or Embree reports an
    /// error.
    pub fn attach_spheres(&mut self, spheres: &[[f32; 4]]) -> Result<GeometryId, Error> {
        let points = self.new_points(sys::RTC_GEOMETRY_TYPE_SPHERE_POINT, spheres)?;
        self.attach(&points)
    }

    /// Adds Embree's flat disks (`ORIENTED_DISC_POINT`): points and radii, and for each a
    /// normal of any length. A ray hits them from either side.
    ///
    /// # Errors
    /// As for [`attach_spheres`](Self::attach_spheres), and when a normal is not finite or too
    /// long, or the number of normals differs from that of disks.
    pub fn attach_disks(
        &mut self,
        disks: &[[f32; 4]],
        normals: &[[f32; 3]],
    ) -> Result<GeometryId, Error> {
        if let Some(disk) = normals.iter().position(|normal| !is_inside(normal)) {
            return Err(Error::Normal {
                disk,
                value: normals[disk],
            });
        }
        if normals.len() != disks.len() {
            return Err(Error::NormalCount {
                normals: normals.len(),
                disks: disks.len(),
            });
        }
        let points = self.new_points(sys::RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT, disks)?;
        // Embree reads 16 bytes for each, but does not pad this buffer.
        let padded: Vec<[f32; 4]> = normals.iter().map(|&[x, y, z]| [x, y, z, 0.0]).collect();
        self.fill(
            &points,
            sys::RTC_BUFFER_TYPE_NORMAL,
            sys::RTC_FORMAT_FLOAT3,
            &padded,
        )?;
        self.attach(&points)
    }

    /// Points with radii, not attached yet.
    fn new_points(
        &self,
        kind: sys::RTCGeometryType,
        vertices: &[[f32; 4]],
    ) -> Result<GeometryHandle, Error> {
        check_vertices(vertices, |&[_, _, _, radius]| radius >= 0.0)?;
        let points = GeometryHandle::new(self.device(), kind)?;
        self.fill(
            &points,
            sys::RTC_BUFFER_TYPE_VERTEX,
            sys::RTC_FORMAT_FLOAT4,
            vertices,
        )?;
        Ok(points)
    }

    /// Curves that are not attached yet.
    pub(super) fn new_curves(
        &self,
        curve: Curve,
        vertices: &[[f32; 4]],
        segments: &[u32],
        neighbours: Option<&[u8]>,
    ) -> Result<GeometryHandle, Error> {
        check_vertices(vertices, |&[_, _, _, radius]| radius >= 0.0)?;
        for (primitive, &first) in segments.iter().enumerate() {
            check_index(primitive, u64::from(first) + 1, vertices.len())?;
        }
        let capped;
        let flags = if let Some(flags) = neighbours {
            flags
        } else {
            capped = vec![0; segments.len()];
            &capped
        };
        if flags.len() != segments.len() {
            return Err(Error::FlagCount {
                flags: flags.len(),
                segments: segments.len(),
            });
        }
        let kind = match curve {
            Curve::Cone => sys::RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE,
            Curve::Round => sys::RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE,
        };
        let curves = GeometryHandle::new(self.device(), kind)?;
        self.fill(
            &curves,
            sys::RTC_BUFFER_TYPE_VERTEX,
            sys::RTC_FORMAT_FLOAT4,
            vertices,
        )?;
        self.fill(
            &curves,
            sys::RTC_BUFFER_TYPE_INDEX,
            sys::RTC_FORMAT_UINT,
            segments,
        )?;
        self.fill(
            &curves,
            sys::RTC_BUFFER_TYPE_FLAGS,
            sys::RTC_FORMAT_UCHAR,
            flags,
        )?;
        Ok(curves)
    }

    /// Copies `items` into a new buffer of Embree's. Embree pads vertex buffers for its 16-byte
    /// loads.
    fn fill<T: Copy>(
        &self,
        geometry: &GeometryHandle,
        kind: sys::RTCBufferType,
        format: sys::RTCFormat,
        items: &[T],
    ) -> Result<(), Error> {
        // SAFETY: invariants 1 and 5.
        let buffer = unsafe {
            sys::rtcSetNewGeometryBuffer(
                geometry.raw(),
                kind,
                0,
                format,
                size_of::<T>(),
                items.len(),
            )
        };
        self.device().check("make a geometry's buffer")?;
        // SAFETY: Embree allocated this number of items of this size, apart from ours;
        // invariant 5: nothing reads it yet.
        unsafe {
            buffer
                .cast::<T>()
                .copy_from_nonoverlapping(items.as_ptr(), items.len())
        };
        Ok(())
    }
}

/// Checks vertices. Embree skips primitives with bad vertices silently.
fn check_vertices<const N: usize>(
    vertices: &[[f32; N]],
    is_good: impl Fn(&[f32; N]) -> bool,
) -> Result<(), Error> {
    let bad = |vertex: &[f32; N]| !is_inside(vertex) || !is_good(vertex);
    match vertices.iter().position(bad) {
        None => Ok(()),
        Some(vertex) => Err(Error::Vertex {
            vertex,
            value: vertices[vertex].to_vec(),
        }),
    }
}

/// Checks a vertex number. Embree does not check it and would read foreign memory.
fn check_index(primitive: usize, vertex: u64, vertices: usize) -> Result<(), Error> {
    if vertex < vertices as u64 {
        return Ok(());
    }
    Err(Error::VertexIndex {
        primitive,
        vertex,
        vertices,
    })
}
