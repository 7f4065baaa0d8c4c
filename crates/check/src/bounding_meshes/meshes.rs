//! The meshes of a window in Embree, and what a ray meets of them.
//!
//! Embree tells which triangles a ray meets; the parameters are computed anew
//! from the planes of those triangles, in f64, so that the bounds are as tight
//! as the hulls are. They carry no proof: an answer outside of them is a
//! suspect and is judged again by `retrial`.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use cyltrace::embree::{self, Device, GeometryId, MeshHit, Ray32, SceneBuilder};
use cyltrace::math::{Bounds, Ray};

use super::hull_list::{HullList, hulls};
use super::mesh_frame::MeshFrame;
use super::window::{PlacedSolid, Window};
use crate::verdict::composed::composed_bounds;
use crate::verdict::open_ends::OpenEnds;
use crate::verdict::sandwich::{Crossings, SolidBounds, sheet_bounds, solid_bounds};
use cyltrace::solid::AnySolid;
use cyltrace::solid::tessellation::Fit;

/// No hull stands for a solid.
const NONE: u32 = u32::MAX;

/// Both meshes of every solid of a window.
pub(crate) struct Meshes<'a> {
    /// The sides of each hull.
    pub segments: u32,
    /// A box around each solid, in the world.
    pub boxes: Vec<Bounds>,
    window: &'a Window,
    inner: Mesh,
    outer: Mesh,
    open_ends: Vec<OpenEnds>,
    scene: embree::Scene<Vec<MeshHit>>,
}

struct Mesh {
    hulls: HullList,
    /// The hull of each solid, or [`NONE`].
    hull_of: Vec<u32>,
    geometry: GeometryId,
}

/// What a ray meets of one solid's meshes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// The position in the window of the solid's only or first leaf.
    pub solid: u32,
    /// The bounds of its first hit.
    pub bounds: SolidBounds,
}

/// A crossing of one hull.
pub(crate) struct Crossing {
    solid: u32,
    is_outer: bool,
    /// Whether it is a way in; of the sheets of a disk, one through that over it.
    enters: bool,
    t: f64,
}

/// What a ray meets of the meshes of a leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeafCrossings {
    /// Of the mesh around it.
    pub outer: Crossings,
    /// Of the mesh within it, or of the sheets of a disk: through that over it are the
    /// ways in, through that under it the ways out.
    pub inner: Crossings,
}

impl LeafCrossings {
    /// Neither is met.
    pub const NONE: Self = Self {
        outer: Crossings::NONE,
        inner: Crossings::NONE,
    };
}

/// What one thread needs to look along rays.
#[derive(Default)]
pub(crate) struct Scratch {
    hits: Vec<MeshHit>,
    crossings: Vec<Crossing>,
    leaves: Vec<LeafCrossings>,
    /// What the last ray met, by solid.
    pub seen: Vec<Seen>,
}

