//! Every way to trace a drawn scene gives the same answers, and those of trying every
//! solid.

use cyltrace::math::Ray;
use cyltrace::tracer::{BuildTime, Hit, Layout, Options, Tracer};
use glam::DVec3;

use super::composed::Compositions;
use super::drawn_scene::{DrawnScene, placed_solids};
use super::truth::Truth;

/// The most hits of a ray that are compared.
const MOST_HITS: usize = 512;

/// The most lines that are compared with exact set operations, which are slow.
const MOST_LINES: usize = 6;

/// Traces the scene in every way.
///
/// # Panics
/// When two ways disagree, or an answer is wrong.
pub fn check(drawn: &DrawnScene) {
    let ways = [
        (Layout::Single, BuildTime::WhenReached),
        (Layout::Block, BuildTime::AtOnce),
    ];
    let mut tracers = Vec::new();
    for (layout, build) in ways {
        let options = Options {
            threads: std::num::NonZeroUsize::new(1),
            max_isa: drawn.max_isa,
            layout,
            build,
            exact: drawn.is_exact,
            view: None,
        };
        // Placements that flatten or stretch too much are refused.
        let Ok(tracer) = Tracer::new(drawn.scene.clone(), &options) else {
            return;
        };
        tracers.push(tracer);
    }
    let placed = placed_solids(&drawn.scene);
    let (truth, compositions) = (Truth::new(&placed), Compositions::new(drawn));
    for (number, ray) in drawn.rays.iter().enumerate() {
        let answers = tracers.iter().map(|tracer| single(tracer, ray));
        let answers: Vec<Vec<Hit>> = answers.collect();
        assert_eq!(answers[0], answers[1], "layouts differ, {ray:?} {drawn:#?}");
        let line = Ray {
            t_min: f64::NEG_INFINITY,
            t_max: f64::INFINITY,
            ..*ray
        };
        let of_line = single(&tracers[0], &line);
        if of_line.len() < MOST_HITS {
            assert_in_range(ray, &answers[0], &of_line);
        }
        truth.judge(&line, &of_line, drawn);
        if number < MOST_LINES {
            compositions.judge(&line, &of_line);
        }
    }
    for tracer in &tracers {
        batch(tracer, drawn);
        for point in points(drawn, tracer) {
            let found = tracer.contains(point);
            let expected = tracer.contains_exhaustive(point);
            assert_eq!(found, expected, "contains {point:?} {drawn:#?}");
            truth.judge_point(point, &found, drawn);
            compositions.judge_point(point, &found);
        }
    }
}

/// All hits of a ray, the same by every query of a single ray.
fn single(tracer: &Tracer, ray: &Ray) -> Vec<Hit> {
    let all: Vec<Hit> = tracer.all_hits(ray, 32).take(MOST_HITS).collect();
    for batch in [1, 3] {
        let again: Vec<Hit> = tracer.all_hits(ray, batch).take(MOST_HITS).collect();
        assert_eq!(again, all, "all hits, {batch} at a time, {ray:?}");
    }
    let closest = tracer.closest(ray);
    let expected = tracer.closest_exhaustive(ray);
    assert_eq!(closest, expected, "closest, {ray:?} {:#?}", tracer.scene());
    assert_eq!(
        all.first(),
        closest.as_ref(),
        "first of all hits, {ray:?} {:#?}",
        tracer.scene()
    );
    assert_eq!(
        tracer.occluded(ray),
        closest.is_some(),
        "occluded, {ray:?} {:#?}",
        tracer.scene()
    );
    for hit in &all {
        assert!(
            ray.t_min <= hit.t && hit.t <= ray.t_max,
            "out of range: {hit:?}, {ray:?}"
        );
        let numbers = [hit.t, hit.error, hit.u, hit.v, hit.normal.length()];
        let finite = numbers.iter().all(|number| number.is_finite()) && hit.point.is_finite();
        assert!(finite, "not finite: {hit:?}, {ray:?}");
    }
    let place = |hit: &Hit| (hit.instance.clone(), hit.primitive);
    let is_sorted = all
        .is_sorted_by(|one, next| one.t < next.t || (one.t == next.t && place(one) <= place(next)));
    assert!(is_sorted, "not in order: {ray:?}");
    all
}

/// The hits of a ray are those of its line in the ray's range, but that a ray that starts
/// within a surface hits it there.
fn assert_in_range(ray: &Ray, hits: &[Hit], of_line: &[Hit]) {
    let is_in_range = |hit: &&Hit| ray.t_min <= hit.t && hit.t <= ray.t_max;
    let expected: Vec<&Hit> = of_line.iter().filter(is_in_range).collect();
    let is_start = |hit: &&Hit| hit.t == ray.t_min && !expected.contains(hit);
    let found: Vec<&Hit> = hits.iter().filter(|hit| !is_start(hit)).collect();
    assert_eq!(found, expected, "range of {ray:?}");
}

/// Batches answer as single rays do.
fn batch(tracer: &Tracer, drawn: &DrawnScene) {
    let (mut closest, mut blocked, mut first) = (Vec::new(), Vec::new(), Vec::new());
    tracer.closest_batch(&drawn.rays, &mut closest);
    tracer.occluded_batch(&drawn.rays, &mut blocked);
    tracer.first_hits(&drawn.rays, &mut first);
    for (number, ray) in drawn.rays.iter().enumerate() {
        let expected = tracer.closest(ray);
        assert_eq!(closest[number], expected, "in a batch, {ray:?} {drawn:#?}");
        assert_eq!(
            first[number],
            tracer.first_hit(ray),
            "in a batch, {ray:?} {drawn:#?}"
        );
        assert_eq!(
            blocked[number],
            expected.is_some(),
            "in a batch, {ray:?} {drawn:#?}"
        );
    }
}

/// The drawn points, and those of hits.
fn points(drawn: &DrawnScene, tracer: &Tracer) -> Vec<DVec3> {
    let hits = drawn.rays.iter().filter_map(|ray| tracer.closest(ray));
    let hits = hits.map(|hit| hit.point).take(4);
    drawn.points.iter().copied().chain(hits).collect()
}
