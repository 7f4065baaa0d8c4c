//! The prisms of a window in Embree, and what a ray meets of them.
//!
//! Embree tells which triangles a ray meets; the parameters are computed anew
//! from the planes of those triangles, in f64, so that the bounds are as tight
//! as the prisms are. They carry no proof: an answer outside of them is a
//! suspect and is judged again by `retrial`.

use glam::DVec3;
use rayon::prelude::*;

use crate::embree::{self, Device, GeometryId, MeshHit, Ray32, SceneBuilder};
use crate::math::{Bounds, Ray};

use super::mesh_frame::MeshFrame;
use super::placed::{PlacedSolid, Window};
use super::prism::{Prisms, Side, prisms};
use crate::check::judging::open_ends::OpenEnds;
use crate::check::judging::sandwich::{Crossings, SolidBounds, solid_bounds};

/// No prism stands for a solid.
const NONE: u32 = u32::MAX;

/// Both prisms of every solid of a window.
pub(crate) struct Meshes {
    /// The sides of each prism.
    pub segments: u32,
    /// A box around each solid, in the world.
    pub boxes: Vec<Bounds>,
    inner: Mesh,
    outer: Mesh,
    open_ends: Vec<OpenEnds>,
    scene: embree::Scene<Vec<MeshHit>>,
}

struct Mesh {
    prisms: Prisms,
    /// The prism of each solid, or [`NONE`].
    prism_of: Vec<u32>,
    geometry: GeometryId,
}

/// What a ray meets of one solid's prisms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// The solid's position in the window.
    pub solid: u32,
    /// The bounds of its first hit.
    pub bounds: SolidBounds,
}

/// A crossing of one prism.
pub(crate) struct Crossing {
    solid: u32,
    is_outer: bool,
    enters: bool,
    t: f64,
}

/// What one thread needs to look along rays.
#[derive(Default)]
pub(crate) struct Scratch {
    hits: Vec<MeshHit>,
    crossings: Vec<Crossing>,
    /// What the last ray met, by solid.
    pub seen: Vec<Seen>,
}

impl Meshes {
    /// Builds the meshes and Embree's hierarchy over them.
    ///
    /// # Errors
    /// When Embree refuses.
    pub fn new(
        device: &Device,
        window: &Window,
        frame: &MeshFrame,
        segments: u32,
    ) -> Result<Self, embree::Error> {
        let solids = window.solids.len();
        let mut builder = SceneBuilder::new(device)?;
        let mut mesh = |side| {
            let prisms = prisms(window, frame, segments, side);
            let geometry =
                builder.attach_collecting_triangles(&prisms.vertices, &prisms.triangles)?;
            let mut prism_of = vec![NONE; solids];
            for (prism, &solid) in prisms.solid_of.iter().enumerate() {
                prism_of[solid as usize] = prism as u32;
            }
            Ok::<Mesh, embree::Error>(Mesh {
                prisms,
                prism_of,
                geometry,
            })
        };
        let (inner, outer) = (mesh(Side::Inscribed)?, mesh(Side::Circumscribed)?);
        let of_solids = window.solids.par_iter();
        Ok(Self {
            segments,
            boxes: of_solids.clone().map(PlacedSolid::bounds).collect(),
            open_ends: of_solids.map(|solid| OpenEnds::new(solid, frame)).collect(),
            inner,
            outer,
            scene: builder.commit()?,
        })
    }

    /// Whether a solid has an inner prism: without one, its hits have no upper
    /// bound.
    pub fn has_inner(&self, solid: u32) -> bool {
        self.inner.prism_of[solid as usize] != NONE
    }

    /// Solids without an outer prism: nothing bounds the hits of a ray that
    /// may meet their boxes.
    pub fn unbounded(&self) -> &[u32] {
        &self.outer.prisms.unbounded
    }

    /// How many solids have no inner prism.
    pub fn empty(&self) -> usize {
        self.inner.prisms.empty.len()
    }

    /// The triangles of a solid's outer, then of its inner prism.
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
                crossings.push(Crossing {
                    solid: mesh.solid_of(hit.primitive),
                    is_outer,
                    enters: along < 0.0,
                    t: normal.dot(a - origin) / along,
                });
            }
        }
        crossings.sort_unstable_by_key(|crossing| crossing.solid);
        scratch.seen.clear();
        for of_solid in crossings.chunk_by(|one, other| one.solid == other.solid) {
            let (mut outer, mut inner) = (Crossings::NONE, Crossings::NONE);
            for crossing in of_solid {
                let prism = if crossing.is_outer {
                    &mut outer
                } else {
                    &mut inner
                };
                prism.add(crossing.t, crossing.enters);
            }
            if up_to < f32::INFINITY {
                outer.leave_later();
                inner.leave_later();
            }
            let solid = of_solid[0].solid;
            scratch.seen.push(Seen {
                solid,
                bounds: self.bounds(solid, ray, &outer, &inner),
            });
        }
    }

    /// The bounds that crossings of a solid's prisms make.
    pub fn bounds(
        &self,
        solid: u32,
        ray: &Ray32,
        outer: &Crossings,
        inner: &Crossings,
    ) -> SolidBounds {
        let ends = &self.open_ends[solid as usize];
        let (origin, direction) = (point(ray.origin), point(ray.direction));
        solid_bounds(outer, inner, f64::from(ray.t_near), |t| {
            ends.are_passed(origin, direction, t)
        })
    }
}

impl Mesh {
    fn solid_of(&self, triangle: u32) -> u32 {
        self.prisms.solid_of[triangle as usize / self.prisms.triangles_per_prism]
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        let corners = self.prisms.triangles[triangle];
        corners.map(|vertex| point(self.prisms.vertices[vertex as usize]))
    }

    fn triangles_of(&self, solid: u32) -> Option<impl Iterator<Item = [DVec3; 3]> + '_> {
        let prism = self.prism_of[solid as usize];
        let count = self.prisms.triangles_per_prism;
        let first = prism as usize * count;
        (prism != NONE).then(|| (first..first + count).map(|triangle| self.corners(triangle)))
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
