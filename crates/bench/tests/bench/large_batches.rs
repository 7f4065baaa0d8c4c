//! Batches that are large enough to be traced in an order of the tracer's own
//! answer as their rays do one by one.

use std::sync::Arc;

use cyltrace::math::{Random, Ray};
use cyltrace::tracer::{Layout, Options, Tracer};
use cyltrace_bench::traversal::sticks;
use glam::DVec3;

const SEED: u64 = 83;
/// More than 2 MB of records, above which incoherent rays are ordered.
const STICKS: usize = 40_000;

/// A ray from anywhere in the unit cube; one in fifty is odd.
fn ray(number: u64, direction: Option<DVec3>) -> Ray {
    let mut random = Random::new(SEED, number);
    let origin = DVec3::new(random.unit(), random.unit(), random.unit());
    let mut ray = Ray::new(origin, direction.unwrap_or_else(|| random.direction()));
    match random.below(200) {
        0 => ray.origin.x = f64::NAN,
        1 => ray.direction = DVec3::ZERO,
        2 => ray.t_max = 0.01,
        3 => ray.t_min = 0.5,
        _ => {}
    }
    ray
}

fn assert_answers_are_those_of_single_rays(tracer: &Tracer, rays: &[Ray], what: &str) {
    let (mut first, mut hits, mut blocked) = (Vec::new(), Vec::new(), Vec::new());
    tracer.first_hits(rays, &mut first);
    tracer.closest_batch(rays, &mut hits);
    tracer.occluded_batch(rays, &mut blocked);
    assert_eq!([first.len(), hits.len(), blocked.len()], [rays.len(); 3]);
    let mut met = 0;
    for (number, ray) in rays.iter().enumerate() {
        let case = || format!("{what}, seed {SEED}, ray {number}: {ray:?}");
        assert_eq!(first[number], tracer.first_hit(ray), "{}", case());
        assert_eq!(hits[number], tracer.closest(ray), "{}", case());
        assert_eq!(blocked[number], tracer.occluded(ray), "{}", case());
        met += usize::from(blocked[number]);
    }
    assert!(met * 4 > rays.len() && met < rays.len(), "{what}: {met}");
}

#[test]
fn large_batches_answer_as_single_rays() {
    let scene = Arc::new(sticks(STICKS, SEED));
    for layout in [Layout::Single, Layout::Block] {
        let options = Options {
            layout,
            ..Options::default()
        };
        let tracer = Tracer::new(Arc::clone(&scene), &options).unwrap();
        // A group ends within each of these, and an odd number is left over.
        let anywhere: Vec<Ray> = (0..33_333).map(|number| ray(number, None)).collect();
        assert_answers_are_those_of_single_rays(&tracer, &anywhere, "from anywhere to anywhere");
        let sun = Some(DVec3::new(0.3, -0.5, 0.8));
        let to_sun: Vec<Ray> = (0..3_333).map(|number| ray(number, sun)).collect();
        let to_sun: Vec<Ray> = to_sun
            .into_iter()
            .filter(|ray| ray.direction != DVec3::ZERO)
            .collect();
        assert_answers_are_those_of_single_rays(&tracer, &to_sun, "to the sun");
        // The sun's rays first: the groups differ in what they are ordered by.
        let both: Vec<Ray> = to_sun.into_iter().chain(anywhere).take(8_000).collect();
        assert_answers_are_those_of_single_rays(&tracer, &both, "both");
    }
}
