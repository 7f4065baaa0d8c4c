//! What is right: the oracle's first hit among candidates that are found
//! without Embree, and how far a representation is from it.
//!
//! **Candidates.** A cylinder is in a sphere about its middle, and a line that
//! meets it passes its axis within its radius. Every place's cylinders are
//! tried with both, in f64, where all lengths are lengthened by [`SLACK`] of
//! the numbers they are computed from: the roundings of a ray on its way into a
//! prototype and of the tests are some dozens of 2^-53, times the condition of
//! the placement, which is below 2^10 in scenes that f32 rivals can trace.
//!
//! Candidates are tried in the order in which the ray enters their spheres; the
//! oracle is not asked about those that it enters behind a hit.
//!
//! **Wrong** is a hit for a miss, a miss for a hit, and a hit of another
//! cylinder than the first; where several are first at the same `t`, any. The
//! error of `t` is that of the other hits.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::flat::{Flat, Placed};
use super::rays::{Kind, Rays, TILE};
use super::representation::{Representative, SolidId};
use crate::bench::statistics::p99;
use crate::bench::truth::{Errors, TrueT};
use crate::math::{ChildFromParent, Ray, power_of_two};
use crate::oracle::{TrueHit, first_hit, placed_first_hit};
use crate::solid::Cylinder;

/// By how much tests are made generous.
const SLACK: f64 = power_of_two(-30);

/// A ball around a cylinder or a prototype.
#[derive(Clone, Copy)]
struct Ball {
    centre: DVec3,
    radius: f64,
}

impl Ball {
    fn of(cylinder: &Cylinder) -> Self {
        let (p0, p1) = (cylinder.p0(), cylinder.p1());
        let corner = 0.25 * (p1 - p0).length_squared() + cylinder.radius() * cylinder.radius();
        Self {
            centre: 0.5 * p0 + 0.5 * p1,
            radius: corner.sqrt() * (1.0 + SLACK),
        }
    }

    /// The ball about the middle of the centres that holds them all.
    fn around(balls: &[Self]) -> Self {
        let (lower, upper) = balls.iter().fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(lower, upper), ball| (lower.min(ball.centre), upper.max(ball.centre)),
        );
        let centre = 0.5 * lower + 0.5 * upper;
        let reach = |ball: &Self| (ball.centre - centre).length() + ball.radius;
        Self {
            centre,
            radius: balls.iter().map(reach).fold(0.0, f64::max) * (1.0 + SLACK),
        }
    }
}

/// A ray in one space, with what the tests of it need.
struct Sight {
    origin: DVec3,
    /// Of unit length.
    heading: DVec3,
    /// What one unit of length is in `t`.
    rate: f64,
    t_min: f64,
}

impl Sight {
    fn new(origin: DVec3, direction: DVec3, t_min: f64) -> Self {
        let length = direction.length();
        Self {
            origin,
            heading: direction / length,
            rate: 1.0 / length,
            t_min,
        }
    }

    /// A `t` that is not behind the entry into the ball; `None` if the ray
    /// passes by it.
    fn enters(&self, ball: &Ball) -> Option<f64> {
        let way = ball.centre - self.origin;
        let radius = ball.radius + SLACK * (way.abs().max_element() + ball.radius);
        let along = way.dot(self.heading);
        let aside = (way - self.heading * along).length_squared();
        let is_ahead = (along + radius) * self.rate >= self.t_min;
        (aside <= radius * radius && is_ahead).then_some((along - radius) * self.rate)
    }

    /// Whether the line may pass the axis within the radius.
    fn nears_axis(&self, cylinder: &Cylinder) -> bool {
        let axis = (cylinder.p1() - cylinder.p0()).normalize();
        let x = self.origin - cylinder.p0();
        let across = axis.cross(self.heading);
        let radius = cylinder.radius() + SLACK * (x.length() + cylinder.radius());
        // The sine's own rounding is below the slack as well.
        x.dot(across).abs() <= radius * across.length() + SLACK * x.length()
    }
}

/// The first hit of a ray.
struct First {
    t: TrueT,
    /// The radius of the cylinder where it stands, by the mean scale of its
    /// placement.
    radius: f64,
    /// Those that are first.
    solids: Vec<SolidId>,
}

/// The truth about some rays.
pub struct Judged {
    sample: Vec<Range<usize>>,
    truths: Vec<Option<First>>,
}

/// A scene as the search of candidates needs it.
pub struct Witness<'a> {
    flat: &'a Flat,
    /// Of every prototype: its cylinders' balls, and one around them.
    balls: Vec<(Vec<Ball>, Ball)>,
    ways: Vec<ChildFromParent>,
}

