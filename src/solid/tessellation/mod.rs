//! Triangle meshes of solids, with a proven deviation.
//!
//! All solids except the cuboid are solids of revolution. The mesh of one is its *profile*, a
//! polyline of heights along the axis and distances from it, turned with N sides (`profile`).
//! `profiles` has the polylines of the kinds. There are two steps, whose deviations add up:
//!
//! 1. **The polyline.** The *inscribed* one has its corners on the meridian of the solid; the
//!    segments of the *circumscribed* one touch it from outside. Walls and disks are straight,
//!    and their polylines exact. On an arc of radius r with steps of δ the corners of the
//!    inscribed one are at r, and its chords within `r (1 - cos(δ/2))` of the arc; the corners
//!    of the circumscribed one are at `r / cos(δ/2)`, `r (1/cos(δ/2) - 1)` beyond it.
//! 2. **The turn.** Where the polyline is at ρ from the axis, the inscribed mesh has its
//!    corners at ρ. Between two of them it is nearer to the axis, by at most the sagitta
//!    `ρ (1 - cos(π/N))`, in the middle. The circumscribed mesh has its corners at
//!    `ρ / cos(π/N)`, farther by `ρ (1/cos(π/N) - 1)`, and its sides touch the turned polyline
//!    along their middles.
//!
//! A side between two corners of the polyline is a trapezoid, hence flat. The plane of a
//! circumscribed one contains a segment that touches the meridian and is perpendicular to the
//! meridian's plane. So it touches the convex solid, and the mesh contains the solid. The
//! inscribed mesh is the hull of points of the solid, and inside it. Both are true up to
//! roundings, and up to absent disks.
//!
//! If a convex body contains another, the greatest distance of a point of the outer from the
//! inner is the greatest distance between the surfaces; without disks, a wall and its mesh are
//! that far apart at each height. So [`deviation_of`], the sum of both steps, bounds the
//! distance of the mesh from the surface and of the surface from the mesh. If roundings move
//! the corners of a triangle, none of its points moves farther than they do:
//! [`corner_error_of`] bounds that. Rounding the corners to f32 moves them by at most √3/2 ulp
//! of their largest coordinate more.

mod cuboid;
mod prism;
mod profile;
mod profiles;

pub use prism::{inscribed_prism, prism_size, sagitta};

use glam::DVec3;

use super::{AnySolid, Cuboid};
use crate::with_solid;
use profile::Profile;

/// The fewest sides of a prism, and of any other turned mesh.
pub const LEAST_SEGMENTS: u32 = 3;

/// The most sides of a prism, and of any other turned mesh. The sagitta is then 3e-7 radii, a
/// few f32 ulps. A prism's triangles take some 400 kB; those of a ball take 400 MB.
pub const GREATEST_SEGMENTS: u32 = 4096;

/// The side of the surface on which a mesh lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fit {
    /// Its corners are on the surface, the rest within the solid.
    Inscribed,
    /// Its sides touch the surface from outside.
    Circumscribed,
}

impl Fit {
    /// The name in files and tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Inscribed => "inscribed",
            Self::Circumscribed => "circumscribed",
        }
    }
}

/// Triangles with shared corners, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The corners.
    pub vertices: Vec<DVec3>,
    /// The corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds the triangles of another mesh.
    pub fn append(&mut self, other: &Self) {
        let first = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&other.vertices);
        self.triangles.extend(
            other
                .triangles
                .iter()
                .map(|corners| corners.map(|i| first + i)),
        );
    }
}

/// `cos(π/N)`: the inradius of a regular polygon, in circumradii.
#[must_use]
pub fn inner_factor(segments: u32) -> f64 {
    libm::cos(std::f64::consts::PI / f64::from(segments))
}

/// The source of a solid's mesh.
enum Outline {
    Turned(Profile),
    Cuboid(Cuboid),
}

/// A kind of solid with meshes.
trait Tessellated {
    /// The source of its mesh of `segments` sides.
    fn outline(&self, segments: u32, fit: Fit) -> Outline;
}

