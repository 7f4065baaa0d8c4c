//! The oracle through placements: a placement of whole numbers and powers of two
//! carries a ray without a rounding, so that the answer has to be that of the ray it
//! carried; and of any placement the points found are put back into the equations of
//! the solid.

use cyltrace::math::{Random, Ray, power_of_two};
use cyltrace::solid::{AnySolid, Caps, Crossing, Cuboid, Cylinder, Disk, Part, Sphere};
use cyltrace::{math::Orientation, solid::Cone, solid::RoundedCone};
use cyltrace_oracle::{
    Exact, ExactAffine, ExactVector, TrueHit, exact, hits_of_any, placed_first_hit,
    placed_hits_of_any,
};
use glam::{DAffine3, DMat3, DVec3};
use test_support::aim::carried;
use test_support::bits;
use test_support::solids::{KINDS, crowd, ray_near};

const SEED: u64 = 62;

/// What two answers of several hundred bits may differ by, with numbers around 1.
fn is_zero(x: &Exact) -> bool {
    let tiny = exact(power_of_two(-500));
    -&tiny <= *x && *x <= tiny
}

fn is_positive(x: &Exact) -> bool {
    *x > exact(0.0)
}

/// A small whole number.
fn whole(random: &mut Random, from: i32, count: u64) -> f64 {
    f64::from(from) + random.below(count) as f64
}

/// A solid whose edges, rims or walls rays of small whole numbers often touch.
fn coarse_solid(random: &mut Random, kind: u64, caps: Caps) -> AnySolid {
    let p0 = DVec3::from_array([0; 3].map(|_| whole(random, -1, 3)));
    let p1 = p0 + DVec3::AXES[random.below(3) as usize] * whole(random, 1, 3);
    let (radius, other) = (whole(random, 1, 2), whole(random, 0, 3));
    let half_widths = DVec3::from_array([0; 3].map(|_| whole(random, 1, 2)));
    match kind {
        0 => Cylinder::new(p0, p1, radius, caps).unwrap().into(),
        1 => Cone::new(p0, p1, radius, other, caps).unwrap().into(),
        2 => RoundedCone::new(p0, p1, radius, 0.5 * other + 0.5)
            .unwrap()
            .into(),
        3 => Sphere::new(p0, radius).unwrap().into(),
        4 => Cuboid::new(p0, half_widths, Orientation::IDENTITY)
            .unwrap()
            .into(),
        _ => Disk::new(p0, p1 - p0, radius).unwrap().into(),
    }
}

/// A ray of small whole numbers, mostly along an axis or a diagonal of a face.
fn coarse_ray(random: &mut Random) -> Ray {
    let origin = DVec3::from_array([0; 3].map(|_| whole(random, -3, 7)));
    let mut direction = DVec3::from_array([0; 3].map(|_| whole(random, -1, 3)));
    if direction == DVec3::ZERO {
        direction = DVec3::Z;
    }
    let t_min = [f64::NEG_INFINITY, 0.0, 1.0][random.below(3) as usize];
    let t_max = [f64::INFINITY, 4.0][random.below(2) as usize];
    Ray {
        origin,
        direction,
        t_min,
        t_max,
    }
}

/// Quarter turns and mirrors, times a scale and, in every third case, a shear.
fn whole_placement(random: &mut Random) -> DAffine3 {
    let mut axes = DVec3::AXES;
    axes.rotate_left(random.below(3) as usize);
    if random.below(2) == 0 {
        axes.swap(0, 1);
    }
    let [x, y, z] = axes.map(|axis| axis * [-1.0, 1.0][random.below(2) as usize]);
    let scale = [0.125, 1.0, 3.0, 64.0][random.below(4) as usize];
    let mut shear = DMat3::IDENTITY;
    if random.below(3) == 0 {
        shear.y_axis.x = whole(random, -2, 5);
        shear.z_axis.x = whole(random, -2, 5);
        shear.z_axis.y = whole(random, -2, 5);
    }
    let translation = DVec3::from_array([0; 3].map(|_| whole(random, -50, 101)));
    DAffine3::from_mat3_translation(DMat3::from_cols(x, y, z) * shear * scale, translation)
}

