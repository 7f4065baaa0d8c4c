//! Meshes of cuboids, which are exact but for roundings, and of disks.
//!
//! A corner of a cuboid is computed as its points of the surface are, and its error
//! is theirs ([`Cuboid`]'s `surface_point`). The polygon of a disk has the corners of a
//! cylinder's prism (the head of this folder), with its sagitta and its roundings.

use glam::DVec3;

use super::{Fit, LEAST_SEGMENTS, Mesh, inner_factor};
use crate::math::UNIT_ROUNDOFF;
use crate::solid::surface::angle_frame;
use crate::solid::{Cuboid, Disk};

/// The twelve triangles of a cuboid.
#[must_use]
pub fn cuboid_mesh(cuboid: &Cuboid) -> Mesh {
    // Bit i of a corner's number says on which side of axis i it is.
    let corner = |number: u32| {
        let side = |bit: u32| if number >> bit & 1 == 0 { -1.0 } else { 1.0 };
        let own = cuboid.half_widths() * DVec3::new(side(0), side(1), side(2));
        cuboid.centre() + cuboid.orientation().to_world(own)
    };
    let mut triangles = Vec::with_capacity(12);
    for axis in 0..3 {
        let [face, next, last] = [axis, (axis + 1) % 3, (axis + 2) % 3].map(|axis| 1_u32 << axis);
        // Seen against the axis, its two others go round counter-clockwise.
        let upper = [face, face + next, face + next + last, face + last];
        let lower = [0, last, next + last, next];
        for [a, b, c, d] in [upper, lower] {
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Mesh {
        vertices: (0..8).map(corner).collect(),
        triangles,
    }
}

/// By how much a corner of that mesh may be off the true one.
#[must_use]
pub fn cuboid_corner_error(cuboid: &Cuboid) -> f64 {
    let reach = cuboid.half_widths().element_sum();
    UNIT_ROUNDOFF * (cuboid.centre().length() + 18.0 * reach)
}

/// The regular polygon with its corners on the rim of a disk, or with its sides
/// touching it. It is seen counter-clockwise from where the normal points.
///
/// # Panics
/// When there are fewer than 3 segments.
#[must_use]
pub fn disk_polygon(disk: &Disk, segments: u32, fit: Fit) -> Mesh {
    assert!(
        segments >= LEAST_SEGMENTS,
        "a polygon has at least {LEAST_SEGMENTS} sides, not {segments}"
    );
    let (reference, across) = angle_frame(disk.normal().normalize());
    let radius = corner_radius(disk, segments, fit);
    let corners = (0..segments).map(|corner| {
        let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(segments);
        let (sin, cos) = libm::sincos(angle);
        disk.centre() + (reference * cos + across * sin) * radius
    });
    Mesh {
        vertices: std::iter::once(disk.centre()).chain(corners).collect(),
        triangles: (0..segments)
            .map(|corner| [0, 1 + corner, 1 + (corner + 1) % segments])
            .collect(),
    }
}

/// By how much that polygon's rim may be off the disk's, which is its sagitta or
/// what its corners have over.
#[must_use]
pub fn disk_deviation(disk: &Disk, segments: u32, fit: Fit) -> f64 {
    let factor = inner_factor(segments);
    disk.radius()
        * match fit {
            Fit::Inscribed => 1.0 - factor,
            Fit::Circumscribed => 1.0 / factor - 1.0,
        }
}

/// By how much a corner of that polygon, as computed, may be off the one meant.
#[must_use]
pub fn disk_corner_error(disk: &Disk, segments: u32) -> f64 {
    let radius = corner_radius(disk, segments, Fit::Circumscribed);
    UNIT_ROUNDOFF * (80.0 * radius + 2.0 * disk.centre().length())
}

fn corner_radius(disk: &Disk, segments: u32, fit: Fit) -> f64 {
    match fit {
        Fit::Inscribed => disk.radius(),
        Fit::Circumscribed => disk.radius() / inner_factor(segments),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Orientation, Random};
    use crate::solid::ConvexSolid;

    #[test]
    fn cuboid_mesh_is_closed_faces_outward_and_has_its_volume() {
        let turned = Orientation::IDENTITY.rotated(DVec3::new(1.0, 2.0, 3.0), 40.0);
        let half_widths = DVec3::new(1.0, 2.0, 0.5);
        let centre = DVec3::new(3.0, -1.0, 2.0);
        let cuboid = Cuboid::new(centre, half_widths, turned).unwrap();
        let mesh = cuboid_mesh(&cuboid);
        let mut edges = Vec::new();
        let mut volume = 0.0;
        for corners in &mesh.triangles {
            let [a, b, c] = corners.map(|i| mesh.vertices[i as usize] - centre);
            volume += a.cross(b).dot(c) / 6.0;
            assert!(
                (b - a).cross(c - a).dot(a) > 0.0,
                "{corners:?} faces inward"
            );
            let [a, b, c] = *corners;
            edges.extend([(a, b), (b, c), (c, a)]);
        }
        assert!((volume - 8.0).abs() < 1e-13, "{volume}");
        for (a, b) in &edges {
            let count = |edge| edges.iter().filter(|other| **other == edge).count();
            assert_eq!((count((*a, *b)), count((*b, *a))), (1, 1));
        }
        for vertex in &mesh.vertices {
            let own = turned.to_object(*vertex - centre).abs();
            let off = (own - half_widths).abs().max_element();
            assert!(off <= 2.0 * cuboid_corner_error(&cuboid), "{off:e}");
        }
    }

    #[test]
    fn disk_polygons_hold_and_are_held_by_the_disk() {
        let mut random = Random::new(71, 0);
        let mut draw = || random.direction() * 2.0;
        let disk = Disk::new(draw(), draw(), 0.7).unwrap();
        for segments in [3, 8, 100] {
            let error = disk_corner_error(&disk, segments);
            for fit in [Fit::Inscribed, Fit::Circumscribed] {
                let mesh = disk_polygon(&disk, segments, fit);
                let deviation = disk_deviation(&disk, segments, fit);
                let mut area = 0.0;
                for corners in &mesh.triangles {
                    let [a, b, c] = corners.map(|i| mesh.vertices[i as usize] - disk.centre());
                    area += (b - a).cross(c - a).dot(disk.normal()) / 4.0;
                    let (middle, corner) = ((b + c).length() / 2.0, b.length());
                    let (inner, outer) = match fit {
                        Fit::Inscribed => (0.7 - deviation, 0.7),
                        Fit::Circumscribed => (0.7, 0.7 + deviation),
                    };
                    assert!((middle - inner).abs() <= error, "{segments}");
                    assert!((corner - outer).abs() <= error, "{segments}");
                    assert!(b.dot(disk.normal()).abs() <= 2.0 * error);
                }
                let whole = std::f64::consts::PI * disk.radius() * disk.radius();
                assert_eq!(area < whole, fit == Fit::Inscribed, "{segments}");
                assert!(
                    disk.bounds()
                        .grown(deviation + error)
                        .lower
                        .cmple(mesh.vertices[1])
                        .all()
                );
            }
        }
    }
}
