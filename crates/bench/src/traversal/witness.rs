//! What is right: the oracle's first hit among candidates that are found
//! without Embree, and how far a representation is from it.
//!
//! **Candidates.** Every place's solids are tried with what `sight.rs` knows of a ray
//! and a solid: their balls, and their axes where they have any. Those that are left
//! are tried in the order in which the ray enters their balls; the oracle is not asked
//! about those that it enters behind a hit.
//!
//! **Wrong** is a hit for a miss, a miss for a hit, and a hit of another
//! solid than the first; where several are first at the same `t`, any. The
//! error of `t` is that of the other hits.

use std::ops::Range;

use rayon::prelude::*;

use super::candidate_filter::{Ball, SLACK, Sight};
use super::flat::{Flat, Placed};
use super::rays::{Kind, Rays, TILE};
use super::representation::{Representative, SolidId};
use crate::statistics::p99;
use crate::truth::{Errors, TrueT};
use cyltrace::math::{ChildFromParent, Ray};
use cyltrace::scene::Prototype;
use cyltrace::solid::AnySolid;
use cyltrace_oracle::{TrueHit, first_hit_of_any, placed_hits_of_any};

/// The first hit of a ray.
struct First {
    t: TrueT,
    /// The radius of the placed solid ([`AnySolid::radius`]), by the mean scale
    /// of its placement.
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
    /// Of every prototype: its solids' numbers and balls, and one around them.
    balls: Vec<(Vec<(u32, Ball)>, Ball)>,
    ways: Vec<ChildFromParent>,
}

impl<'a> Witness<'a> {
    /// Makes ready to search.
    pub fn new(flat: &'a Flat) -> Self {
        let balls = |prototype: &Prototype| {
            let solids = prototype.singles();
            let balls: Vec<(u32, Ball)> = solids
                .map(|(primitive, solid)| (primitive, Ball::of(&solid)))
                .collect();
            let around = Ball::around(balls.iter().map(|&(_, ball)| ball));
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
        let prototype = self.flat.prototype(placed.prototype);
        let balls = &self.balls[placed.prototype.0 as usize].0;
        let mut candidates: Vec<(f64, u32, AnySolid)> = balls
            .iter()
            .filter_map(|(primitive, ball)| {
                let t = sight.enters(ball)?;
                Some((t, *primitive, prototype.single(*primitive)?))
            })
            .filter(|(_, _, solid)| sight.nears_axis(solid))
            .collect();
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (t, primitive, solid) in candidates {
            if is_behind(first.as_ref(), t) {
                return;
            }
            let Some(hit) = ask(&solid, placed, ray) else {
                continue;
            };
            let id = SolidId {
                placed: number as u32,
                primitive,
            };
            match first {
                Some((known, found)) if hit.t == known.t => found.solids.push(id),
                Some((known, _)) if hit.t > known.t => {}
                _ => {
                    let found = First {
                        t: TrueT::of(&hit),
                        radius: solid.radius() * scale(placed),
                        solids: vec![id],
                    };
                    *first = Some((hit, found));
                }
            }
            if is_any {
                return;
            }
        }
    }
}

fn ask(solid: &AnySolid, placed: &Placed, ray: &Ray) -> Option<TrueHit> {
    if placed.prototype.0 == 0 {
        first_hit_of_any(solid, ray)
    } else {
        let hits = placed_hits_of_any(solid, &placed.exact, ray);
        hits.into_iter().next()
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

    use glam::{DAffine3, DMat3, DVec3};

    use super::super::ours;
    use super::super::random_scene::{random_scene, sticks};
    use super::*;
    use cyltrace::scene::{Placement, PrototypeIndex, Scene, Solids};
    use cyltrace::solid::SolidKind;
    use cyltrace::tracer::{Options, Tracer};

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
            solids: Solids::of_cylinders(&sticks(count, SEED).prototypes[0].solids.cylinders),
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
        let [(_, ours, _), ..] = ours::modes(&flat, &Options::default()).unwrap();
        (flat, Arc::clone(ours.tracer()), ours)
    }

    const OTHER_KINDS: [SolidKind; 5] = [
        SolidKind::Cone,
        SolidKind::RoundedCone,
        SolidKind::Sphere,
        SolidKind::Cuboid,
        SolidKind::Disk,
    ];

    /// The sticks of placed prototypes as solids of another kind, beside the root's.
    fn placed_others(kind: SolidKind) -> Scene {
        let mut scene = placed_sticks();
        for prototype in &mut scene.prototypes[1..] {
            let count = prototype.solids.cylinders.len();
            prototype.solids = random_scene(kind, count, SEED).prototypes[0].solids.clone();
        }
        scene
    }

    #[test]
    fn witness_finds_the_tracer_right_with_and_without_placements() {
        let others = OTHER_KINDS
            .into_iter()
            .flat_map(|kind| [random_scene(kind, 500, SEED), placed_others(kind)]);
        for scene in [sticks(500, SEED), placed_sticks()]
            .into_iter()
            .chain(others)
        {
            let (flat, tracer, ours) = ours_of(scene);
            let witness = Witness::new(&flat);
            for rays in Rays::of_scene(&flat, &tracer, 2000, SEED) {
                let judged = witness.judge(&rays, 512);
                let errors = judged.errors(&ours, &rays);
                let name = format!("{} of {:?}", rays.kind.name(), flat.kinds());
                assert_eq!(errors.wrong, 0, "{name}");
                assert_eq!(errors.cases, rays.wide.len().min(512), "{name}");
                let hits = judged.truths.iter().flatten().count();
                let share = hits as f64 / errors.cases as f64;
                // A camera may see nothing but solids.
                let most = if rays.kind == Kind::Coherent {
                    1.0
                } else {
                    0.98
                };
                assert!((0.02..=most).contains(&share), "{name}: {share} hit");
                let p99 = errors.p99_r;
                assert!(
                    rays.kind == Kind::Shadow || p99.is_some_and(|p99| p99 < 1e-11),
                    "{name}: {p99:?}"
                );
            }
        }
    }

    /// What the library answers about other sticks, or other solids of a kind.
    #[test]
    fn witness_finds_another_scene_wrong() {
        let others =
            OTHER_KINDS.map(|kind| [0, 1].map(|more| random_scene(kind, 500, SEED + more)));
        let sticks = [0, 1].map(|more| sticks(500, SEED + more));
        for [scene, other] in others.into_iter().chain([sticks]) {
            let (flat, tracer, _) = ours_of(scene);
            let (_, _, other) = ours_of(other);
            let witness = Witness::new(&flat);
            for rays in Rays::of_scene(&flat, &tracer, 512, SEED) {
                let errors = witness.judge(&rays, 512).errors(&other, &rays);
                let (name, percent) = (rays.kind.name(), errors.wrong_percent());
                assert!(percent > 5.0, "{name} of {:?}: {percent}", flat.kinds());
            }
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
