//! The meshes of a window in Embree, and the crossings of a ray with them.
//!
//! Embree finds the triangles that a ray crosses. The parameters are computed again
//! from the planes of those triangles, in f64, so that the bounds are as tight
//! as the hulls are. They prove nothing: an answer outside of them is a
//! suspect, which `verdict::exact_recheck` judges.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use cyltrace::embree::{self, Device, GeometryId, MeshHit, Ray32, SceneBuilder};
use cyltrace::math::{Bounds, Ray};

use super::crossings::LeafCrossings;
use super::hull::wide;
use super::hull_list::{HullList, hulls};
use super::mesh_frame::MeshFrame;
use super::open_ends::OpenEnds;
use super::window::{PlacedSolid, Window};
use crate::solids::shape;
use cyltrace::solid::tessellation::Fit;

/// Both meshes of every solid of a window.
pub(crate) struct Meshes<'a> {
    /// The sides of each hull.
    pub segments: u32,
    /// A box around each solid, in the world.
    pub boxes: Vec<Bounds>,
    /// The window of the solids.
    pub window: &'a Window,
    /// The missing disks of each solid.
    pub open_ends: Vec<OpenEnds>,
    inner: Mesh,
    outer: Mesh,
    scene: embree::Scene<Vec<MeshHit>>,
}

struct Mesh {
    hulls: HullList,
    geometry: GeometryId,
}

/// A crossing of one hull.
struct Crossing {
    solid: u32,
    is_outer: bool,
    /// Whether it is an entry; for the sheets of a disk, whether it is through the upper one.
    enters: bool,
    t: f64,
}

/// The buffers of a thread that traces rays.
#[derive(Default)]
pub(crate) struct Traversal {
    hits: Vec<MeshHit>,
    crossings: Vec<Crossing>,
    leaves: Vec<LeafCrossings>,
}

impl<'a> Meshes<'a> {
    /// Builds the meshes and Embree's hierarchy over them.
    ///
    /// # Errors
    /// If Embree fails.
    pub fn new(
        device: &Device,
        window: &'a Window,
        frame: &MeshFrame,
        segments: u32,
    ) -> Result<Self, embree::Error> {
        let mut builder = SceneBuilder::new(device)?;
        let mut mesh = |side| {
            let hulls = hulls(window, frame, segments, side);
            let geometry =
                builder.attach_collecting_triangles(&hulls.hull.vertices, &hulls.hull.triangles)?;
            Ok::<Mesh, embree::Error>(Mesh { hulls, geometry })
        };
        let (inner, outer) = (mesh(Fit::Inscribed)?, mesh(Fit::Circumscribed)?);
        let of_solids = window.solids.par_iter();
        Ok(Self {
            segments,
            boxes: of_solids.clone().map(PlacedSolid::bounds).collect(),
            open_ends: of_solids.map(|solid| OpenEnds::new(solid, frame)).collect(),
            window,
            inner,
            outer,
            scene: builder.commit()?,
        })
    }

    /// Whether all leaves of a solid have an inner mesh. Without one, its hits have no
    /// upper bound.
    pub fn has_inner(&self, solid: u32) -> bool {
        let mut leaves = self.window.leaves_with(solid);
        leaves.all(|leaf| !self.inner.hulls.triangles_of(leaf).is_empty())
    }

    /// Solids without an outer hull. Nothing bounds the hits of a ray that may enter their
    /// boxes.
    pub fn unbounded(&self) -> &[u32] {
        &self.outer.hulls.missing
    }

    /// The number of solids without an inner hull, and without an outer one.
    pub fn missing(&self) -> [usize; 2] {
        [
            self.inner.hulls.missing.len(),
            self.outer.hulls.missing.len(),
        ]
    }

    /// The triangles of a solid's outer, then of its inner hull.
    pub fn triangles(&self, solid: u32) -> [impl Iterator<Item = [DVec3; 3]> + '_; 2] {
        [&self.outer.hulls, &self.inner.hulls].map(|hulls| {
            let triangles = hulls.triangles_of(solid);
            triangles.map(|triangle| hulls.corners(triangle))
        })
    }

