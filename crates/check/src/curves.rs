//! Embree's own cone curves as a witness: another solver of the same shape.
//!
//! It proves nothing. It is f32, of unknown error, and wrong in known ways
//! (`crates/bench/tests/bench/rival_defects.rs`): directions are made unit length for it, and a
//! disagreement beyond the tolerance is a [`Verdict::Suspect`], which only the
//! oracle can turn against the answer. What it tells is how often two programs
//! that share no code agree.
//!
//! # Which solids
//! Cylinders that are circular in the mesh, too. With `G = MᵀM` of the
//! map's matrix M and e the unit axis, the image is one if and only if
//! `G = α eeᵀ + β (I - eeᵀ)`; so placements may stretch along the axis and
//! mirror. The defect, the Frobenius norm of what is left of G, is allowed up to
//! `2^-22 min(α, β)`, which changes lengths in the solid by at most 2^-23.
//!
//! # Tolerance
//! Let u = 2^-24. O is the origin's distance from the mesh's origin, P the
//! farther end's, T the way to the hit, `L = length + radius` of the solid hit,
//! r its radius; all lengths in the mesh. To first order:
//!
//! - The ends, the unit direction and the radius are rounded, the origin is
//!   moved next to the segment's middle, and the way there added to `t` again:
//!   each displaces the ray against the solid by a few u of O, P or T, together
//!   at most `4u (O + P + T)`. The map's defect adds at most `2u L`.
//! - From there on Embree solves `A t² + 2 B t + C = 0`, over |a|⁴ an equation
//!   for the squared distance from the axis, with terms of at most L², since the
//!   solid is within L of its own middle. Sixteen roundings in each of A, B and C
//!   make `16u (|t| + L)² <= 64u L²`, and the root some `8u L²` more: the wall is
//!   met where the squared radius differs by 72u L², the radius by `36u L²/r`.
//!   This is the one that grows with L/r and loses long thin cylinders. On a disk
//!   it is `16u L`, which is less.
//!
//! ```text
//! ε = 4u (O + P + T) + 2u L + 36u L² / r
//! ```
//!
//! Where the radius is off by ε, half a chord `s = r cos` is off by at most
//! `2 r ε / s`. So two hits agree if they are apart by at most `2ε` along the
//! normal: `|Δt| |n·d| <= 2ε`. A hit and a miss never agree; near silhouettes
//! the oracle clears them.

pub(super) mod blocks;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use cyltrace::embree::{Device, Error, GREATEST_COORDINATE, NativeHit, Ray32, Scene, SceneBuilder};
use cyltrace::math::{frobenius_norm, power_of_two};
use cyltrace::solid::{AnySolid, Caps, Cylinder};

use super::bounding_meshes::mesh_frame::MeshFrame;
use super::bounding_meshes::mesh_map::{MeshAnchor, MeshMap};
use super::bounding_meshes::meshes::point;
use super::bounding_meshes::window::{PlacedSolid, Window};

/// Half an ulp of 1 in f32.
const U: f64 = power_of_two(-24);

/// The greatest share of `min(α, β)` that the map's defect may be.
const MOST_DEFECT: f64 = power_of_two(-22);

/// A circular cylinder in the space of the meshes, in Embree's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment {
    ends: [[f32; 3]; 2],
    radius: f32,
    neighbours: u8,
}

impl Segment {
    /// The image of a solid under `M`, with `base` that of `p0`; `None` if that
    /// is no circular cylinder, or none that f32 holds.
    pub fn new(cylinder: &Cylinder, matrix: &DMat3, base: DVec3) -> Option<Self> {
        let whole_axis = cylinder.p1() - cylinder.p0();
        let axis = whole_axis.normalize();
        let squared = matrix.transpose() * *matrix;
        let along = axis.dot(squared * axis);
        let trace = squared.x_axis.x + squared.y_axis.y + squared.z_axis.z;
        let across = (trace - along) / 2.0;
        let outer = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
        let circular = DMat3::IDENTITY * across + outer * (along - across);
        let defect = frobenius_norm(&(squared - circular));
        let ends = [base, base + *matrix * whole_axis].map(|end| end.as_vec3().to_array());
        let radius = (cylinder.radius() * libm::sqrt(across)) as f32;
        let is_held = ends
            .as_flattened()
            .iter()
            .all(|x| x.abs() < GREATEST_COORDINATE)
            && ends[0] != ends[1]
            && (f32::MIN_POSITIVE..GREATEST_COORDINATE).contains(&radius);
        (is_held && defect <= MOST_DEFECT * along.min(across)).then(|| Self {
            ends,
            radius,
            neighbours: neighbours(cylinder.caps()),
        })
    }

    fn of_placed(placed: &PlacedSolid, frame: &MeshFrame) -> Option<Self> {
        let AnySolid::Cylinder(cylinder) = &placed.solid else {
            return None;
        };
        let map = MeshMap::new(frame, &placed.frame);
        let base = MeshAnchor::new(frame, &map, placed, cylinder.p0()).base;
        Self::new(cylinder, &map.matrix, base)
    }

