//! Cases in whole numbers, small enough for every sum and product to be exact: lines
//! through the apex, within planes that touch the wall, and through its rims.

use glam::DVec3;

use super::{TaperCase, TaperSolid};
use crate::cases::aiming::{sign, valid, whole, whole_frame, whole_number, whole_ray_through};
use cyltrace::math::Random;

/// The case, or that with its ends exchanged.
fn either_way(random: &mut Random, case: TaperCase) -> TaperCase {
    if random.below(2) == 0 {
        return case;
    }
    TaperCase {
        p0: case.p1,
        p1: case.p0,
        radius0: case.radius1,
        radius1: case.radius0,
        ray: case.ray,
    }
}

/// A ray exactly through the apex: it starts a whole number of directions before.
pub(super) fn through_apex(random: &mut Random) -> Option<TaperCase> {
    let [apex, a, d] = std::array::from_fn(|_| whole(random, 200));
    let radius = random.below(300) as f64 + 1.0;
    let ray = valid(apex - d * (random.below(50) as f64 + 1.0), d)?;
    let case = TaperCase {
        p0: apex,
        p1: apex + a,
        radius0: 0.0,
        radius1: radius,
        ray,
    };
    (a != DVec3::ZERO).then(|| either_way(random, case))
}

/// A ray in a plane that touches the wall along a line; half of them along that
/// line itself, one in sixteen of these an ulp beside it.
///
/// The axis is along z, and the half-plane of the line is turned by the angle of a
/// Pythagorean triple, so that all its points are whole. For balls the half-angle
/// of the cone is one of a triple as well.
pub(super) fn tangent_plane(random: &mut Random, solid: TaperSolid) -> Option<TaperCase> {
    const TRIPLES: [[f64; 3]; 4] = [
        [3.0, 4.0, 5.0],
        [4.0, 3.0, 5.0],
        [5.0, 12.0, 13.0],
        [8.0, 15.0, 17.0],
    ];
    let [u, v, unit] = TRIPLES[random.below(4) as usize];
    let (outward, flat) = (DVec3::new(u, v, 0.0), DVec3::new(-v, u, 0.0));
    let (few, steps) = (random.below(20) as f64, random.below(20) as f64 + 1.0);
    let (length, radius0, radius1, start, way) = match solid {
        TaperSolid::Cone => {
            let other = random.below(20) as f64;
            let way = outward * (other - few) + DVec3::Z * steps;
            (steps, few * unit, other * unit, outward * few, way)
        }
        TaperSolid::RoundedCone => {
            let [sine, cosine, whole] = TRIPLES[random.below(4) as usize];
            let (normal, part) = (
                outward * cosine - DVec3::Z * (sine * unit),
                whole * whole * unit,
            );
            let way = normal * sine + DVec3::Z * part;
            let (radius0, radius1) = (few * unit * whole, (few + steps * sine) * unit * whole);
            (steps * part, radius0, radius1, normal * few, way)
        }
    };
    if radius0 == radius1 {
        return None;
    }
    let aside = if random.below(2) == 0 {
        0.0
    } else {
        whole_number(random, 9)
    };
    let d = (way * (random.below(5) as f64) + flat * aside) * sign(random);
    let through = start + way * whole_number(random, 30);
    let beside = if random.below(16) == 0 {
        DVec3::X * f64::from(f32::EPSILON)
    } else {
        DVec3::ZERO
    };
    let ray = valid(through - d * (random.below(9) as f64) + beside, d)?;
    let case = TaperCase {
        p0: DVec3::ZERO,
        p1: DVec3::Z * length,
        radius0,
        radius1,
        ray,
    };
    Some(either_way(random, case))
}

/// A ray exactly through a point of the edge of a disk, or of the seam of wall and ball.
///
/// The axis is along a vector of a frame, and the point is beside it by the triple 3, 4, 5.
/// For balls that is the sine and cosine of the half-angle of the cone as well.
pub(super) fn exact_rim(random: &mut Random, solid: TaperSolid) -> Option<TaperCase> {
    let [x, y, z] = whole_frame(random);
    let unit = x.length();
    let outward = x * (3.0 * sign(random)) + y * (4.0 * sign(random));
    let p0 = whole(random, 20);
    let (few, steps) = (random.below(6) as f64, random.below(6) as f64 + 1.0);
    let (axis, radius0, radius1, off) = match solid {
        TaperSolid::Cone => {
            let other = random.below(6) as f64;
            let radii = (few * 5.0 * unit, other * 5.0 * unit);
            (z * steps, radii.0, radii.1, outward * few)
        }
        TaperSolid::RoundedCone => {
            // The normal of the wall, of length 25 units.
            let normal = outward * 4.0 - z * 15.0;
            let radii = (few * 25.0 * unit, (few * 25.0 + steps * 15.0) * unit);
            (z * (steps * 25.0), radii.0, radii.1, normal * few)
        }
    };
    let ray = whole_ray_through(random, p0 + off)?;
    let case = TaperCase {
        p0,
        p1: p0 + axis,
        radius0,
        radius1,
        ray,
    };
    (radius0 != radius1).then(|| either_way(random, case))
}
