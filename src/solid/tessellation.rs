//! Triangle meshes of solids, with a proven deviation.
//!
//! The corners of the inscribed prism with N sides lie on the rims. Between
//! two of them a side is nearer to the axis, by at most the sagitta
//! `radius (1 - cos(π/N))`, in the middle. So every point of the prism is
//! within that of the cylinder's surface, and the cylinder of radius
//! `radius cos(π/N)` about the same axis is inside the prism. Rounding the
//! corners to f32 moves them by at most √3/2 ulp of their largest coordinate
//! more.

use glam::DVec3;

use super::Cylinder;
use super::surface::angle_frame;

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

/// `cos(π/N)`: the radius of the cylinder inside the prism, in radii.
#[must_use]
pub fn inner_factor(segments: u32) -> f64 {
    libm::cos(std::f64::consts::PI / f64::from(segments))
}

/// The prism with `segments` sides whose corners lie on the rims. It has the
/// discs that the cylinder has.
///
/// # Panics
/// When there are fewer than 3 segments.
#[must_use]
pub fn inscribed_prism(cylinder: &Cylinder, segments: u32) -> Mesh {
    assert!(
        segments >= 3,
        "a prism has at least 3 sides, not {segments}"
    );
    let (p0, p1) = (cylinder.p0(), cylinder.p1());
    let (reference, across) = angle_frame((p1 - p0).normalize());
    let mut mesh = Mesh::default();
    for corner in 0..segments {
        let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(segments);
        let (sin, cos) = libm::sincos(angle);
        let radial = (reference * cos + across * sin) * cylinder.radius();
        mesh.vertices.extend([p0 + radial, p1 + radial]);
    }
    for corner in 0..segments {
        let (here, next) = (2 * corner, 2 * ((corner + 1) % segments));
        mesh.triangles
            .extend([[here, next, next + 1], [here, next + 1, here + 1]]);
    }
    for (middle, is_there, end) in [
        (p0, cylinder.caps().at_p0(), 0),
        (p1, cylinder.caps().at_p1(), 1),
    ] {
        if is_there {
            let centre = mesh.vertices.len() as u32;
            mesh.vertices.push(middle);
            for corner in 0..segments {
                let (here, next) = (2 * corner + end, 2 * ((corner + 1) % segments) + end);
                mesh.triangles.push(if end == 0 {
                    [centre, next, here]
                } else {
                    [centre, here, next]
                });
            }
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Caps;

    #[test]
    fn prism_is_closed_and_faces_outward() {
        let ends = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 4.0, 3.5));
        let cylinder = Cylinder::new(ends.0, ends.1, 0.7, Caps::Both).unwrap();
        let mesh = inscribed_prism(&cylinder, 200);
        assert_eq!(mesh.triangles.len(), 800);
        // Six times the volume, by the divergence theorem.
        let volume: f64 = mesh
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|i| mesh.vertices[i as usize]);
                a.dot(b.cross(c))
            })
            .sum();
        let exact = std::f64::consts::PI * 0.49 * (ends.1 - ends.0).length();
        assert!((0.999..1.0).contains(&(volume / 6.0 / exact)), "{volume}");
    }

    #[test]
    fn walls_stay_within_the_sagitta() {
        let cylinder = Cylinder::new(DVec3::ZERO, DVec3::Z, 2.0, Caps::None).unwrap();
        for segments in [3, 4, 17, 256] {
            let mesh = inscribed_prism(&cylinder, segments);
            assert_eq!(mesh.triangles.len(), 2 * segments as usize);
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
