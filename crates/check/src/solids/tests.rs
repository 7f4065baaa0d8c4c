//! Depths against supporting planes and exact distances; displaced solids against points.

use super::*;
use cyltrace::math::{Orientation, Random, UNIT_ROUNDOFF};
use cyltrace::solid::{Caps, Cone, Cuboid, Cylinder, Location, Part, RoundedCone, Sphere};
use cyltrace_oracle::distance_to_cone;
use test_support::solids::{random_solid as mixed_solid, support};

/// A solid of any kind but a disk, about unit size and not far away; some
/// have an apex, radii nearly equal or ends as large as they are long.
pub(crate) fn random_solid(random: &mut Random) -> AnySolid {
    let center = random.direction() * random.log_uniform(1e-3, 10.0);
    let along = random.direction() * random.log_uniform(0.1, 3.0);
    let radius = random.log_uniform(0.05, 1.0);
    let other = match random.below(4) {
        0 => 0.0,
        1 => radius * (1.0 + random.log_uniform(1e-12, 1e-3)),
        _ => random.log_uniform(0.05, 1.0),
    };
    let (radius0, radius1) = if random.below(2) == 0 {
        (radius, other)
    } else {
        (other, radius)
    };
    match random.below(5) {
        0 => Sphere::new(center, radius).unwrap().into(),
        1 => {
            let mut width = || random.log_uniform(0.05, 1.0);
            let half_widths = DVec3::new(width(), width(), width());
            let turned = Orientation::IDENTITY.rotated(random.direction(), 360.0 * random.unit());
            Cuboid::new(center, half_widths, turned).unwrap().into()
        }
        2 => Cylinder::new(center, center + along, radius, Caps::Both)
            .unwrap()
            .into(),
        3 => Cone::new(center, center + along, radius0, radius1, Caps::Both)
            .unwrap()
            .into(),
        _ => RoundedCone::new(center, center + along, radius0, radius1)
            .unwrap()
            .into(),
    }
}

/// The depth is the least of `h(n) - n·x` over all unit vectors n, h the support
/// function: none is less, and that along the depth's own gradient is equal.
#[test]
fn depth_is_how_far_the_nearest_supporting_plane_is() {
    const SEED: u64 = 43;
    let mut smooth = 0;
    for case in 0..20_000 {
        let mut random = Random::new(SEED, case);
        let solid = mixed_solid(&mut random);
        let point = random.direction() * random.log_uniform(1e-3, 3.0) * solid.size();
        let found = shape(&solid).get().depth(point);
        let size = solid.size() + point.length();
        let over = |normal: DVec3| support(&solid, normal) - normal.dot(point) - found;
        let what = format!("seed {SEED}, case {case}: {solid:?} {point:?}, {found:e}");
        for _ in 0..20 {
            let least = over(random.direction());
            assert!(least >= -64.0 * UNIT_ROUNDOFF * size, "{what}: {least:e}");
        }
        let step = 1e-5 * found.abs();
        let gradient = DVec3::AXES.map(|axis| {
            let ends = [step, -step].map(|step| shape(&solid).get().depth(point + axis * step));
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
            let seen = shape(&cone.into()).surface_distance(point);
            let most = 64.0 * UNIT_ROUNDOFF * (r0 + r1 + length + reach);
            assert!(
                (seen - expected).abs() <= most,
                "seed {SEED}, case {case}: {cone:?} {point:?}: {seen} {expected}"
            );
            let open = usize::from(!caps.at_p0()) + usize::from(!caps.at_p1() && r1 > 0.0);
            assert_eq!(shape(&cone.into()).open_ends().count(), open);
        }
    }
}

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