impl<'a> Witness<'a> {
    /// Makes ready to search.
    pub fn new(flat: &'a Flat) -> Self {
        let balls = |prototype: &crate::scene::Prototype| {
            let records = prototype.cylinders.iter();
            let balls: Vec<Ball> = records.map(|one| Ball::of(&one.cylinder())).collect();
            let around = Ball::around(&balls);
            (balls, around)
        };
        Self {
            flat,
            balls: flat.scene.prototypes.iter().map(balls).collect(),
            ways: flat
                .placed
                .iter()
                .map(|placed| ChildFromParent::new(&placed.world_from_object))
                .collect(),
        }
    }

    /// Asks the oracle about `most` rays, by tiles that are spread over all.
    pub fn judge(&self, rays: &Rays, most: usize) -> Judged {
        let sample = sample(rays.wide.len(), most);
        let numbers: Vec<usize> = sample.iter().cloned().flatten().collect();
        let is_any = rays.kind == Kind::Shadow;
        let truths = numbers
            .into_par_iter()
            .map(|number| self.first(&rays.wide[number], is_any))
            .collect();
        Judged { sample, truths }
    }

    /// The first hit, or one hit if any will do.
    fn first(&self, ray: &Ray, is_any: bool) -> Option<First> {
        let mut entered: Vec<(f64, usize, Sight)> = (0..self.flat.placed.len())
            .filter_map(|number| {
                let way = &self.ways[number];
                let origin = way.vector(ray.origin - way.translation());
                let sight = Sight::new(origin, way.vector(ray.direction), ray.t_min);
                let prototype = self.flat.placed[number].prototype.0 as usize;
                let t = sight.enters(&self.balls[prototype].1)?;
                Some((t, number, sight))
            })
            .collect();
        entered.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut first: Option<(TrueHit, First)> = None;
        for (t, number, sight) in entered {
            if is_behind(first.as_ref(), t) {
                break;
            }
            self.search(ray, number, &sight, is_any, &mut first);
            if is_any && first.is_some() {
                break;
            }
        }
        first.map(|(_, first)| first)
    }

    fn search(
        &self,
        ray: &Ray,
        number: usize,
        sight: &Sight,
        is_any: bool,
        first: &mut Option<(TrueHit, First)>,
    ) {
        let placed = &self.flat.placed[number];
        let records = self.flat.cylinders(placed.prototype);
        let balls = &self.balls[placed.prototype.0 as usize].0;
        let mut candidates: Vec<(f64, usize)> = balls
            .iter()
            .enumerate()
            .filter_map(|(index, ball)| Some((sight.enters(ball)?, index)))
            .filter(|&(_, index)| sight.nears_axis(&records.get(index).cylinder()))
            .collect();
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (t, index) in candidates {
            if is_behind(first.as_ref(), t) {
                return;
            }
            let cylinder = records.get(index).cylinder();
            let Some(hit) = self.ask(&cylinder, placed, ray) else {
                continue;
            };
            let solid = SolidId {
                placed: number as u32,
                primitive: records.get(index).primitive(),
            };
            match first {
                Some((known, found)) if hit.t == known.t => found.solids.push(solid),
                Some((known, _)) if hit.t > known.t => {}
                _ => {
                    let found = First {
                        t: TrueT::of(&hit),
                        radius: cylinder.radius() * scale(placed),
                        solids: vec![solid],
                    };
                    *first = Some((hit, found));
                }
            }
            if is_any {
                return;
            }
        }
    }

    fn ask(&self, cylinder: &Cylinder, placed: &Placed, ray: &Ray) -> Option<TrueHit> {
        let truth = if placed.prototype.0 == 0 {
            first_hit(cylinder, ray)
        } else {
            placed_first_hit(cylinder, &placed.exact, ray)
        };
        truth.hit
    }
}

/// Whether nothing from `t` on can be first.
fn is_behind(first: Option<&(TrueHit, First)>, t: f64) -> bool {
    first.is_some_and(|(hit, _)| t > hit.t_f64() * (1.0 + SLACK))
}

/// The factor on lengths, its mean where directions differ.
fn scale(placed: &Placed) -> f64 {
    libm::cbrt(placed.world_from_object.matrix3.determinant().abs())
}

/// At most so many of `count` rays, in whole tiles as far from one another as
/// can be; all rays if they are no more.
fn sample(count: usize, most: usize) -> Vec<Range<usize>> {
    let tiles = count.div_ceil(TILE);
    let wanted = tiles.min(most.div_ceil(TILE));
    (0..wanted)
        .map(|number| {
            let first = number * tiles / wanted * TILE;
            first..(first + TILE).min(count)
        })
        .collect()
}

