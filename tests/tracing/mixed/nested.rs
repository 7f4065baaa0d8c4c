//! Solids of every kind down nested placements of any shape, by exact arithmetic.
//!
//! **Points.** `Hit::error` bounds how far `Hit::point` is from the surface, that is the
//! solid's carried through the exact placements. Any point of the surface bounds
//! that distance from above; the one that is met along the hit's normal is the nearest, to
//! first order.
//!
//! **Parameters and parts.** A ray goes down a placement `p = L c + T` as the exact image of a ray
//! that is displaced by at most `e |o - T|` in origin and `e |d|` in direction
//! (`docs/derivations.md`, section 6), with `κ = ‖L‖ ‖L⁻¹‖` in Frobenius norms and
//!
//! ```text
//! e = ‖L G - I‖ + u (1 + 7 κ) <= u (1 + 11 κ)
//! ```
//!
//! In the solid's own space the solver answers for a ray displaced by at most 32 u of
//! `|o| + |anchor| + size` (section 5). Δ is the sum of all this, taken to the world. A `t`
//! itself is within 2^-34 (section 8, point 4: a quotient of two values within 2^-36
//! each). So `o + t d` is within `Δ + 2^-34 t |d|` of the surface; and where
//! parts and crossings differ from the truth, a ray within Δ has them.

use cyltrace::math::{Random, Ray, UNIT_ROUNDOFF, frobenius_norm, power_of_two};
use cyltrace::solid::{AnySolid, Crossing, Part, SolidKind};
use cyltrace::tracer::{Hit, Tracer};
use cyltrace_oracle::{ExactAffine, ExactVector, TrueHit, exact, placed_hits_of_any, to_f64};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;

use super::{SEED, all_hits, tracer_of};
use test_support::aim::carried;
use test_support::solids::{KIND_NAMES, crowd, prototype_of, ray_near};
use test_support::{self, bits, placed, placing, random_placement};

/// Three placements, one in the other, and solids in the innermost.
struct Nest {
    solids: Vec<AnySolid>,
    /// The outermost first.
    levels: [DAffine3; 3],
    /// All of them, exactly.
    exact: ExactAffine,
    tracer: Tracer,
}

impl Nest {
    /// With every level up to `farthest` of its scale away.
    fn new(number: u64, farthest: f64) -> Self {
        let mut random = Random::new(SEED, 800_000 + number);
        let solids = crowd(SEED + 1_000 + number, 24);
        let levels = [(); 3].map(|()| {
            let translation = random.log_uniform(1.0, farthest);
            random_placement(&mut random, translation)
        });
        let [outer, middle, inner] = levels.each_ref().map(ExactAffine::new);
        let mut prototypes: Vec<_> = (1..)
            .zip(&levels)
            .map(|(of, level)| placing(vec![placed(of, *level)]))
            .collect();
        prototypes.push(prototype_of(&solids));
        Self {
            tracer: tracer_of(prototypes),
            exact: outer.after(&middle).after(&inner),
            solids,
            levels,
        }
    }

    /// Δ, for a ray up to `t`.
    fn displacement(&self, solid: &AnySolid, ray: &Ray, t: f64) -> f64 {
        let (mut o, mut d) = (ray.origin, ray.direction);
        let (mut sum, mut stretch) = (0.0, 1.0);
        for level in &self.levels {
            let inverse = level.matrix3.inverse();
            let norm = frobenius_norm(&level.matrix3);
            let condition = norm * frobenius_norm(&inverse);
            let reach = (o - level.translation).length() + t * d.length();
            sum += stretch * UNIT_ROUNDOFF * (1.0 + 11.0 * condition) * reach;
            stretch *= norm;
            (o, d) = (inverse * (o - level.translation), inverse * d);
        }
        let reach = o.length() + t * d.length() + solid.anchor().length() + solid.size();
        let of_solver = 32.0 * UNIT_ROUNDOFF * reach;
        sum + stretch * of_solver
    }

    /// A bound of the distance of `origin + way` from a part of a solid: that to where a
    /// line of direction `along` meets it.
    fn distance(
        &self,
        (solid, part): (&AnySolid, Part),
        origin: DVec3,
        way: &ExactVector,
        along: DVec3,
    ) -> f64 {
        // Counted from the origin, so that rounding the way to f64 is next to nothing;
        // what it comes to is part of the bound.
        let from_origin = ExactAffine::new(&DAffine3::from_translation(-origin));
        let start = way.rounded();
        let line = Ray {
            t_min: f64::NEG_INFINITY,
            ..Ray::new(start, along)
        };
        let met = placed_hits_of_any(solid, &from_origin.after(&self.exact), &line);
        let of_part = met.iter().filter(|hit| hit.part == part);
        let distances = of_part.map(|hit| to_f64(&hit.t).abs() * along.length());
        let aside = (way - &ExactVector::new(start)).length();
        aside + distances.fold(f64::INFINITY, f64::min)
    }

    /// Whether a ray within Δ has these parts and crossings.
    fn is_of_a_neighbour(
        &self,
        random: &mut Random,
        solid: &AnySolid,
        ray: &Ray,
        found: &[(Part, Crossing)],
    ) -> bool {
        let center = self.exact.point(&ExactVector::new(solid.center()));
        let way = center.rounded() - ray.origin;
        let t = way.length() / ray.direction.length();
        let displacement = self.displacement(solid, ray, t);
        (0..64).any(|_| {
            // Where the solid is moved the other way, the ray need not be rounded.
            let aside = random.direction() * (displacement * random.unit());
            let moved = ExactAffine::new(&DAffine3::from_translation(-aside)).after(&self.exact);
            keys_of(&placed_hits_of_any(solid, &moved, ray)) == found
        })
    }

