//! The comparison: every representation beside this library's fastest mode.
//!
//! This library's modes are timed in turns first. Then rivals come one after
//! the other, each built alone beside this library and gone before the next:
//! with each the fastest mode is timed anew, in turns, and what is compared is
//! compared between neighbouring measurements. A rival gets the rays in either
//! order (`order`), each in turns with this library, and the better one counts.

use std::sync::Arc;
use std::time::Instant;

use super::building::build;
use super::flat::Flat;
use super::interleave::{Sample, Times, Workers, interleave};
use super::order::{Order, sorted};
use super::ours;
use super::outcome::{Figures, Row, Traversal};
use super::plan::Plan;
use super::rays::{Kind, Rays};
use super::representation::{Representation, Representative};
use super::scenes::SceneName;
use super::witness::{Judged, Witness};
use crate::statistics::Spread;
use crate::timing::Timer;
use cyltrace::tracer::counters::Counts;

impl Traversal {
    /// How often [`Traversal::measure`] calls `after_step`.
    #[must_use]
    pub fn steps(plan: &Plan) -> usize {
        plan.scenes.len() * plan.representations().count()
    }

    /// Measures everything; `after_step` is called as often as
    /// [`Traversal::steps`] says.
    #[must_use]
    pub fn measure(plan: &Plan, timer: &mut dyn Timer, after_step: &mut dyn FnMut()) -> Self {
        let mut rows = Vec::new();
        for &scene in &plan.scenes {
            let mut course = Course::new(plan, scene);
            match prepare(plan, scene) {
                Ok(field) => course.run(&field, timer, after_step),
                Err(reason) => {
                    for representation in plan.representations() {
                        course.absent(representation, &reason);
                        after_step();
                    }
                }
            }
            rows.append(&mut course.sorted());
        }
        Self {
            scenes: plan.scenes.clone(),
            threads: plan
                .worker_sets
                .iter()
                .map(|workers| workers.threads)
                .collect(),
            rows,
        }
    }
}

/// A scene, this library's modes on it, rays and their true answers.
struct Field {
    flat: Arc<Flat>,
    ours: Vec<(Representation, Arc<dyn Representative>, f64)>,
    rays: Vec<Asked>,
}

/// Rays of one kind and their true answers.
struct Asked {
    rays: Rays,
    /// The same rays in the order of this library's batches, where it is another one.
    sorted: Option<Rays>,
    judged: Judged,
}

fn prepare(plan: &Plan, scene: SceneName) -> Result<Field, String> {
    let description = scene.make(&plan.directory, plan.seed)?;
    let flat = Arc::new(Flat::new(Arc::new(description)));
    if flat.has_compositions() {
        return Err(String::from(
            "the scene has set operations, which no rival represents",
        ));
    }
    let modes = ours::modes(&flat, &plan.options).map_err(|error| error.to_string())?;
    let tracer = Arc::clone(modes[0].1.tracer());
    let rays = Rays::of_scene(&flat, &tracer, plan.rays, plan.seed);
    let witness = Witness::new(&flat);
    let judge = |rays: Rays| Asked {
        sorted: sorted(&rays, &tracer),
        judged: witness.judge(&rays, scene.judged()),
        rays,
    };
    let rays = rays.into_iter().map(judge).collect();
    let shared = |(mode, ours, build_s)| {
        let ours: Arc<dyn Representative> = Arc::new(ours);
        (Representation::Ours(mode), ours, build_s)
    };
    drop(witness);
    Ok(Field {
        flat,
        ours: modes.into_iter().map(shared).collect(),
        rays,
    })
}

/// The rows of one scene as they come in.
struct Course<'a> {
    plan: &'a Plan,
    scene: SceneName,
    rows: Vec<Row>,
}

impl<'a> Course<'a> {
    fn new(plan: &'a Plan, scene: SceneName) -> Self {
        Self {
            plan,
            scene,
            rows: Vec::new(),
        }
    }

    fn sorted(mut self) -> Vec<Row> {
        let place = |row: &Row| {
            let rays = Kind::ALL.iter().position(|&one| one == row.rays);
            let all = &Representation::ALL;
            (rays, all.iter().position(|&one| one == row.representation))
        };
        self.rows.sort_by_key(place);
        self.rows
    }