    /// `ε` for a ray from `origin` with a hit after `way`.
    fn tolerance(&self, origin: f64, way: f64) -> f64 {
        let [p0, p1] = self.ends.map(point);
        let radius = f64::from(self.radius);
        let length = (p1 - p0).length() + radius;
        let farther = p0.length().max(p1.length());
        4.0 * U * (origin + farther + way) + 2.0 * U * length + 36.0 * U * length * length / radius
    }
}

/// Embree's flags: an end without a disk is one that a neighbour continues.
fn neighbours(caps: Caps) -> u8 {
    u8::from(!caps.at_p0()) | u8::from(!caps.at_p1()) << 1
}

/// A hit that an intersector tells of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CurveHit {
    /// In lengths of the ray's direction.
    pub t: f64,
    /// The solid's number in the window, if it is told.
    pub solid: Option<u32>,
}

/// What the curves say of an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// They agree within the tolerance.
    Agrees,
    /// The answer may be of a solid that has no curve.
    Unwitnessed,
    /// They do not: the oracle is to be asked.
    Suspect,
}

/// The solids of a window as cone curves in one Embree scene.
pub(crate) struct ConeCurves {
    scene: Scene<()>,
    segments: Vec<Segment>,
    /// Whether the window's solid has a curve.
    has_curve: Vec<bool>,
}

impl ConeCurves {
    /// Builds the curves of a window.
    ///
    /// # Errors
    /// When Embree refuses.
    pub fn of_window(device: &Device, window: &Window, frame: &MeshFrame) -> Result<Self, Error> {
        // A leaf of a composition is no solid by itself.
        let solids = window
            .solids
            .par_iter()
            .zip(0_u32..window.solids.len() as u32);
        let segments: Vec<Option<Segment>> = solids
            .map(|(solid, leaf)| match window.composition_of(leaf) {
                None => Segment::of_placed(solid, frame),
                Some(_) => None,
            })
            .collect();
        Self::new(device, &segments)
    }

    /// Builds the curves of a window's solids, `None` for those without.
    ///
    /// # Errors
    /// When Embree refuses.
    pub fn new(device: &Device, solids: &[Option<Segment>]) -> Result<Self, Error> {
        let segments: Vec<Segment> = solids.iter().copied().flatten().collect();
        let vertices: Vec<[f32; 4]> = segments
            .iter()
            .flat_map(|segment| segment.ends.map(|[x, y, z]| [x, y, z, segment.radius]))
            .collect();
        let first: Vec<u32> = (0..segments.len() as u32).map(|index| 2 * index).collect();
        let neighbours: Vec<u8> = segments.iter().map(|segment| segment.neighbours).collect();
        let mut builder = SceneBuilder::new(device)?;
        builder.attach_cone_curves(&vertices, &first, Some(&neighbours))?;
        Ok(Self {
            scene: builder.commit()?,
            segments,
            has_curve: solids.iter().map(Option::is_some).collect(),
        })
    }

    /// How many of the solids have a curve.
    pub fn witnessed_solids(&self) -> usize {
        self.segments.len()
    }

    /// Holds an answer for a ray of the meshes' space against the curves.
    pub fn compare(&self, ray: &Ray32, answer: Option<CurveHit>) -> Verdict {
        if let Some(CurveHit {
            solid: Some(solid), ..
        }) = answer
            && !self.has_curve[solid as usize]
        {
            return Verdict::Unwitnessed;
        }
        let speed = point(ray.direction).length();
        let hit = self
            .scene
            .closest_native(&with_unit_direction(ray, speed), &mut ());
        let seen = hit.map(|hit| f64::from(hit.t) / speed);
        let is_one = match (&answer, &hit) {
            (None, None) => true,
            (Some(told), Some(hit)) => self.is_one_hit(ray, told.t * speed, hit),
            _ => false,
        };
        let all_have_curves = self.segments.len() == self.has_curve.len();
        match answer {
            _ if is_one => Verdict::Agrees,
            // Of a solid without curve, for all that is known.
            Some(CurveHit { t, solid: None })
                if !all_have_curves && seen.is_none_or(|seen| t < seen) =>
            {
                Verdict::Unwitnessed
            }
            _ => Verdict::Suspect,
        }
    }

    /// Whether a hit after `way` is the curves' one.
    fn is_one_hit(&self, ray: &Ray32, way: f64, hit: &NativeHit) -> bool {
        let seen = f64::from(hit.t);
        let segment = &self.segments[hit.primitive as usize];
        let tolerance = segment.tolerance(point(ray.origin).length(), way.max(seen));
        let slope = point(hit.normal)
            .normalize_or_zero()
            .dot(point(ray.direction).normalize())
            .abs();
        (way - seen).abs() * slope <= 2.0 * tolerance
    }
}

/// The ray with a direction of unit length, nearly the same line.
fn with_unit_direction(ray: &Ray32, speed: f64) -> Ray32 {
    Ray32 {
        origin: ray.origin,
        direction: (point(ray.direction) / speed).as_vec3().to_array(),
        t_near: (f64::from(ray.t_near) * speed).min(f64::from(f32::MAX)) as f32,
        t_far: (f64::from(ray.t_far) * speed) as f32,
    }
}

#[cfg(test)]
mod tests;