    /// Holds the parts and crossings of a ray against exact arithmetic. Answers with the hits
    /// of each solid that are as they should be, and for how many solids
    /// they are those of another ray within Δ.
    fn judge_parts(&self, random: &mut Random, ray: &Ray) -> (Vec<Vec<Hit>>, u64) {
        let mut by_solid = vec![Vec::new(); self.solids.len()];
        for hit in all_hits(&self.tracer, ray) {
            by_solid[hit.primitive as usize].push(hit);
        }
        let mut displaced = 0;
        for (solid, found) in self.solids.iter().zip(&mut by_solid) {
            let truth = placed_hits_of_any(solid, &self.exact, ray);
            let keys: Vec<_> = found.iter().map(|hit| (hit.part, hit.crossing)).collect();
            if keys == keys_of(&truth) {
                continue;
            }
            assert!(
                self.is_of_a_neighbour(random, solid, ray, &keys),
                "{found:?}, truly {truth:?}: {}",
                self.case(solid, ray)
            );
            displaced += 1;
            found.clear();
        }
        (by_solid, displaced)
    }

    /// Holds the point and the parameter of a hit against their bounds.
    fn judge_hit(&self, ray: &Ray, hit: &Hit) -> Shares {
        let solid = &self.solids[hit.primitive as usize];
        let case = || format!("{hit:?}: {}", self.case(solid, ray));
        let part = (solid, hit.part);
        let nowhere = ExactVector::new(DVec3::ZERO);
        let off = self.distance(part, hit.point, &nowhere, hit.normal);
        assert!(off <= hit.error, "{off:e} from the surface, {}", case());
        let way = ExactVector::new(ray.direction).times(&exact(hit.t));
        let off_ray = self.distance(part, ray.origin, &way, hit.normal);
        let displacement = self.displacement(solid, ray, hit.t);
        assert!(
            off_ray <= displacement + power_of_two(-34) * way.length(),
            "{off_ray:e} from the surface, of {displacement:e}, {}",
            case()
        );
        Shares {
            of_error: off / hit.error,
            of_displacement: off_ray / displacement,
        }
    }

    fn case(&self, solid: &AnySolid, ray: &Ray) -> String {
        format!("seed {SEED}, {solid:?} in {:?}, {}", self.levels, bits(ray))
    }
}

/// How much of its bounds a hit uses.
struct Shares {
    of_error: f64,
    /// Of Δ alone.
    of_displacement: f64,
}

fn keys_of(hits: &[TrueHit]) -> Vec<(Part, Crossing)> {
    hits.iter().map(|hit| (hit.part, hit.crossing)).collect()
}

/// Rays near solids of 60 nests, each with its nest.
fn rays_near_solids<T: Send>(
    farthest: f64,
    judge: impl Fn(&Nest, &mut Random, &Ray) -> T + Sync,
) -> Vec<T> {
    let rays = test_support::ray_count() / 1_000;
    (0..60)
        .into_par_iter()
        .flat_map_iter(|number| {
            let nest = Nest::new(number, farthest);
            let image = nest.exact.rounded();
            let judge = &judge;
            (0..rays).map(move |ray| {
                let mut random = Random::new(SEED, 1_000_000 * number + ray);
                let which = random.below(nest.solids.len() as u64) as usize;
                let local = ray_near(&mut random, &nest.solids[which]);
                judge(&nest, &mut random, &carried(&image, &local))
            })
        })
        .collect()
}

#[test]
fn points_and_parameters_keep_their_bounds_down_random_nests() {
    let judged = rays_near_solids(1e6, |nest, random, ray| {
        let (by_solid, displaced) = nest.judge_parts(random, ray);
        assert_eq!(displaced, 0, "{}", bits(ray));
        let hits = by_solid.into_iter().flatten();
        let judged = hits.map(|hit| (hit.solid, nest.judge_hit(ray, &hit)));
        judged.collect::<Vec<_>>()
    });
    let hits: Vec<(SolidKind, Shares)> = judged.into_iter().flatten().collect();
    let counts = KIND_NAMES.map(|kind| hits.iter().filter(|hit| hit.0 == kind).count());
    let sorted = |share: fn(&Shares) -> f64| {
        let mut shares: Vec<f64> = hits.iter().map(|hit| share(&hit.1)).collect();
        shares.sort_by(f64::total_cmp);
        shares
    };
    let of_error = sorted(|shares| shares.of_error);
    let of_displacement = sorted(|shares| shares.of_displacement);
    println!(
        "hits of {KIND_NAMES:?}: {counts:?}; used at most {:.3} of Hit::error and {:.3} of Δ",
        of_error[hits.len() - 1],
        of_displacement[hits.len() - 1]
    );
    assert!(counts.iter().all(|&count| count > 500), "{counts:?}");
    // Where nothing cancels, a `t` is off by some u of itself, which is within Δ.
    let most = of_displacement[hits.len() / 100 * 99];
    assert!(most <= 1.0, "{most}");
}

#[test]
fn parts_far_down_random_nests_are_those_of_a_ray_within_the_bound() {
    let judged = rays_near_solids(1e11, |nest, random, ray| {
        let (by_solid, displaced) = nest.judge_parts(random, ray);
        (by_solid.iter().flatten().count() as u64, displaced)
    });
    let hits: u64 = judged.iter().map(|ray| ray.0).sum();
    let displaced: u64 = judged.iter().map(|ray| ray.1).sum();
    println!("{hits} hits, {displaced} solids with those of another ray within Δ");
    assert!(
        displaced > 10 && 10 * displaced < hits,
        "{displaced} of {hits}"
    );
}
