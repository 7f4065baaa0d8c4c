//! One ray again, with all that is known about it.

use cyltrace::embree::{Device, Ray32};
use cyltrace::math::Ray;
use cyltrace::scene::Scene;

use super::plan::chosen_windows;
use super::subject::Subject;
use crate::bounding_meshes::mesh_frame::MeshFrame;
use crate::bounding_meshes::meshes::Meshes;
use crate::outcome::{Expected, Row, Violation, Witness};
use crate::replay::Replay;
use crate::report::words::{
    answer_text, instance_text, interval_text, ray_text, truth_text, wrong_text,
};
use crate::reported_hit::{Intersector, ReportedHit};
use crate::settings::{CheckError, Class, Settings};
use crate::verdict::answer::{Verdict, verdict};
use crate::verdict::judge::first;
use crate::verdict::seen::Scratch;
use crate::verdict::truth;

/// What is known about one ray.
#[derive(Clone, Debug, Default)]
pub struct Replayed {
    /// The ray, its answer, the bounds of each solid and the oracle's answer, in sentences.
    pub lines: Vec<String>,
    /// What is wrong, by segments.
    pub violations: Vec<Violation>,
}

/// Traces one ray and reports everything about it; `settings` are those of the
/// check that it comes from.
///
/// # Errors
/// As [`compare`](crate::compare).
pub fn replay(
    scene: &Scene,
    intersector: &impl Intersector,
    settings: &Settings,
    which: &Replay,
) -> Result<Replayed, CheckError> {
    let windows = chosen_windows(scene, settings)?;
    let device = Device::new(&settings.device)?;
    let mut replayed = Replayed::default();
    let count = windows.len() as u64;
    for (number, window) in (0..).zip(&windows) {
        let frame = MeshFrame::new(window);
        let subject = Subject::new(scene, (number, window), &frame, settings.seed);
        let source = &subject.source;
        let rays = match which {
            Replay::Drawn { class, index } => {
                (index % count == number).then(|| source.ray(*class, *index))
            }
            Replay::Given(ray) => source
                .exact_ray(ray.origin, ray.direction)
                .and_then(|rays| within(rays, ray)),
        };
        let Some((ray32, ray)) = rays else {
            continue;
        };
        let answer = intersector.closest(&ray);
        let answer = answer.as_ref();
        replayed.describe(which, &subject, &ray, answer);
        replayed.judge_by_oracle(which, &subject, &ray, answer);
        for &segments in &settings.segments {
            let meshes = Meshes::new(&device, window, &frame, segments)?;
            replayed.judge_by_meshes(which, &subject, &meshes, (&ray32, &ray), answer);
        }
    }
    if replayed.lines.is_empty() {
        let line = String::from("the ray does not enter any part of the scene that is checked");
        replayed.lines.push(line);
    }
    Ok(replayed)
}

/// The ray of the meshes with no more of its range than what was given.
fn within((mut ray32, mut ray): (Ray32, Ray), given: &Ray) -> Option<(Ray32, Ray)> {
    ray32.t_near = ray32.t_near.max(given.t_min as f32);
    ray32.t_far = ray32.t_far.min(given.t_max as f32);
    ray.t_min = f64::from(ray32.t_near);
    ray.t_max = f64::from(ray32.t_far);
    ray.is_valid().then_some((ray32, ray))
}

impl Replayed {
    fn describe(
        &mut self,
        which: &Replay,
        subject: &Subject,
        ray: &Ray,
        answer: Option<&ReportedHit>,
    ) {
        let lines = &mut self.lines;
        lines.push(format!("ray {}", Replay::Given(*ray)));
        lines.push(format!("    {}", ray_text(ray)));
        if let Replay::Given(given) = which
            && given != ray
        {
            let moved = given.origin.distance(ray.origin);
            lines.push(format!(
                "    the nearest ray that f32 represents; its origin moved by {moved:e}"
            ));
        }
        lines.push(format!("answer: {}", answer_text(answer)));
        let truth = truth::first_hit(subject.window, ray);
        lines.push(truth_text(subject.window, truth));
    }

    fn judge_by_oracle(
        &mut self,
        which: &Replay,
        subject: &Subject,
        ray: &Ray,
        answer: Option<&ReportedHit>,
    ) {
        let Some(bounds) = truth::bounds(subject.window, ray) else {
            return;
        };
        let (low, high) = (bounds.low, bounds.high);
        self.lines.push(format!(
            "    with the solids displaced by the rounding of f64: {}",
            interval_text(low, high)
        ));
        if !bounds.allows(answer.map(|hit| hit.t), ray.t_max) {
            let reason = truth_text(subject.window, truth::first_hit(subject.window, ray));
            let expected = Expected::Between { low, high, reason };
            self.list(which, (Witness::Oracle, None), ray, answer, expected);
        }
    }

    fn judge_by_meshes(
        &mut self,
        which: &Replay,
        subject: &Subject,
        meshes: &Meshes,
        rays: (&Ray32, &Ray),
        answer: Option<&ReportedHit>,
    ) {
        let mut scratch = Scratch::default();
        let verdict = verdict(&subject.directory, meshes, rays, answer, &mut scratch);
        let bounds = first(&scratch.seen);
        self.lines.push(format!(
            "{} sides: {}",
            meshes.segments,
            interval_text(bounds.low, bounds.high)
        ));
        for seen in &scratch.seen {
            let solid = &subject.window.solids[seen.solid as usize];
            let interval = seen.bounds.interval;
            self.lines.push(format!(
                "    {} {} of {}: {}",
                subject.window.kind(seen.solid).name(),
                solid.primitive,
                instance_text(&solid.frame.instance),
                interval_text(interval.low, interval.high)
            ));
        }
        let line = match &verdict {
            Verdict::Unwitnessed => String::from("unwitnessed"),
            Verdict::Right { is_cleared, .. } if *is_cleared => {
                String::from("right, by exact arithmetic: an error of Embree's triangle test")
            }
            Verdict::Right { .. } => String::from("right"),
            Verdict::Wrong(wrong) => format!("WRONG: {}", wrong_text(wrong)),
        };
        self.lines.push(format!("    {line}"));
        if let Verdict::Wrong(wrong) = verdict {
            let (low, high) = wrong.allowed();
            let reason = wrong_text(&wrong);
            let expected = Expected::Between { low, high, reason };
            let witness = (Witness::Prisms, Some(meshes.segments));
            self.list(which, witness, rays.1, answer, expected);
        }
    }

    /// Lists a wrong answer. A given ray has no class of its own and counts as the first of
    /// the camera's.
    fn list(
        &mut self,
        which: &Replay,
        (witness, segments): (Witness, Option<u32>),
        ray: &Ray,
        answer: Option<&ReportedHit>,
        expected: Expected,
    ) {
        let (class, index) = match which {
            Replay::Drawn { class, index } => (*class, *index),
            Replay::Given(_) => (Class::Camera, 0),
        };
        let row = Row::new(class.name(), witness, segments);
        let t = answer.map(|hit| hit.t);
        self.violations
            .push(Violation::new(&row, index, *ray, t, expected));
    }
}