impl Judged {
    /// How a representation does on these rays.
    pub fn errors(&self, representative: &dyn Representative, rays: &Rays) -> Errors {
        let mut wrong = 0;
        let mut off = Vec::new();
        let tiles = self.sample.iter().cloned();
        if rays.kind == Kind::Shadow {
            let answers = tiles.flat_map(|tile| representative.blocked(rays, tile));
            let pairs = answers.zip(&self.truths);
            wrong = pairs
                .filter(|(answer, truth)| *answer != truth.is_some())
                .count();
        } else {
            let numbers = self.sample.iter().cloned().flatten();
            let answers = tiles.flat_map(|tile| representative.closest(rays, tile));
            for ((number, answer), truth) in numbers.zip(answers).zip(&self.truths) {
                match (answer, truth) {
                    (Some(met), Some(first)) if first.solids.contains(&met.solid) => {
                        let length = rays.wide[number].direction.length();
                        off.push(first.t.off(met.t) * length / first.radius);
                    }
                    (None, None) => {}
                    _ => wrong += 1,
                }
            }
        }
        Errors {
            cases: self.truths.len(),
            wrong,
            p99_r: p99(off),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{DAffine3, DMat3};

    use super::super::ours;
    use super::super::scenes::sticks;
    use super::*;
    use crate::scene::{Placement, Prototype, PrototypeIndex, Scene};
    use crate::tracer::{Options, Tracer};

    const SEED: u64 = 23;

    /// Two levels of placements of sticks, beside one.
    fn placed_sticks() -> Scene {
        let place = |of, x: f64, turn: f64| {
            let (sin, cos) = libm::sincos(turn);
            let across = DVec3::new(cos, sin, 0.0) * 0.7;
            let matrix = DMat3::from_cols(across, DVec3::Z.cross(across), DVec3::Z * 0.7);
            Placement {
                of: PrototypeIndex(of),
                parent_from_child: DAffine3::from_mat3_translation(matrix, DVec3::X * x),
            }
        };
        let of_sticks = |count, placements| Prototype {
            cylinders: sticks(count, SEED).prototypes[0].cylinders.clone(),
            placements,
            ..Prototype::default()
        };
        Scene::new(vec![
            of_sticks(200, vec![place(1, 1.0, 0.3), place(2, -1.0, 1.0)]),
            of_sticks(300, vec![place(2, 0.4, 2.0)]),
            of_sticks(600, Vec::new()),
        ])
    }

    fn ours_of(scene: Scene) -> (Arc<Flat>, Arc<Tracer>, ours::Ours) {
        let flat = Arc::new(Flat::new(Arc::new(scene)));
        let mut modes = ours::modes(&flat, &Options::default()).unwrap();
        let (_, ours, _) = modes.remove(0);
        (flat, Arc::clone(ours.tracer()), ours)
    }

    #[test]
    fn witness_finds_the_tracer_right_with_and_without_placements() {
        for scene in [sticks(500, SEED), placed_sticks()] {
            let (flat, tracer, ours) = ours_of(scene);
            let witness = Witness::new(&flat);
            for rays in Rays::of_scene(&flat, &tracer, 2000, SEED) {
                let judged = witness.judge(&rays, 512);
                let errors = judged.errors(&ours, &rays);
                let name = rays.kind.name();
                assert_eq!(errors.wrong, 0, "{name}");
                assert_eq!(errors.cases, rays.wide.len().min(512), "{name}");
                let hits = judged.truths.iter().flatten().count();
                let share = hits as f64 / errors.cases as f64;
                assert!((0.02..0.98).contains(&share), "{name}: {share} hit");
                let p99 = errors.p99_r;
                assert!(
                    rays.kind == Kind::Shadow || p99.is_some_and(|p99| p99 < 1e-11),
                    "{name}: {p99:?}"
                );
            }
        }
    }

    /// What the library answers about other sticks.
    #[test]
    fn witness_finds_another_scene_wrong() {
        let (flat, tracer, _) = ours_of(sticks(500, SEED));
        let (_, _, other) = ours_of(sticks(500, SEED + 1));
        let witness = Witness::new(&flat);
        for rays in Rays::of_scene(&flat, &tracer, 512, SEED) {
            let errors = witness.judge(&rays, 512).errors(&other, &rays);
            let percent = errors.wrong_percent();
            assert!(percent > 5.0, "{}: {percent}", rays.kind.name());
        }
    }

    #[test]
    fn sample_is_whole_tiles_over_all_rays() {
        assert_eq!(sample(100, 1000).len(), 7);
        assert_eq!(sample(100, 1000)[6], 96..100);
        assert_eq!(sample(1600, 32), [0..16, 800..816]);
        assert!(sample(0, 10).is_empty());
    }
}