impl<'a> Meshes<'a> {
    /// Builds the meshes and Embree's hierarchy over them.
    ///
    /// # Errors
    /// When Embree refuses.
    pub fn new(
        device: &Device,
        window: &'a Window,
        frame: &MeshFrame,
        segments: u32,
    ) -> Result<Self, embree::Error> {
        let solids = window.solids.len();
        let mut builder = SceneBuilder::new(device)?;
        let mut mesh = |side| {
            let hulls = hulls(window, frame, segments, side);
            let geometry =
                builder.attach_collecting_triangles(&hulls.hull.vertices, &hulls.hull.triangles)?;
            let mut hull_of = vec![NONE; solids];
            for (hull, &solid) in hulls.solid_of.iter().enumerate() {
                hull_of[solid as usize] = hull as u32;
            }
            Ok::<Mesh, embree::Error>(Mesh {
                hulls,
                hull_of,
                geometry,
            })
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

    /// Whether all leaves of a solid have an inner mesh: without one, its hits have no
    /// upper bound.
    pub fn has_inner(&self, solid: u32) -> bool {
        let mut leaves = self.window.leaves_with(solid);
        leaves.all(|leaf| self.inner.hull_of[leaf as usize] != NONE)
    }

    /// Solids without an outer hull: nothing bounds the hits of a ray that
    /// may meet their boxes.
    pub fn unbounded(&self) -> &[u32] {
        &self.outer.hulls.unbounded
    }

    /// How many solids have no inner hull.
    pub fn empty(&self) -> usize {
        self.inner.hulls.empty.len()
    }

    /// The triangles of a solid's outer, then of its inner hull.
    pub fn triangles(&self, solid: u32) -> [Option<impl Iterator<Item = [DVec3; 3]> + '_>; 2] {
        [&self.outer, &self.inner].map(|mesh| mesh.triangles_of(solid))
    }

    /// Writes what Embree finds the ray to meet up to a parameter, which may be
    /// infinite, to `scratch.seen`.
    pub fn look(&self, ray: &Ray32, up_to: f32, scratch: &mut Scratch) {
        let origin = point(ray.origin);
        let direction = point(ray.direction);
        let whole = Ray32 {
            t_far: up_to,
            ..*ray
        };
        self.scene.every_hit(&whole, &mut scratch.hits);
        let crossings = &mut scratch.crossings;
        crossings.clear();
        for hit in &scratch.hits {
            let is_outer = hit.geometry == self.outer.geometry;
            let mesh = if is_outer { &self.outer } else { &self.inner };
            let [a, b, c] = mesh.corners(hit.primitive as usize);
            let normal = (b - a).cross(c - a);
            let along = normal.dot(direction);
            if along != 0.0 {
                let solid = mesh.solid_of(hit.primitive);
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
        scratch.seen.clear();
        let mut left = crossings.as_slice();
        while let Some(first) = left.first() {
            let leaves = self.window.leaves_with(first.solid);
            let count = left.partition_point(|crossing| crossing.solid < leaves.end);
            let (of_solid, others) = left.split_at(count);
            left = others;
            scratch.leaves.clear();
            scratch.leaves.resize(leaves.len(), LeafCrossings::NONE);
            for crossing in of_solid {
                let leaf = &mut scratch.leaves[(crossing.solid - leaves.start) as usize];
                let hull = if crossing.is_outer {
                    &mut leaf.outer
                } else {
                    &mut leaf.inner
                };
                hull.add(crossing.t, crossing.enters);
            }
            if up_to < f32::INFINITY {
                for leaf in &mut scratch.leaves {
                    leaf.outer.leave_later();
                    leaf.inner.leave_later();
                }
            }
            scratch.seen.push(Seen {
                solid: leaves.start,
                bounds: self.bounds(leaves.start, ray, &scratch.leaves),
            });
        }
    }

    /// The leaves of each solid, in order.
    pub fn leaves(&self) -> impl Iterator<Item = Range<u32>> + '_ {
        self.window.leaves()
    }

    /// The bounds that crossings of the meshes of a solid's leaves make.
    pub fn bounds(&self, solid: u32, ray: &Ray32, leaves: &[LeafCrossings]) -> SolidBounds {
        let t_min = f64::from(ray.t_near);
        if let Some(found) = self.window.composition_of(solid) {
            return composed_bounds(&found.composition, leaves, t_min);
        }
        let LeafCrossings { outer, inner } = &leaves[0];
        if self.is_disk(solid) {
            return sheet_bounds(outer, inner, t_min);
        }
        let ends = &self.open_ends[solid as usize];
        let (origin, direction) = (point(ray.origin), point(ray.direction));
        solid_bounds(outer, inner, t_min, |t| {
            ends.are_passed(origin, direction, t)
        })
    }

    /// Whether a solid is a disk, with sheets in place of an inner mesh.
    pub fn is_disk(&self, solid: u32) -> bool {
        matches!(self.window.solids[solid as usize].solid, AnySolid::Disk(_))
    }

    /// Whether a solid is a composition.
    pub fn is_composed(&self, solid: u32) -> bool {
        self.window.composition_of(solid).is_some()
    }
}

impl Mesh {
    fn solid_of(&self, triangle: u32) -> u32 {
        self.hulls.solid_of[self.hulls.hull_of(triangle)]
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        let corners = self.hulls.hull.triangles[triangle];
        corners.map(|vertex| point(self.hulls.hull.vertices[vertex as usize]))
    }

    fn triangles_of(&self, solid: u32) -> Option<impl Iterator<Item = [DVec3; 3]> + '_> {
        let hull = self.hull_of[solid as usize];
        (hull != NONE).then(|| {
            let triangles = self.hulls.triangles_of(hull as usize);
            triangles.map(|triangle| self.corners(triangle))
        })
    }
}

/// A point of f32 numbers in f64.
pub(crate) fn point(x: [f32; 3]) -> DVec3 {
    DVec3::from_array(x.map(f64::from))
}

/// Whether a ray may come through a box; `false` is certain.
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
