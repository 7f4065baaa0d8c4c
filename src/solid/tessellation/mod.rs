//! Triangle meshes of solids, with a proven deviation.
//!
//! The corners of the *inscribed* prism with N sides lie on the rims. Between
//! two of them a side is nearer to the axis, by at most the sagitta
//! `radius (1 - cos(π/N))`, in the middle. So every point of the prism is
//! within that of the cylinder's surface, and the cylinder of radius
//! `radius cos(π/N)` about the same axis is inside the prism.
//!
//! The sides of the *circumscribed* prism touch the wall along their middles,
//! so its corners are at `radius / cos(π/N)`: beyond the rims by
//! `radius (1/cos(π/N) - 1)`, and nothing of it is farther out. With both discs
//! the inscribed prism is in the solid, and the solid in the circumscribed one,
//! but for roundings.
//!
//! **Roundings** (u = 2^-53; R is the radius of the corners). A corner is
//! `p + (e cos φ + f sin φ) R`:
//!
//! - `φ = 2π k / N` has three roundings, together `19 u` of an angle, and turns
//!   the corner by that;
//! - the axis is off by `5 u` (difference, length, quotient); `e`, a difference
//!   no shorter than √(2/3), is off by `14 u` from a unit vector across the
//!   true axis, and `f = axis × e` by `22 u`;
//! - sine and cosine are off by 2 u, their products and sum by 3 u: `10 u` for
//!   the two terms together, with the product by R;
//! - R itself is within `6 u`: π/N, the cosine (relative, as π/N <= π/3) and the
//!   quotient; and the sum with p rounds by `u (|p| + R)`, a middle of a disc
//!   is exact.
//!
//! Together [`corner_error`] `= u (72 R + |p|)`; a triangle of moved corners
//! is nowhere farther from where it was than its corners are. Rounding the
//! corners to f32 moves them by at most √3/2 ulp of their largest coordinate
//! more.

mod flat;
mod round;

pub use flat::{cuboid_corner_error, cuboid_mesh, disk_corner_error, disk_deviation, disk_polygon};
pub use round::{sphere_corner_error, sphere_deviation, sphere_inner_factor, sphere_mesh};

use glam::DVec3;

use super::surface::angle_frame;
use super::{Caps, Cylinder};
use crate::math::UNIT_ROUNDOFF;

/// Fewest sides of a prism.
pub const LEAST_SEGMENTS: u32 = 3;

/// Most sides of a prism: its sagitta is 3e-7 radii, a few f32 ulps, and its
/// triangles take some 400 kB.
pub const GREATEST_SEGMENTS: u32 = 4096;

/// On which side of the wall a prism stays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fit {
    /// Its corners are on the rims, its sides within the wall.
    Inscribed,
    /// Its sides touch the wall from without.
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

/// By how much the inscribed prism may fall short of the cylinder's wall.
#[must_use]
pub fn sagitta(cylinder: &Cylinder, segments: u32) -> f64 {
    cylinder.radius() * (1.0 - inner_factor(segments))
}

/// By how much the circumscribed prism may reach beyond the cylinder's wall.
#[must_use]
pub fn excess(cylinder: &Cylinder, segments: u32) -> f64 {
    cylinder.radius() * (1.0 / inner_factor(segments) - 1.0)
}

/// `cos(π/N)`: the radius of the cylinder inside the prism, in radii.
#[must_use]
pub fn inner_factor(segments: u32) -> f64 {
    libm::cos(std::f64::consts::PI / f64::from(segments))
}

/// By how much a prism may be off the cylinder's surface: [`sagitta`] or
/// [`excess`]. Neither is off by more than 4 u of the radius itself, which
/// [`corner_error`] has room for.
#[must_use]
pub fn deviation(cylinder: &Cylinder, segments: u32, fit: Fit) -> f64 {
    match fit {
        Fit::Inscribed => sagitta(cylinder, segments),
        Fit::Circumscribed => excess(cylinder, segments),
    }
}