    /// Calls `found` with the first leaf of each solid whose meshes the ray crosses up to a
    /// parameter, which may be infinite, and with the crossings of its leaves.
    pub fn for_each_solid(
        &self,
        ray: &Ray32,
        up_to: f32,
        buffers: &mut Traversal,
        mut found: impl FnMut(u32, &[LeafCrossings]),
    ) {
        let origin = wide(ray.origin);
        let direction = wide(ray.direction);
        let whole = Ray32 {
            t_far: up_to,
            ..*ray
        };
        self.scene.every_hit(&whole, &mut buffers.hits);
        let crossings = &mut buffers.crossings;
        crossings.clear();
        for hit in &buffers.hits {
            let is_outer = hit.geometry == self.outer.geometry;
            let mesh = if is_outer { &self.outer } else { &self.inner };
            let [a, b, c] = mesh.hulls.corners(hit.primitive as usize);
            let normal = (b - a).cross(c - a);
            let along = normal.dot(direction);
            if along != 0.0 {
                let solid = mesh.hulls.solid_of(hit.primitive);
                let enters = if !is_outer && self.is_disk(solid) {
                    mesh.hulls.is_in_first_half(hit.primitive)
                } else {
                    along < 0.0
                };
                crossings.push(Crossing {
                    solid,
                    is_outer,
                    enters,
                    t: normal.dot(a - origin) / along,
                });
            }
        }
        crossings.sort_unstable_by_key(|crossing| crossing.solid);
        let mut left = crossings.as_slice();
        while let Some(first) = left.first() {
            let leaves = self.window.leaves_with(first.solid);
            let count = left.partition_point(|crossing| crossing.solid < leaves.end);
            let (of_solid, others) = left.split_at(count);
            left = others;
            buffers.leaves.clear();
            buffers.leaves.resize(leaves.len(), LeafCrossings::NONE);
            for crossing in of_solid {
                let leaf = &mut buffers.leaves[(crossing.solid - leaves.start) as usize];
                let hull = if crossing.is_outer {
                    &mut leaf.outer
                } else {
                    &mut leaf.inner
                };
                hull.add(crossing.t, crossing.enters);
            }
            if up_to < f32::INFINITY {
                for leaf in &mut buffers.leaves {
                    leaf.outer.leave_later();
                    leaf.inner.leave_later();
                }
            }
            found(leaves.start, &buffers.leaves);
        }
    }

    /// The leaves of each solid, in order.
    pub fn leaves(&self) -> impl Iterator<Item = Range<u32>> + '_ {
        self.window.leaves()
    }

    /// Whether a solid is a disk, with sheets in place of an inner mesh.
    pub fn is_disk(&self, solid: u32) -> bool {
        shape(&self.window.solids[solid as usize].solid)
            .flat()
            .is_some()
    }

    /// Whether a solid is a composition.
    pub fn is_composed(&self, solid: u32) -> bool {
        self.window.composition_of(solid).is_some()
    }
}

/// Whether a ray may enter a box; `false` is certain.
///
/// A slab's parameter is computed with relative error 3 u of the distance's
/// and the quotient's roundings; the box grows by what the differences round
/// and the range by what the quotients do.
pub(crate) fn may_meet(bounds: &Bounds, ray: &Ray) -> bool {
    const SLACK: f64 = 8.0 * f64::EPSILON;
    let size = bounds.lower.abs().max(bounds.upper.abs()) + ray.origin.abs();
    let (lower, upper) = (bounds.lower - size * SLACK, bounds.upper + size * SLACK);
    let (mut near, mut far) = (ray.t_min, ray.t_max);
    for axis in 0..3 {
        if ray.direction[axis] == 0.0 {
            if ray.origin[axis] < lower[axis] || ray.origin[axis] > upper[axis] {
                return false;
            }
            continue;
        }
        let one = (lower[axis] - ray.origin[axis]) / ray.direction[axis];
        let other = (upper[axis] - ray.origin[axis]) / ray.direction[axis];
        near = near.max(one.min(other));
        far = far.min(one.max(other));
    }
    near - near.abs() * SLACK <= far + far.abs() * SLACK
}
