//! Solids grown or shrunk by a distance.
//!
//! *Grown* by δ, the result holds every point within δ of the solid; *shrunk*, every
//! point within δ of the result is in the solid. Both are closed, whatever disks the
//! solid has. In the half plane of the axis a cylinder or cone is the polygon between the
//! axis, its ends and its wall, and its lines move by δ along their normals. With the
//! slope `k = (r1 - r0) / L` of the wall, whose radius goes up by `δ √(1 + k²)` at
//! every height, the ends are then at `-δ` and `L + δ`, where the radii are
//!
//! ```text
//! r0 + δ (√(1 + k²) - k),   r1 + δ (√(1 + k²) + k)
//! ```
//!
//! Of a shrunk cone one may be negative: its wall then meets the axis before the
//! end, at the new apex. The hull of two balls has the same hull of balls larger by δ
//! for what is within δ of it. Shrunk, a ball of less than δ is gone, and the one
//! between both whose radius is δ takes its place.
//!
//! Rounding displaces the results by a few u of the solid's size, so δ must be far
//! above that. A grown disk is a cylinder as thin as δ, whose axis tilts by what its ends
//! round: it must be near the origin.

use glam::DVec3;

use cyltrace::solid::{AnySolid, Caps, Cone, Cuboid, Cylinder, Disk, RoundedCone, Sphere};

/// The solid grown by a distance, or shrunk by a negative one; `None` where nothing
/// would be left of it, or where it has no inside.
pub(crate) fn displaced(solid: &AnySolid, outward: f64) -> Option<AnySolid> {
    match solid {
        AnySolid::Cylinder(cylinder) => displaced_cylinder(cylinder, outward).map(Into::into),
        AnySolid::Cone(cone) => displaced_cone(cone, outward).map(Into::into),
        AnySolid::RoundedCone(cone) => displaced_rounded_cone(cone, outward).map(Into::into),
        AnySolid::Sphere(sphere) => {
            let radius = sphere.radius() + outward;
            Some(Sphere::new(sphere.center(), radius).ok()?.into())
        }
        AnySolid::Cuboid(cuboid) => {
            let half_widths = cuboid.half_widths() + outward;
            let cuboid = Cuboid::new(cuboid.center(), half_widths, cuboid.orientation());
            Some(cuboid.ok()?.into())
        }
        AnySolid::Disk(disk) => (outward > 0.0).then(|| coin(disk, outward))?,
    }
}

/// All points within a distance of a disk, and a few more.
fn coin(disk: &Disk, reach: f64) -> Option<AnySolid> {
    let up = disk.normal().normalize() * reach;
    let (center, radius) = (disk.center(), disk.radius() + reach);
    let coin = Cylinder::new(center - up, center + up, radius, Caps::Both);
    coin.ok().map(Into::into)
}

fn displaced_cylinder(cylinder: &Cylinder, outward: f64) -> Option<Cylinder> {
    let (p0, p1) = (cylinder.p0(), cylinder.p1());
    let along = (p1 - p0).normalize() * outward;
    let radius = cylinder.radius() + outward;
    let cylinder = Cylinder::new(p0 - along, p1 + along, radius, Caps::Both).ok()?;
    is_left(p1 - p0, cylinder.p1() - cylinder.p0()).then_some(cylinder)
}

fn displaced_cone(cone: &Cone, outward: f64) -> Option<Cone> {
    let (mut p0, mut p1) = (cone.p0(), cone.p1());
    let axis = p1 - p0;
    let length = axis.length();
    let unit = axis / length;
    let slope = (cone.radius1() - cone.radius0()) / length;
    let root = libm::hypot(1.0, slope);
    // One of the two differs from the other's reciprocal by its sign alone.
    let [at_p0, at_p1] = if slope > 0.0 {
        [1.0 / (root + slope), root + slope]
    } else {
        [root - slope, 1.0 / (root - slope)]
    };
    let (mut radius0, mut radius1) = (
        cone.radius0() + outward * at_p0,
        cone.radius1() + outward * at_p1,
    );
    p0 -= unit * outward;
    p1 += unit * outward;
    if radius0 < 0.0 {
        p0 -= unit * (radius0 / slope);
        radius0 = 0.0;
    } else if radius1 < 0.0 {
        p1 -= unit * (radius1 / slope);
        radius1 = 0.0;
    }
    let cone = Cone::new(p0, p1, radius0, radius1, Caps::Both).ok()?;
    is_left(axis, p1 - p0).then_some(cone)
}