    fn push(
        &mut self,
        rays: Kind,
        representation: Representation,
        threads: usize,
        found: Result<Figures, String>,
    ) {
        self.rows.push(Row {
            scene: self.scene,
            rays,
            representation,
            threads,
            found,
        });
    }

    fn absent(&mut self, representation: Representation, reason: &str) {
        let plan = self.plan;
        for rays in Kind::ALL {
            for workers in &plan.worker_sets {
                self.push(
                    rays,
                    representation,
                    workers.threads,
                    Err(reason.to_owned()),
                );
            }
        }
    }

    fn run(&mut self, field: &Field, timer: &mut dyn Timer, after_step: &mut dyn FnMut()) {
        let fastest = self.run_ours(field, timer);
        for representation in self.plan.representations() {
            let Representation::Embree { shape, in_packets } = representation else {
                after_step();
                continue;
            };
            let start = Instant::now();
            match build(self.plan, &field.flat, shape, in_packets) {
                Ok(rival) => {
                    let build_s = start.elapsed().as_secs_f64();
                    self.run_rival(field, &fastest, representation, &rival, build_s, timer);
                }
                Err(reason) => self.absent(representation, &reason),
            }
            after_step();
        }
    }

    /// Times this library's modes and returns the fastest by rays and workers.
    fn run_ours(&mut self, field: &Field, timer: &mut dyn Timer) -> Vec<Vec<usize>> {
        let plan = self.plan;
        let mut fastest = Vec::new();
        for asked in &field.rays {
            let rays = &asked.rays;
            let mut by_workers = Vec::new();
            for workers in &plan.worker_sets {
                let samples: Vec<Sample<'_>> = field
                    .ours
                    .iter()
                    .map(|(_, ours, _)| sample(ours.as_ref(), rays, workers))
                    .collect();
                let times = interleave(timer, &samples, plan.rounds);
                let seconds: Vec<Spread> = times.iter().map(Times::sample).collect();
                let order =
                    |a: &usize, b: &usize| seconds[*a].median.total_cmp(&seconds[*b].median);
                by_workers.push((0..seconds.len()).min_by(order).unwrap_or(0));
                for ((mode, ours, build_s), &sample_s) in field.ours.iter().zip(&seconds) {
                    let entry = Entry {
                        representative: ours,
                        build_s: *build_s,
                        counts: ours.counts(rays),
                        sample_s,
                        order: Order::Given,
                        ratio: None,
                    };
                    let found = figures(field, asked, entry);
                    self.push(rays.kind, *mode, workers.threads, found);
                }
            }
            fastest.push(by_workers);
        }
        fastest
    }

    fn run_rival(
        &mut self,
        field: &Field,
        fastest: &[Vec<usize>],
        representation: Representation,
        rival: &Arc<dyn Representative>,
        build_s: f64,
        timer: &mut dyn Timer,
    ) {
        let plan = self.plan;
        for (asked, fastest) in field.rays.iter().zip(fastest) {
            for (workers, &fastest) in plan.worker_sets.iter().zip(fastest) {
                let (mode, ours, _) = &field.ours[fastest];
                let mut compare = |rays| {
                    let samples = [
                        sample(ours.as_ref(), &asked.rays, workers),
                        sample(rival.as_ref(), rays, workers),
                    ];
                    let times = interleave(timer, &samples, plan.rounds);
                    (times[1].sample(), times[1].over(&times[0]))
                };
                let mut order = Order::Given;
                let (mut sample_s, mut ratio) = compare(&asked.rays);
                if let Some(rays) = &asked.sorted {
                    let (sorted_s, sorted_ratio) = compare(rays);
                    if sorted_ratio.median < ratio.median {
                        (order, sample_s, ratio) = (Order::Sorted, sorted_s, sorted_ratio);
                    }
                }
                let entry = Entry {
                    representative: rival,
                    build_s,
                    counts: None,
                    sample_s,
                    order,
                    ratio: Some((ratio, *mode)),
                };
                let found = figures(field, asked, entry);
                self.push(asked.rays.kind, representation, workers.threads, found);
            }
        }
    }
}