/// By how much a corner of a prism, as computed, may be off the corner that is
/// meant.
#[must_use]
pub fn corner_error(cylinder: &Cylinder, segments: u32) -> f64 {
    let farthest = cylinder.p0().length().max(cylinder.p1().length());
    let corner_radius = cylinder.radius() / inner_factor(segments);
    UNIT_ROUNDOFF * (80.0 * corner_radius + 2.0 * farthest)
}

/// The prism with `segments` sides whose corners lie on the rims. It has the
/// discs that the cylinder has.
///
/// # Panics
/// When there are fewer than 3 segments.
#[must_use]
pub fn inscribed_prism(cylinder: &Cylinder, segments: u32) -> Mesh {
    prism(cylinder, segments, Fit::Inscribed)
}

/// The prism with `segments` sides that touch the wall from without. It has
/// the discs that the cylinder has, as polygons around them.
///
/// # Panics
/// When there are fewer than 3 segments.
#[must_use]
pub fn circumscribed_prism(cylinder: &Cylinder, segments: u32) -> Mesh {
    prism(cylinder, segments, Fit::Circumscribed)
}

/// The inscribed or the circumscribed prism. The corners of both are at the
/// same angles, so that they have the same triangles.
///
/// # Panics
/// When there are fewer than 3 segments.
#[must_use]
pub fn prism(cylinder: &Cylinder, segments: u32, fit: Fit) -> Mesh {
    assert!(
        segments >= LEAST_SEGMENTS,
        "a prism has at least {LEAST_SEGMENTS} sides, not {segments}"
    );
    let corner_radius = match fit {
        Fit::Inscribed => cylinder.radius(),
        Fit::Circumscribed => cylinder.radius() / inner_factor(segments),
    };
    let (p0, p1) = (cylinder.p0(), cylinder.p1());
    let (reference, across) = angle_frame((p1 - p0).normalize());
    let mut mesh = Mesh::default();
    for corner in 0..segments {
        let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(segments);
        let (sin, cos) = libm::sincos(angle);
        let radial = (reference * cos + across * sin) * corner_radius;
        mesh.vertices.extend([p0 + radial, p1 + radial]);
    }
    for (middle, is_there) in [(p0, cylinder.caps().at_p0()), (p1, cylinder.caps().at_p1())] {
        mesh.vertices.extend(is_there.then_some(middle));
    }
    mesh.triangles = prism_triangles(cylinder.caps(), segments);
    mesh
}

/// The triangles of [`prism`]: they depend on the discs alone.
#[must_use]
pub fn prism_triangles(caps: Caps, segments: u32) -> Vec<[u32; 3]> {
    let sides = (0..segments).map(|corner| (2 * corner, 2 * ((corner + 1) % segments)));
    let mut triangles: Vec<_> = sides
        .clone()
        .flat_map(|(here, next)| [[here, next, next + 1], [here, next + 1, here + 1]])
        .collect();
    let mut centre = 2 * segments;
    if caps.at_p0() {
        triangles.extend(sides.clone().map(|(here, next)| [centre, next, here]));
        centre += 1;
    }
    if caps.at_p1() {
        triangles.extend(sides.map(|(here, next)| [centre, here + 1, next + 1]));
    }
    triangles
}

