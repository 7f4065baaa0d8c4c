//! How far a point is from the surface of a solid, in the solid's own space.
//!
//! The *depth* of a point in a closed solid is its distance from the surface, negative
//! outside. As the solid is convex, the depth is concave along a line.
//!
//! Cylinder and cone are seen in the half-plane of the axis and the point, where a point
//! has a height y and a distance ρ from the axis: there the wall and the disks are
//! segments. A rounded cone is a union of balls of radius `r0 + v Δ` about `p0 + v a`, v
//! in \[0, 1\]; the depth in it is the greatest of the depths in all of them,
//!
//! ```text
//! max r0 + v Δ - |(y - v |a|, ρ)|                                           (1)
//! ```
//!
//! since the nearest point of the surface is on one of them, and the way to it passes or
//! begins beside its center. It is concave in v, and greatest at
//! `v |a| = y + ρ Δ / √(|a|² - Δ²)`, or at an end: at that of the greater ball where
//! it holds the other.
//!
//! A solid that is composed of others has the greatest or the least of their depths, with
//! the other sign for what is taken away. That changes no faster than the point is moved,
//! and its sign is right: so its size is no more than the distance from the surface.
//!
//! All is a few u of the solid's size and the point's distance from it, u = 2^-53: an
//! error of v only chooses another ball beside the nearest one.

use glam::{DVec2, DVec3};

use cyltrace::solid::{AnySolid, Caps, Composition, Cuboid, Disk, RoundedCone};

/// The depth of a point in the closed solid; negative outside. A disk has no inside.
pub(super) fn depth(solid: &AnySolid, point: DVec3) -> f64 {
    match solid {
        AnySolid::Cylinder(_) | AnySolid::Cone(_) => Frustum::of(solid, point).depth(),
        AnySolid::RoundedCone(cone) => depth_in_rounded_cone(cone, point),
        AnySolid::Sphere(sphere) => sphere.radius() - (point - sphere.center()).length(),
        AnySolid::Cuboid(cuboid) => depth_in_cuboid(cuboid, point),
        AnySolid::Disk(disk) => {
            let (height, beyond_rim) = beside_disk(disk, point);
            -libm::hypot(height, beyond_rim.max(0.0))
        }
    }
}

/// No more than the depth of a point in a composed solid, and no more in size, with its
/// sign.
pub(super) fn depth_in_composed(solid: &Composition, point: DVec3) -> f64 {
    let depths = |parts: &[Composition]| -> Vec<f64> {
        let parts = parts.iter();
        parts.map(|part| depth_in_composed(part, point)).collect()
    };
    let nowhere = f64::NEG_INFINITY;
    match solid {
        Composition::Solid(solid) => depth(solid, point),
        Composition::Union(parts) => depths(parts).into_iter().fold(nowhere, f64::max),
        Composition::Intersection(parts) => depths(parts)
            .into_iter()
            .reduce(f64::min)
            .unwrap_or(nowhere),
        Composition::Difference(parts) => {
            let operands = depths(parts).into_iter().enumerate();
            let operands = operands.map(|(number, depth)| if number == 0 { depth } else { -depth });
            operands.reduce(f64::min).unwrap_or(nowhere)
        }
    }
}

/// The distance of a point from the surface as it is, with open ends.
pub(super) fn surface_distance(solid: &AnySolid, point: DVec3) -> f64 {
    match solid {
        AnySolid::Cylinder(cylinder) => Frustum::of(solid, point).distance(cylinder.caps()),
        AnySolid::Cone(cone) => Frustum::of(solid, point).distance(cone.caps()),
        _ => depth(solid, point).abs(),
    }
}

/// The open ends of a solid: where each is, and the unit vector along the axis from
/// there to the other end. An apex is none.
pub(super) fn open_ends(solid: &AnySolid) -> Vec<(DVec3, DVec3)> {
    let (p0, p1, [r0, r1], caps) = match solid {
        AnySolid::Cylinder(c) => (c.p0(), c.p1(), [c.radius(); 2], c.caps()),
        AnySolid::Cone(c) => (c.p0(), c.p1(), [c.radius0(), c.radius1()], c.caps()),
        _ => return Vec::new(),
    };
    let axis = (p1 - p0).normalize();
    let is_open = [r0 > 0.0 && !caps.at_p0(), r1 > 0.0 && !caps.at_p1()];
    let ends = [(p0, axis), (p1, -axis)].into_iter().zip(is_open);
    ends.filter_map(|(end, is_open)| is_open.then_some(end))
        .collect()
}