fn assert_same(found: &[TrueHit], expected: &[TrueHit], case: &dyn Fn() -> String) {
    let keys = |hits: &[TrueHit]| -> Vec<(Part, Crossing)> {
        hits.iter().map(|hit| (hit.part, hit.crossing)).collect()
    };
    assert_eq!(keys(found), keys(expected), "{}", case());
    for (found, expected) in found.iter().zip(expected) {
        assert!(is_zero(&(&found.t - &expected.t)), "{}", case());
    }
}

#[test]
fn identity_and_whole_placements_keep_every_hit() {
    let mut hits = [0; KINDS as usize];
    let mut touched = 0;
    for number in 0..20_000 {
        let mut random = Random::new(SEED, number);
        let kind = random.below(KINDS);
        let caps = [Caps::None, Caps::P0, Caps::P1, Caps::Both][random.below(4) as usize];
        let solid = coarse_solid(&mut random, kind, caps);
        let ray = coarse_ray(&mut random);
        let image = whole_placement(&mut random);
        let expected = hits_of_any(&solid, &ray);
        for image in [DAffine3::IDENTITY, image] {
            let found =
                placed_hits_of_any(&solid, &ExactAffine::new(&image), &carried(&image, &ray));
            let case = || {
                format!(
                    "seed {SEED}, {number}, {solid:?}, {image:?}, {}",
                    bits(&ray)
                )
            };
            assert_same(&found, &expected, &case);
        }
        hits[kind as usize] += expected.len();
        touched += usize::from(expected.len() == 2 && expected[0].t == expected[1].t);
    }
    println!("hits by kind {hits:?}, tangents {touched}");
    assert!(hits.iter().all(|&hits| hits > 400), "{hits:?}");
    assert!(touched > 100, "{touched}");
}

/// Turned, stretched by up to 10, sheared and moved; every other one mirrors.
fn any_placement(random: &mut Random) -> DAffine3 {
    let mut stretch = DVec3::from_array([0; 3].map(|_| random.log_uniform(0.3, 3.0)));
    if random.below(2) == 0 {
        stretch.x = -stretch.x;
    }
    let matrix = test_support::random_rotation(random)
        * DMat3::from_diagonal(stretch)
        * test_support::random_rotation(random);
    DAffine3::from_mat3_translation(matrix, random.direction() * random.log_uniform(1e-3, 1e3))
}

/// What the equations of a solid say of a point: that they are zero which make the
/// part, and none of those negative which bound it.
struct Equations {
    zero: Exact,
    not_negative: Vec<Exact>,
}