fn displaced_rounded_cone(cone: &RoundedCone, outward: f64) -> Option<RoundedCone> {
    let (mut p0, mut p1) = (cone.p0(), cone.p1());
    let axis = p1 - p0;
    let growth = cone.radius1() - cone.radius0();
    let (mut radius0, mut radius1) = (cone.radius0() + outward, cone.radius1() + outward);
    if radius0 < 0.0 && radius1 > 0.0 {
        p0 -= axis * (radius0 / growth);
        radius0 = 0.0;
    } else if radius1 < 0.0 && radius0 > 0.0 {
        p1 -= axis * (radius1 / growth);
        radius1 = 0.0;
    }
    RoundedCone::new(p0, p1, radius0, radius1).ok()
}

/// Whether an axis that was shortened at its ends still goes the same way.
fn is_left(before: DVec3, after: DVec3) -> bool {
    after.dot(before) > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounding_meshes::hull::tests::random_solid;
    use cyltrace::math::Random;
    use cyltrace::solid::Location;

    /// A random point of a solid: on a chord through its middle.
    fn point_of(solid: &AnySolid, random: &mut Random) -> Option<DVec3> {
        let (anchor, direction) = (solid.anchor(), random.direction());
        let from_anchor = solid.center() - anchor;
        let chord = solid.chord(from_anchor, direction)?;
        let t = random.uniform(chord.enter.t, chord.leave.t);
        Some(anchor + (from_anchor + direction * t))
    }

    #[test]
    fn grown_solids_hold_and_shrunk_ones_leave_what_is_within_the_distance() {
        let mut random = Random::new(91, 0);
        let mut tried = [0; 2];
        for case in 0..40_000 {
            let solid = random_solid(&mut random);
            let size = solid.size();
            let distance = size * random.log_uniform(1e-6, 0.1);
            // The roundings of points and of the displaced solid.
            let step = random.direction() * (distance - 1e-13 * size);
            if let Some(grown) = displaced(&solid, distance)
                && let Some(point) = point_of(&solid, &mut random)
            {
                tried[0] += 1;
                let found = grown.locate(point + step);
                assert_eq!(found, Location::Inside, "case {case}: {solid:?}");
            }
            if let Some(shrunk) = displaced(&solid, -distance)
                && let Some(point) = point_of(&shrunk, &mut random)
            {
                tried[1] += 1;
                let found = solid.locate(point + step);
                assert_eq!(found, Location::Inside, "case {case}: {solid:?}");
            }
        }
        assert!(tried.iter().all(|&tried| tried > 20_000), "{tried:?}");
    }

    /// Beside walls and faces the displaced surface is at the distance, not farther.
    #[test]
    fn surfaces_are_displaced_by_no_more() {
        let mut random = Random::new(92, 0);
        let mut tried = 0;
        for case in 0..20_000 {
            let solid = random_solid(&mut random);
            let distance = solid.size() * random.log_uniform(1e-6, 1e-2);
            let Some(grown) = displaced(&solid, distance) else {
                continue;
            };
            let (anchor, direction) = (solid.anchor(), random.direction());
            let from_anchor = solid.center() - anchor;
            let Some(chord) = solid.chord(from_anchor, direction) else {
                continue;
            };
            let on_surface = from_anchor + direction * chord.leave.t;
            let surface = solid.surface_point(chord.leave.part, on_surface);
            let beyond = surface.point + surface.normal * (1.001 * distance);
            tried += 1;
            let found = grown.locate(beyond);
            assert_ne!(found, Location::Inside, "case {case}: {solid:?}");
        }
        assert!(tried > 10_000, "{tried}");
    }
}
