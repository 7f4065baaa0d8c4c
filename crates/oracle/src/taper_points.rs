//! Points and tapered solids: which solid contains a point, and how far it is from a
//! part of the surface.
//!
//! A point is seen in the half-plane of the axis: its height `y = a·q / |a|` and its
//! distance `ρ` from the axis, `ρ² = q·q - y²`. There the wall of a cone is the
//! segment from `(0, r0)` to `(|a|, r1)`. That of a rounded cone is the segment
//! between the two circles' points that have the same normal `(-Δ, √β) / |a|`.

use glam::DVec3;

use super::number::{Exact, exact, long, to_f64, zero};
use super::ray::ExactRay;
use super::taper::{Taper, numbers_of};
use cyltrace::math::Ray;
use cyltrace::solid::{Cone, Part, RoundedCone};

/// The distance of a point from a part of a cone.
#[must_use]
pub fn distance_to_cone(cone: &Cone, part: Part, point: DVec3) -> f64 {
    let radii = [cone.radius0(), cone.radius1()];
    let flat = Flat::new(&of([cone.p0(), cone.p1()], radii, point, false));
    let [r0, r1] = radii.map(exact);
    let end = flat.length.clone();
    match part {
        Part::Cap0 => flat.to_segment([zero(), zero()], [zero(), r0]),
        Part::Cap1 => flat.to_segment([end.clone(), zero()], [end, r1]),
        _ => flat.to_segment([zero(), r0], [end, r1]),
    }
}

/// The distance of a point from the sphere or the wall of a rounded cone.
#[must_use]
pub fn distance_to_rounded_cone(solid: &RoundedCone, part: Part, point: DVec3) -> f64 {
    let radii = [solid.radius0(), solid.radius1()];
    let taper = of([solid.p0(), solid.p1()], radii, point, true);
    let [r0, r1] = radii.map(exact);
    let to_sphere = |share, radius: &Exact| {
        let x = &taper.x - &taper.a.times(&exact(share));
        to_f64(&(long(&x.dot(&x)).sqrt() - long(radius))).abs()
    };
    if part != Part::Side {
        return match part {
            Part::Cap0 => to_sphere(0.0, &r0),
            _ => to_sphere(1.0, &r1),
        };
    }
    let flat = Flat::new(&taper);
    let root = long(&taper.beta).sqrt();
    let on_circle = |height: Exact, radius: &Exact| {
        let scaled = long(radius) / &flat.length;
        [height - &scaled * &taper.delta, scaled * &root]
    };
    flat.to_segment(on_circle(zero(), &r0), on_circle(flat.length.clone(), &r1))
}

/// The solid and the point, in the place of a ray's origin.
pub(super) fn of(ends: [DVec3; 2], radii: [f64; 2], point: DVec3, touches_balls: bool) -> Taper {
    let ray = ExactRay::new(&Ray::new(point, DVec3::X));
    Taper::new(&numbers_of(ends, radii, &ray), touches_balls)
}

/// A point in the half-plane of the axis.
struct Flat {
    length: Exact,
    height: Exact,
    distance: Exact,
}

impl Flat {
    fn new(taper: &Taper) -> Self {
        let length = long(&taper.aa).sqrt();
        let across = &taper.aa * taper.x.dot(&taper.x) - &taper.ax * &taper.ax;
        Self {
            height: long(&taper.ax) / &length,
            distance: long(&across).sqrt() / &length,
            length,
        }
    }

    /// The distance to the segment between two points (height, distance).
    fn to_segment(&self, start: [Exact; 2], end: [Exact; 2]) -> f64 {
        let way: [Exact; 2] = std::array::from_fn(|i| long(&(&end[i] - &start[i])));
        let from = [&self.height - &start[0], &self.distance - &start[1]];
        let squared = &way[0] * &way[0] + &way[1] * &way[1];
        let share = if squared == zero() {
            zero()
        } else {
            (&from[0] * &way[0] + &from[1] * &way[1]) / squared
        };
        let share = share.max(zero()).min(exact(1.0));
        let off: [Exact; 2] = std::array::from_fn(|i| long(&(&from[i] - &share * &way[i])));
        to_f64(&(&off[0] * &off[0] + &off[1] * &off[1]).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TrueSolid;
    use cyltrace::solid::Caps;

    #[test]
    fn distances_to_a_cone_of_a_pythagorean_triple() {
        let cone = Cone::new(DVec3::ZERO, DVec3::Z * 4.0, 3.0, 0.0, Caps::Both).unwrap();
        let at = |part, x: f64, z: f64| distance_to_cone(&cone, part, DVec3::new(x, 0.0, z));
        assert_eq!(at(Part::Side, 0.0, 4.0), 0.0);
        assert_eq!(at(Part::Side, 3.0 + 4.0, 3.0), 5.0);
        assert_eq!(at(Part::Side, 0.0, 9.0), 5.0);
        assert_eq!(at(Part::Cap0, 2.0, -7.0), 7.0);
        assert!(TrueSolid::truly_contains(&cone, DVec3::new(1.5, 0.0, 2.0)));
        assert!(!TrueSolid::truly_contains(
            &cone,
            DVec3::new(1.5_f64.next_up(), 0.0, 2.0)
        ));
        assert!(!TrueSolid::truly_contains(&cone, DVec3::new(0.0, 0.0, 5.0)));
    }

    #[test]
    fn distances_to_a_rounded_cone_of_a_pythagorean_triple() {
        // The normal of the wall is (3, 4) / 5: seams at (0.6, 0.8) and (8, 4).
        let solid = RoundedCone::new(DVec3::ZERO, DVec3::Z * 5.0, 4.0, 1.0).unwrap();
        let at =
            |part, x: f64, z: f64| distance_to_rounded_cone(&solid, part, DVec3::new(x, 0.0, z));
        assert!(at(Part::Side, 3.2, 2.4) < 1e-15);
        assert!((at(Part::Side, 3.2 + 8.0, 2.4 + 6.0) - 10.0).abs() < 1e-14);
        assert_eq!(at(Part::Cap0, 0.0, -6.0), 2.0);
        assert_eq!(at(Part::Cap1, 0.0, 7.0), 1.0);
        assert!(TrueSolid::truly_contains(&solid, DVec3::Z * 6.0));
        assert!(!TrueSolid::truly_contains(
            &solid,
            DVec3::Z * 6.0_f64.next_up()
        ));
        assert!(TrueSolid::truly_contains(&solid, DVec3::new(3.1, 0.0, 2.4)));
        assert!(!TrueSolid::truly_contains(
            &solid,
            DVec3::new(3.3, 0.0, 2.4)
        ));
    }
}