fn sample<'a>(
    representative: &'a dyn Representative,
    rays: &'a Rays,
    workers: &'a Workers,
) -> Sample<'a> {
    Sample {
        workers,
        count: rays.wide.len(),
        run: Box::new(|range| representative.run(rays, range)),
    }
}

/// What was measured of a representation on some rays.
struct Entry<'a> {
    representative: &'a Arc<dyn Representative>,
    build_s: f64,
    counts: Option<Counts>,
    sample_s: Spread,
    order: Order,
    ratio: Option<(Spread, Representation)>,
}

fn figures(field: &Field, asked: &Asked, entry: Entry<'_>) -> Result<Figures, String> {
    let Asked { rays, judged, .. } = asked;
    let count = rays.wide.len();
    if count == 0 {
        return Err(String::from("no camera ray hits the scene"));
    }
    let per_ray = |of: fn(&Counts) -> u64| Some(of(entry.counts.as_ref()?) as f64 / count as f64);
    let errors = judged.errors(entry.representative.as_ref(), rays);
    Ok(Figures {
        ns: Spread {
            median: entry.sample_s.median * 1e9 / count as f64,
            deviation: entry.sample_s.deviation * 1e9 / count as f64,
        },
        wrong_percent: errors.wrong_percent(),
        p99_error_r: errors.p99_r,
        bytes_per_cylinder: entry.representative.bytes() as f64 / field.flat.stored() as f64,
        build_s: entry.build_s,
        callbacks_per_ray: per_ray(|counts| counts.callbacks),
        solves_per_ray: per_ray(|counts| counts.solves),
        order: entry.order,
        ratio: entry.ratio,
    })
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::super::building::BYTES_PER_PRIMITIVE;
    use super::*;
    use cyltrace::solid::SolidKind;
    use cyltrace::tracer::Options;

    /// A clock on which everything takes a second.
    struct Even;

    impl Timer for Even {
        fn seconds(&mut self, work: &mut dyn FnMut()) -> f64 {
            work();
            1.0
        }
    }

    #[test]
    fn measure_rows_are_complete_and_what_does_not_fit_has_its_reason() {
        let plan = Plan {
            scenes: vec![SceneName::Sticks1e4, SceneName::Forest],
            directory: PathBuf::from("nowhere"),
            rays: 100,
            rounds: 1,
            seed: 4,
            rivals: Representation::ALL.to_vec(),
            worker_sets: vec![Workers::new(1).unwrap(), Workers::new(2).unwrap()],
            // Room for 32 triangles a cylinder, not for 64.
            max_memory: 48 * 10_000 * BYTES_PER_PRIMITIVE,
            options: Options::default(),
        };
        let represents_cylinders = |one: Representation| {
            let shape = one.shape();
            shape.is_none_or(|shape| shape.represents(SolidKind::Cylinder))
        };
        let mut steps = 0;
        let found = Traversal::measure(&plan, &mut Even, &mut || steps += 1);
        assert_eq!(steps, Traversal::steps(&plan));
        assert_eq!(found.rows.len(), 2 * 3 * Representation::ALL.len() * 2);
        for row in &found.rows {
            let name = row.representation.to_string();
            match (&row.found, row.scene) {
                (Err(reason), SceneName::Forest) => assert!(reason.contains("does not exist")),
                (Err(reason), _) if ["mesh_16", "mesh_32", "mesh_64"].contains(&name.as_str()) => {
                    assert!(reason.contains("more than the"), "{name}: {reason}");
                }
                (Err(reason), _) if !represents_cylinders(row.representation) => {
                    assert!(reason.contains("of the kind cylinder"), "{name}: {reason}");
                }
                (Err(reason), _) => panic!("{name}: {reason}"),
                (Ok(figures), _) => {
                    assert!(figures.bytes_per_cylinder > 30.0, "{name}");
                    let is_ours = row.representation.is_ours();
                    assert!(!is_ours || figures.wrong_percent == 0.0, "{name}");
                    let ratio = figures.ratio.map(|(spread, _)| spread.median);
                    assert_eq!(ratio.unwrap_or(1.0), 1.0);
                    assert_eq!(ratio.is_none(), row.representation.is_ours());
                }
            }
        }
    }
}