/// As [`Tessellated::outline`], for a solid of any kind.
///
/// # Panics
/// When `segments` is less than 3.
fn outline(solid: &AnySolid, segments: u32, fit: Fit) -> Outline {
    assert!(
        segments >= LEAST_SEGMENTS,
        "a mesh has at least {LEAST_SEGMENTS} sides, not {segments}"
    );
    with_solid!(solid, solid => solid.outline(segments, fit))
}

/// The mesh of a solid with `segments` sides around its axis, in the solid's own space. It is
/// closed if the solid is, and has the disks that the solid has; a disk is a polygon that is
/// counter-clockwise seen from where the normal points. Balls and rounded ends have just enough
/// steps along the meridian that these are no longer than those around. The mesh of a cuboid is
/// the cuboid, for any number of segments and either fit.
///
/// The two fits have the same triangles, and corners at the same angles.
///
/// # Panics
/// When `segments` is less than 3.
#[must_use]
pub fn mesh_of(solid: &AnySolid, segments: u32, fit: Fit) -> Mesh {
    match outline(solid, segments, fit) {
        Outline::Turned(profile) => Mesh {
            vertices: profile.vertices(segments, fit),
            triangles: profile.triangles(segments),
        },
        Outline::Cuboid(cuboid) => Mesh {
            vertices: cuboid::vertices(&cuboid),
            triangles: cuboid::triangles(),
        },
    }
}

/// The triangles of [`mesh_of`] alone, which both fits share.
///
/// # Panics
/// When `segments` is less than 3.
#[must_use]
pub fn triangles_of(solid: &AnySolid, segments: u32) -> Vec<[u32; 3]> {
    match outline(solid, segments, Fit::Inscribed) {
        Outline::Turned(profile) => profile.triangles(segments),
        Outline::Cuboid(_) => cuboid::triangles(),
    }
}

/// The numbers of vertices and triangles of [`mesh_of`].
///
/// # Panics
/// When `segments` is less than 3.
#[must_use]
pub fn mesh_size_of(solid: &AnySolid, segments: u32) -> (u64, u64) {
    match outline(solid, segments, Fit::Inscribed) {
        Outline::Turned(profile) => profile.size(segments),
        Outline::Cuboid(_) => (8, 12),
    }
}

/// The greatest deviation of a mesh with exact corners from the surface, and of the surface
/// from the mesh, in the solid's units; see the head of this file. 0 for a cuboid. Its own
/// error is at most 8 u of the solid's radius (u = 2^-53), for which [`corner_error_of`] has
/// room.
///
/// # Panics
/// When `segments` is less than 3.
#[must_use]
pub fn deviation_of(solid: &AnySolid, segments: u32, fit: Fit) -> f64 {
    match outline(solid, segments, fit) {
        Outline::Turned(profile) => profile.deviation(segments, fit),
        Outline::Cuboid(_) => 0.0,
    }
}

/// The bound of the roundings of a corner of a mesh of either fit, in the solid's units: at
/// most 230 u of its size (60 u with many segments) and 8 u of its distance from the origin,
/// u = 2^-53.
///
/// # Panics
/// When `segments` is less than 3.
#[must_use]
pub fn corner_error_of(solid: &AnySolid, segments: u32) -> f64 {
    match outline(solid, segments, Fit::Circumscribed) {
        Outline::Turned(profile) => profile.corner_error(segments),
        Outline::Cuboid(cuboid) => cuboid::corner_error(&cuboid),
    }
}

/// An upper bound of the distance of any corner of a mesh of either fit from the origin, up to
/// roundings.
///
/// # Panics
/// When `segments` is less than 3.
#[must_use]
pub fn reach_of(solid: &AnySolid, segments: u32) -> f64 {
    match outline(solid, segments, Fit::Circumscribed) {
        Outline::Turned(profile) => profile.reach(segments),
        Outline::Cuboid(cuboid) => cuboid.center().length() + cuboid.half_widths().length(),
    }
}