/// The height of a point above the plane of a disk, on the side of its normal, and how
/// far it is beyond the rim, as seen along the normal.
pub(super) fn beside_disk(disk: &Disk, point: DVec3) -> (f64, f64) {
    let (height, away) = heights(disk.normal().normalize(), point - disk.center());
    (height, away - disk.radius())
}

/// The height along an axis and the distance from it.
fn heights(axis: DVec3, from_axis: DVec3) -> (f64, f64) {
    let height = from_axis.dot(axis);
    (height, (from_axis - axis * height).length())
}

/// A point in the half-plane of a cylinder's or a cone's axis, as `(y, ρ)`, and the
/// corners there.
struct Frustum {
    point: DVec2,
    length: f64,
    rims: [DVec2; 2],
}

impl Frustum {
    fn of(solid: &AnySolid, point: DVec3) -> Self {
        let (p0, p1, r0, r1) = match solid {
            AnySolid::Cylinder(c) => (c.p0(), c.p1(), c.radius(), c.radius()),
            AnySolid::Cone(c) => (c.p0(), c.p1(), c.radius0(), c.radius1()),
            other => unreachable!("a {} has no disks", other.kind().name()),
        };
        let length = (p1 - p0).length();
        let (height, away) = heights((p1 - p0) / length, point - p0);
        Self {
            point: DVec2::new(height, away),
            length,
            rims: [DVec2::new(0.0, r0), DVec2::new(length, r1)],
        }
    }

    fn depth(&self) -> f64 {
        let [rim0, rim1] = self.rims;
        let wall = rim1 - rim0;
        let below_wall = wall.perp_dot(rim0 - self.point) / wall.length();
        let inside = below_wall.min(self.point.x).min(self.length - self.point.x);
        if inside >= 0.0 {
            return inside;
        }
        -self.distance(Caps::Both)
    }

    fn distance(&self, caps: Caps) -> f64 {
        let [rim0, rim1] = self.rims;
        let mut nearest = self.to_segment(rim0, rim1);
        for (is_there, rim) in [(caps.at_p0(), rim0), (caps.at_p1(), rim1)] {
            if is_there {
                nearest = nearest.min(self.to_segment(rim.with_y(0.0), rim));
            }
        }
        nearest
    }

