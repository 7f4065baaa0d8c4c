//! Triangle meshes of solids, with a proven deviation.
//!
//! All solids but the cuboid are turned about an axis: the mesh of one is that of its
//! *profile*, a polyline of heights along the axis and distances from it, turned with N
//! sides (`profile`). `profiles` has the polylines of the kinds. Two steps, so two
//! deviations, which add up:
//!
//! 1. **The polyline.** The *inscribed* one has its corners on the meridian of the
//!    solid; the segments of the *circumscribed* one touch it from without. Walls and
//!    disks are straight, and theirs is exact. On an arc of radius r with steps of δ
//!    the corners of the inscribed one are at r, and its chords within
//!    `r (1 - cos(δ/2))` of the arc; the corners of the circumscribed one are at
//!    `r / cos(δ/2)`, `r (1/cos(δ/2) - 1)` beyond it.
//! 2. **The turn.** Where the polyline is ρ from the axis, the inscribed mesh has its
//!    corners at ρ. Between two of them it is nearer to the axis, by at most the
//!    sagitta `ρ (1 - cos(π/N))`, in the middle. The circumscribed one has its corners
//!    at `ρ / cos(π/N)`, farther by `ρ (1/cos(π/N) - 1)`, and its sides touch the
//!    turned polyline along their middles.
//!
//! A side between two corners of the polyline is a trapezoid, hence flat. The plane of
//! a circumscribed one contains a segment that touches the meridian and is square to
//! the meridian's plane: it touches the solid, which is convex, so that the mesh
//! contains the solid. The inscribed one is the hull of points of the solid, and in it.
//! Both but for roundings, and but for disks that are not there.
//!
//! For convex bodies, one of which contains the other, how far a point of the outer can
//! be from the inner is how far any point of either surface can be from the other
//! surface; without its disks, a wall and its mesh are that far apart at each height.
//! So [`deviation_of`], the sum of both steps, is by how much a mesh may be off the
//! surface and the surface off the mesh. A triangle of corners that are moved by
//! roundings is nowhere farther from where it was than they are: [`corner_error_of`]
//! bounds that. Rounding the corners to f32 moves them by at most √3/2 ulp of their
//! largest coordinate more.

mod cuboid;
mod prism;
mod profile;
mod profiles;

pub use prism::{inscribed_prism, prism_size, sagitta};

use glam::DVec3;

use super::{AnySolid, Cuboid};
use crate::with_solid;
use profile::Profile;

/// Fewest sides of a prism, and of any mesh that is turned about an axis.
pub const LEAST_SEGMENTS: u32 = 3;

/// Most sides of a prism, and of any mesh that is turned about an axis: its sagitta is
/// 3e-7 radii, a few f32 ulps, and its triangles take some 400 kB; those of a ball
/// take 400 MB.
pub const GREATEST_SEGMENTS: u32 = 4096;

/// On which side of the surface a mesh stays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fit {
    /// Its corners are on the surface, the rest within the solid.
    Inscribed,
    /// Its sides touch the surface from without.
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

/// Triangles with shared corners, outward side counter-clockwise.
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

/// `cos(π/N)`: the radius of the circle that the sides of a regular polygon touch, in
/// radii of the one that its corners are on.
#[must_use]
pub fn inner_factor(segments: u32) -> f64 {
    libm::cos(std::f64::consts::PI / f64::from(segments))
}

/// What a solid's mesh is made from.
enum Outline {
    Turned(Profile),
    Cuboid(Cuboid),
}

/// A kind of solid that has meshes.
trait Tessellated {
    /// What its mesh of `segments` sides is made from.
    fn outline(&self, segments: u32, fit: Fit) -> Outline;
}

/// As [`Tessellated::outline`], of a solid of any kind.
///
/// # Panics
/// When there are fewer than 3 segments.
fn outline(solid: &AnySolid, segments: u32, fit: Fit) -> Outline {
    assert!(
        segments >= LEAST_SEGMENTS,
        "a mesh has at least {LEAST_SEGMENTS} sides, not {segments}"
    );
    with_solid!(solid, solid => solid.outline(segments, fit))
}

/// The mesh of a solid with `segments` sides around its axis, in the solid's own
/// space. It is closed where the solid is, and has the disks that the solid has; a disk
/// is a polygon seen counter-clockwise from where the normal points. Balls and
/// rounded ends have as many steps along the meridian as keep them no longer than those
/// around. A cuboid is itself, whatever the number of segments and the fit.
///
/// The two fits have the same triangles of corners at the same angles.
///
/// # Panics
/// When there are fewer than 3 segments.
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

/// The triangles of [`mesh_of`] alone, which both fits have in common.
///
/// # Panics
/// When there are fewer than 3 segments.
#[must_use]
pub fn triangles_of(solid: &AnySolid, segments: u32) -> Vec<[u32; 3]> {
    match outline(solid, segments, Fit::Inscribed) {
        Outline::Turned(profile) => profile.triangles(segments),
        Outline::Cuboid(_) => cuboid::triangles(),
    }
}

/// How many vertices and triangles [`mesh_of`] has.
///
/// # Panics
/// When there are fewer than 3 segments.
#[must_use]
pub fn mesh_size_of(solid: &AnySolid, segments: u32) -> (u64, u64) {
    match outline(solid, segments, Fit::Inscribed) {
        Outline::Turned(profile) => profile.size(segments),
        Outline::Cuboid(_) => (8, 12),
    }
}

/// By how much a mesh with the corners that are meant may be off the surface, and
/// the surface off the mesh, in the solid's units: see the head of this file. 0 for a
/// cuboid. It is off by no more than 8 u of the solid's radius itself (u = 2^-53),
/// which [`corner_error_of`] has room for.
///
/// # Panics
/// When there are fewer than 3 segments.
#[must_use]
pub fn deviation_of(solid: &AnySolid, segments: u32, fit: Fit) -> f64 {
    match outline(solid, segments, fit) {
        Outline::Turned(profile) => profile.deviation(segments, fit),
        Outline::Cuboid(_) => 0.0,
    }
}

/// By how much roundings may move a corner of a mesh of either fit, in the solid's
/// units: at most 230 u of its size (60 u with many segments) and 8 u of how far it is
/// from the origin, u = 2^-53.
///
/// # Panics
/// When there are fewer than 3 segments.
#[must_use]
pub fn corner_error_of(solid: &AnySolid, segments: u32) -> f64 {
    match outline(solid, segments, Fit::Circumscribed) {
        Outline::Turned(profile) => profile.corner_error(segments),
        Outline::Cuboid(cuboid) => cuboid::corner_error(&cuboid),
    }
}

/// At least how far any corner of a mesh of either fit is from the origin, but for
/// roundings.
///
/// # Panics
/// When there are fewer than 3 segments.
#[must_use]
pub fn reach_of(solid: &AnySolid, segments: u32) -> f64 {
    match outline(solid, segments, Fit::Circumscribed) {
        Outline::Turned(profile) => profile.reach(segments),
        Outline::Cuboid(cuboid) => cuboid.center().length() + cuboid.half_widths().length(),
    }
}