/// How many vertices and triangles [`prism`] has.
#[must_use]
pub fn prism_size(caps: Caps, segments: u32) -> (u64, u64) {
    let discs = u64::from(caps.at_p0()) + u64::from(caps.at_p1());
    let segments = u64::from(segments);
    (2 * segments + discs, (2 + discs) * segments)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the divergence theorem, about a point of the solid.
    fn volume(mesh: &Mesh, about: DVec3) -> f64 {
        let six_times: f64 = mesh
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|i| mesh.vertices[i as usize] - about);
                a.dot(b.cross(c))
            })
            .sum();
        six_times / 6.0
    }

    #[test]
    fn prisms_are_closed_face_outward_and_enclose_the_volume() {
        let ends = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 4.0, 3.5));
        let cylinder = Cylinder::new(ends.0, ends.1, 0.7, Caps::Both).unwrap();
        let exact = std::f64::consts::PI * 0.49 * (ends.1 - ends.0).length();
        for segments in [3, 4, 7, 200] {
            let inner = inscribed_prism(&cylinder, segments);
            let outer = circumscribed_prism(&cylinder, segments);
            assert_eq!(inner.triangles, outer.triangles);
            let counts = (inner.vertices.len() as u64, inner.triangles.len() as u64);
            assert_eq!(counts, prism_size(Caps::Both, segments));
            // Of closed triangle meshes, edges are 3/2 of the triangles.
            let (corners, triangles) = (inner.vertices.len(), inner.triangles.len());
            assert_eq!(corners + triangles - 3 * triangles / 2, 2);
            let (inner, outer) = (volume(&inner, ends.0), volume(&outer, ends.0));
            // The areas of regular polygons in and around the unit circle, over π.
            let n = f64::from(segments);
            let angle = std::f64::consts::PI / n;
            let sine = libm::sin(angle) * libm::cos(angle);
            let expected = [sine, libm::tan(angle)].map(|s| s * n / std::f64::consts::PI * exact);
            for (seen, expected) in [inner, outer].into_iter().zip(expected) {
                assert!((seen / expected - 1.0).abs() < 1e-13, "{seen} {expected}");
            }
            assert!(inner < exact && exact < outer, "{segments}");
        }
    }

    /// Corners against the definition of the solid, in f64 about an end that is
    /// near, so that the check's own roundings are a few u of the radius.
    #[test]
    fn corners_keep_their_distance_from_the_axis() {
        let mut random = crate::math::Random::new(3, 0);
        for case in 0..2_000 {
            let p0 = random.direction() * random.log_uniform(1e-3, 1e3);
            let length = random.log_uniform(1e-3, 1e3);
            let p1 = p0 + random.direction() * length;
            let radius = random.log_uniform(1e-3, 1e3);
            let cylinder = Cylinder::new(p0, p1, radius, Caps::Both).unwrap();
            let axis = (p1 - p0).normalize();
            let segments = 3 + random.below(60) as u32;
            for fit in [Fit::Inscribed, Fit::Circumscribed] {
                let beyond = match fit {
                    Fit::Inscribed => 0.0,
                    Fit::Circumscribed => excess(&cylinder, segments),
                };
                let corners = &prism(&cylinder, segments, fit).vertices;
                let most = 2.0 * corner_error(&cylinder, segments);
                for (number, corner) in corners[..2 * segments as usize].iter().enumerate() {
                    let from = *corner - if number % 2 == 0 { p0 } else { p1 };
                    let along = from.dot(axis);
                    let across = (from - axis * along).length() - radius - beyond;
                    assert!(along.abs() <= most, "case {case}: {along:e} {most:e}");
                    assert!(across.abs() <= most, "case {case}: {across:e} {most:e}");
                }
            }
        }
    }

    #[test]
    fn walls_stay_within_the_sagitta() {
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z, 2.0, Caps::None).unwrap();
        for segments in [3, 4, 17, 256] {
            let mesh = inscribed_prism(&cylinder, segments);
            let counts = (mesh.vertices.len() as u64, mesh.triangles.len() as u64);
            assert_eq!(counts, prism_size(Caps::None, segments));
            for corners in &mesh.triangles {
                let [a, b, c] = corners.map(|i| mesh.vertices[i as usize].with_z(0.0));
                for middle in [(a + b) / 2.0, (b + c) / 2.0, (a + c) / 2.0] {
                    let short = 2.0 - middle.length();
                    let most = sagitta(&cylinder, segments) + 1e-15;
                    assert!((-1e-15..=most).contains(&short), "{segments}: {short}");
                }
            }
        }
    }
}