    fn to_segment(&self, start: DVec2, end: DVec2) -> f64 {
        let (way, from_start) = (end - start, self.point - start);
        let squared = way.length_squared();
        // The disk of an apex is a point.
        let share = if squared > 0.0 {
            (from_start.dot(way) / squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (from_start - way * share).length()
    }
}

/// See (1).
fn depth_in_rounded_cone(cone: &RoundedCone, point: DVec3) -> f64 {
    let (a, from_p0) = (cone.p1() - cone.p0(), point - cone.p0());
    let (length, r0) = (a.length(), cone.radius0());
    let delta = cone.radius1() - r0;
    if !(delta.abs() < length) {
        let from_p1 = point - cone.p1();
        return (r0 - from_p0.length()).max(cone.radius1() - from_p1.length());
    }
    let (height, away) = heights(a / length, from_p0);
    let slope = delta / ((length - delta) * (length + delta)).sqrt();
    let along = (height + away * slope).clamp(0.0, length);
    r0 + delta * (along / length) - libm::hypot(height - along, away)
}

fn depth_in_cuboid(cuboid: &Cuboid, point: DVec3) -> f64 {
    let own = cuboid.orientation().to_object(point - cuboid.center());
    let beyond = own.abs() - cuboid.half_widths();
    if beyond.max_element() <= 0.0 {
        return -beyond.max_element();
    }
    -beyond.max(DVec3::ZERO).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cyltrace::math::{Random, UNIT_ROUNDOFF};
    use cyltrace::solid::{Cone, Location, Part, Sphere};
    use cyltrace_oracle::distance_to_cone;
    use test_support::solids::{random_solid, support};

    /// The depth is the least of `h(n) - n·x` over all unit vectors n, h the support
    /// function: none is less, and that along the depth's own gradient is equal.
    #[test]
    fn depth_is_how_far_the_nearest_supporting_plane_is() {
        const SEED: u64 = 43;
        let mut smooth = 0;
        for case in 0..20_000 {
            let mut random = Random::new(SEED, case);
            let solid = random_solid(&mut random);
            let point = random.direction() * random.log_uniform(1e-3, 3.0) * solid.size();
            let found = depth(&solid, point);
            let size = solid.size() + point.length();
            let over = |normal: DVec3| support(&solid, normal) - normal.dot(point) - found;
            let what = format!("seed {SEED}, case {case}: {solid:?} {point:?}, {found:e}");
            for _ in 0..20 {
                let least = over(random.direction());
                assert!(least >= -64.0 * UNIT_ROUNDOFF * size, "{what}: {least:e}");
            }
            let step = 1e-5 * found.abs();
            let gradient = DVec3::AXES.map(|axis| {
                let ends = [step, -step].map(|step| depth(&solid, point + axis * step));
                (ends[0] - ends[1]) / (2.0 * step)
            });
            let gradient = DVec3::from_array(gradient);
            // Not so where two places of the surface are equally near.
            if (gradient.length() - 1.0).abs() < 1e-4 && found.abs() > 1e-3 * size {
                smooth += 1;
                let least = over(-gradient.normalize());
                assert!(least.abs() <= 1e-6 * size, "{what}: {least:e}");
            }
        }
        assert!(smooth > 10_000, "{smooth}");
    }

    /// Within the depth of a point all points are on the same side.
    #[test]
    fn depth_in_composed_solids_is_room_on_one_side() {
        const SEED: u64 = 45;
        let mut sides = [0, 0];
        for case in 0..2_000 {
            let mut random = Random::new(SEED, case);
            let mut ball = || {
                let center = random.direction() * random.unit();
                let sphere = Sphere::new(center, random.uniform(0.3, 1.0)).unwrap();
                Composition::Solid(sphere.into())
            };
            let both = vec![ball(), ball()];
            let both = match case % 3 {
                0 => Composition::Union(both),
                1 => Composition::Intersection(both),
                _ => Composition::Difference(both),
            };
            let solid = match case % 5 {
                0 => Composition::Difference(vec![ball(), both]),
                1 => Composition::Intersection(vec![both, ball()]),
                _ => Composition::Union(vec![both, ball()]),
            };
            let point = random.direction() * random.uniform(0.0, 2.0);
            let found = depth_in_composed(&solid, point);
            let side = if found > 0.0 {
                Location::Inside
            } else {
                Location::Outside
            };
            sides[usize::from(found > 0.0)] += 1;
            for _ in 0..20 {
                let other = point + random.direction() * (found.abs() * random.uniform(0.0, 0.999));
                let what = format!("seed {SEED}, case {case}: {solid:?} {point:?} {other:?}");
                assert_eq!(solid.locate(other), side, "{what}");
            }
        }
        assert!(sides.into_iter().all(|side| side > 400), "{sides:?}");
    }

    #[test]
    fn surfaces_with_open_ends_are_as_far_as_exact_numbers_say() {
        const SEED: u64 = 44;
        let all = [Caps::None, Caps::P0, Caps::P1, Caps::Both];
        for case in 0..2_000 {
            let mut random = Random::new(SEED, case);
            let mut size = || random.log_uniform(1e-2, 1e2);
            let (r0, r1, length, reach) = (size(), size(), size(), size());
            let r1 = if case % 3 == 0 { 0.0 } else { r1 };
            let (p1, point) = (random.direction() * length, random.direction() * reach);
            for caps in all {
                let cone = Cone::new(DVec3::ZERO, p1, r0, r1, caps).unwrap();
                let to = |part, is_there: bool| {
                    let distance = distance_to_cone(&cone, part, point);
                    if is_there { distance } else { f64::INFINITY }
                };
                let expected = to(Part::Side, true)
                    .min(to(Part::Cap0, caps.at_p0()))
                    .min(to(Part::Cap1, caps.at_p1()));
                let seen = surface_distance(&cone.into(), point);
                let most = 64.0 * UNIT_ROUNDOFF * (r0 + r1 + length + reach);
                assert!(
                    (seen - expected).abs() <= most,
                    "seed {SEED}, case {case}: {cone:?} {point:?}: {seen} {expected}"
                );
                let open = usize::from(!caps.at_p0()) + usize::from(!caps.at_p1() && r1 > 0.0);
                assert_eq!(open_ends(&cone.into()).len(), open);
            }
        }
    }
}