/// The equations of the part of a solid at the point.
fn equations(solid: &AnySolid, part: Part, point: &ExactVector) -> Equations {
    let from = |center: DVec3| point - &ExactVector::new(center);
    let square = |x: &Exact| x * x;
    let within = |way: &ExactVector, radius: f64| square(&exact(radius)) - way.dot(way);
    let (ends, radii, is_rounded) = match solid {
        AnySolid::Sphere(one) => {
            return Equations {
                zero: within(&from(one.center()), one.radius()),
                not_negative: Vec::new(),
            };
        }
        AnySolid::Disk(one) => {
            let way = from(one.center());
            return Equations {
                zero: way.dot(&ExactVector::new(one.normal())),
                not_negative: vec![within(&way, one.radius())],
            };
        }
        AnySolid::Cuboid(one) => {
            let frame = one.orientation().world_from_object();
            let mut below = Vec::new();
            for axis in 0..3 {
                let own = ExactVector::new(frame.col(axis)).dot(&from(one.center()));
                let half_width = exact(one.half_widths()[axis]);
                below.extend([&half_width + &own, half_width - own]);
            }
            let faces = [
                Part::XMin,
                Part::XMax,
                Part::YMin,
                Part::YMax,
                Part::ZMin,
                Part::ZMax,
            ];
            let face = faces.iter().position(|face| *face == part).unwrap();
            return Equations {
                zero: below[face].clone(),
                not_negative: below,
            };
        }
        AnySolid::Cylinder(one) => ([one.p0(), one.p1()], [one.radius(); 2], false),
        AnySolid::Cone(one) => {
            let radii = [one.radius0(), one.radius1()];
            ([one.p0(), one.p1()], radii, false)
        }
        AnySolid::RoundedCone(one) => {
            let radii = [one.radius0(), one.radius1()];
            ([one.p0(), one.p1()], radii, true)
        }
    };
    // With q = point - p0: the heights along the axis of the two disks, or of the
    // circles in which the wall touches the balls.
    let axis = &ExactVector::new(ends[1]) - &ExactVector::new(ends[0]);
    let q = from(ends[0]);
    let (aa, aq, change) = (
        axis.dot(&axis),
        axis.dot(&q),
        exact(radii[1]) - exact(radii[0]),
    );
    let wall = {
        let slope_sq = if is_rounded {
            &change * &change
        } else {
            exact(0.0)
        };
        let distance_sq = &aa * q.dot(&q) - &aq * &aq;
        let radius = exact(radii[0]) * &aa + &change * &aq;
        square(&radius) - (&aa - slope_sq) * distance_sq
    };
    if is_rounded {
        let above = &aq + exact(radii[0]) * &change;
        let below = &aa - exact(radii[1]) * &change - &aq;
        let (zero, not_negative) = match part {
            Part::Cap0 => (within(&q, radii[0]), vec![-above]),
            Part::Cap1 => (within(&from(ends[1]), radii[1]), vec![-below]),
            _ => (wall, vec![above, below]),
        };
        return Equations { zero, not_negative };
    }
    let below = &aa - &aq;
    let (zero, not_negative) = match part {
        Part::Cap0 => (aq, vec![within(&q, radii[0])]),
        Part::Cap1 => (below, vec![within(&from(ends[1]), radii[1])]),
        _ => (wall, vec![aq, below]),
    };
    Equations { zero, not_negative }
}

#[test]
fn points_found_through_a_shear_satisfy_the_solid_s_equations() {
    let solids = crowd(SEED, 60);
    let mut hits = [0; KINDS as usize];
    for number in 0..20_000 {
        let mut random = Random::new(SEED, 100_000 + number);
        let which = random.below(solids.len() as u64) as usize;
        let (solid, image) = (&solids[which], any_placement(&mut random));
        let ray = Ray {
            t_min: f64::NEG_INFINITY,
            ..carried(&image, &ray_near(&mut random, solid))
        };
        let placement = ExactAffine::new(&image);
        let (adjugate, determinant) = placement.adjugate();
        let found = placed_hits_of_any(solid, &placement, &ray);
        let case = || {
            format!(
                "seed {SEED}, {number}, {solid:?}, {image:?}, {}",
                bits(&ray)
            )
        };
        for hit in &found {
            let way = ExactVector::new(ray.direction).times(&hit.t);
            let point = &ExactVector::new(ray.origin) + &way;
            let point = adjugate.times(&(&point - placement.translation()));
            let divisor = determinant.clone().with_precision(700).value();
            let divided = |x: Exact| x.with_precision(700).value() / &divisor;
            let point = ExactVector(point.0.map(divided));
            let Equations { zero, not_negative } = equations(solid, hit.part, &point);
            assert!(is_zero(&zero), "{hit:?}: {}", case());
            for one in &not_negative {
                assert!(is_positive(one) || is_zero(one), "{hit:?}: {}", case());
            }
        }
        if let AnySolid::Cylinder(cylinder) = solid {
            let first = placed_first_hit(cylinder, &placement, &ray).hit;
            let first: Vec<TrueHit> = first.into_iter().collect();
            assert_same(&found[..found.len().min(1)], &first, &case);
        }
        hits[which % KINDS as usize] += found.len();
    }
    println!("hits by kind {hits:?}");
    assert!(hits.iter().all(|&hits| hits > 200), "{hits:?}");
}
