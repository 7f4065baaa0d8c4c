//! Many rays of every class against both meshes, and a few against the oracle.
//!
//! Every number of sides and every class get the same rays: the windows of the
//! scene take turns, ray `i` belongs to window `i mod windows`.

use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicU64, Ordering};

use cyltrace::embree::{Device, Ray32};
use cyltrace::math::Ray;
use cyltrace::scene::Scene;

use super::plan::chosen_windows;
use super::subject::Subject;
use crate::bounding_meshes::mesh_frame::MeshFrame;
use crate::bounding_meshes::meshes::Meshes;
use crate::outcome::{Expected, Outcome, Row, Violation};
use crate::partial_outcome::{PartialOutcome, WindowOutcome, rows};
use crate::report::words::{truth_text, window_text, wrong_text};
use crate::reported_hit::{Intersector, ReportedHit};
use crate::settings::{CheckError, Class, Settings};
use crate::tally::{Progress, Tally, in_blocks};
use crate::verdict::answer::{Verdict, verdict};
use crate::verdict::judge::solid_of;
use crate::verdict::seen::{Scratch, Seen};
use crate::verdict::surface::LocalRay;
use crate::verdict::truth;

/// One ray in this many goes to the oracle, which takes some milliseconds.
const RAYS_A_TRUTH: u64 = 1000;

/// Rays that go to the oracle at a time.
const TRUTHS: u64 = 8;

/// Checks an intersector of a scene.
///
/// # Errors
/// If the settings are wrong, the scene is empty, or Embree fails.
pub fn compare(
    scene: &Scene,
    intersector: &impl Intersector,
    settings: &Settings,
) -> Result<Outcome, CheckError> {
    let go_on = |_, _| ControlFlow::Continue(());
    compare_with(scene, intersector, settings, &go_on)
}

/// As [`compare`], with progress.
///
/// # Errors
/// As [`compare`], and [`CheckError::Interrupted`] if `progress` breaks off.
pub fn compare_with(
    scene: &Scene,
    intersector: &impl Intersector,
    settings: &Settings,
    progress: &Progress,
) -> Result<Outcome, CheckError> {
    let all = 0..settings.rays;
    let outcome = compare_rays(scene, intersector, settings, all, progress)?;
    Ok(Outcome::of_parts(settings, [outcome]))
}

/// As [`compare_with`], only the rays of each class with the numbers `rays`. The outcomes of
/// ranges that follow one another make up that of all rays, [`Outcome::of_parts`].
///
/// # Errors
/// As [`compare_with`].
///
/// # Panics
/// If the range is not within `0..settings.rays`.
pub fn compare_rays(
    scene: &Scene,
    intersector: &impl Intersector,
    settings: &Settings,
    rays: Range<u64>,
    progress: &Progress,
) -> Result<PartialOutcome, CheckError> {
    let is_within = rays.start <= rays.end && rays.end <= settings.rays;
    assert!(is_within, "rays {rays:?} of {}", settings.rays);
    let windows = chosen_windows(scene, settings)?;
    let classes = settings.classes.len() as u64;
    let run = Run {
        intersector,
        settings,
        windows: windows.len() as u64,
        device: Device::new(&settings.device)?,
        total: settings.segments.len() as u64 * (rays.end - rays.start) * classes,
        rays,
        done: AtomicU64::new(0),
        progress,
    };
    let mut outcome = PartialOutcome::default();
    for window in (0..).zip(&windows) {
        let frame = MeshFrame::new(window.1);
        let subject = Subject::new(scene, window, &frame, settings.seed);
        let mut tallies: Vec<Tally> = rows(settings).map(Tally::new).collect();
        let text = run.window(&subject, &mut tallies)?;
        outcome.windows.push(WindowOutcome { text, tallies });
    }
    Ok(outcome)
}

/// What is the same for all windows.
struct Run<'a, I> {
    intersector: &'a I,
    settings: &'a Settings,
    windows: u64,
    device: Device,
    /// The numbers of the rays of each class.
    rays: Range<u64>,
    total: u64,
    done: AtomicU64,
    progress: &'a Progress<'a>,
}

impl<I: Intersector> Run<'_, I> {
    /// Adds the rays of one window to all rows, and describes the window.
    fn window(&self, subject: &Subject, tallies: &mut [Tally]) -> Result<String, CheckError> {
        let classes = self.settings.classes.len();
        let mut missing = Vec::new();
        let (meshed, oracle) = tallies.split_at_mut(classes * self.settings.segments.len());
        for (&segments, rows) in self
            .settings
            .segments
            .iter()
            .zip(meshed.chunks_mut(classes))
        {
            if self.advance(0).is_break() {
                return Err(CheckError::Interrupted);
            }
            let meshes = Meshes::new(&self.device, subject.window, subject.frame, segments)?;
            missing.push((segments, meshes.missing()));
            for (&class, row) in self.settings.classes.iter().zip(rows) {
                let block = self.intersector.batch().max(1);
                self.trace(subject, row, block, |range, scratch, tally| {
                    for shot in self.shoot(subject, class, range) {
                        self.judge_by_meshes(subject, &meshes, &shot, scratch, tally);
                    }
                })?;
            }
        }
        for (&class, row) in self.settings.classes.iter().zip(oracle) {
            self.trace(subject, row, TRUTHS * RAYS_A_TRUTH, |range, (), tally| {
                let first = range.start.next_multiple_of(RAYS_A_TRUTH);
                let numbers = (first..range.end).step_by(RAYS_A_TRUTH as usize);
                for shot in self.shoot(subject, class, numbers) {
                    self.judge_by_oracle(subject, &shot, tally);
                }
            })?;
        }
        let (window, number) = (subject.window, subject.number);
        Ok(window_text(window, number, self.windows, &missing))
    }

    /// Adds the rays of a window to a row. `block` gets ranges of the window's own count: its
    /// ray `i` is ray `i * windows + window` of the class.
    fn trace<S: Default>(
        &self,
        subject: &Subject,
        row: &mut Tally,
        block_size: u64,
        block: impl Fn(Range<u64>, &mut S, &mut Tally) + Sync,
    ) -> Result<(), CheckError> {
        let before = |ray: u64| (ray + self.windows - 1 - subject.number) / self.windows;
        let range = before(self.rays.start)..before(self.rays.end);
        let most_listed = self.settings.most_listed;
        let empty = Row::new(row.row.class, row.row.witness, row.row.segments);
        let progress = |rays| self.advance(rays);
        let tally = in_blocks(&empty, (range, block_size), most_listed, progress, block);
        row.add(tally.ok_or(CheckError::Interrupted)?, most_listed);
        Ok(())
    }

    fn advance(&self, rays: u64) -> ControlFlow<()> {
        let done = self.done.fetch_add(rays, Ordering::Relaxed) + rays;
        (self.progress)(done.min(self.total), self.total)
    }

    /// Draws the rays of a class with these numbers in the window, and lets the intersector
    /// answer them.
    fn shoot(
        &self,
        subject: &Subject,
        class: Class,
        numbers: impl Iterator<Item = u64>,
    ) -> impl Iterator<Item = Shot> {
        let indices: Vec<u64> = numbers
            .map(|number| number * self.windows + subject.number)
            .collect();
        let (rays32, rays): (Vec<Ray32>, Vec<Ray>) = indices
            .iter()
            .map(|&index| subject.source.ray(class, index))
            .unzip();
        let answers = self.intersector.closest_of_each(&rays);
        assert_eq!(answers.len(), rays.len(), "an intersector answers each ray");
        let rays = rays32.into_iter().zip(rays);
        let shots = indices.into_iter().zip(rays).zip(answers);
        shots.map(|((index, (ray32, ray)), answer)| Shot {
            index,
            ray32,
            ray,
            answer,
        })
    }

    fn judge_by_meshes(
        &self,
        subject: &Subject,
        meshes: &Meshes,
        shot: &Shot,
        scratch: &mut Scratch,
        tally: &mut Tally,
    ) {
        let Shot { ray32, ray, .. } = shot;
        let answer = shot.answer.as_ref();
        tally.count(answer.is_some());
        let found = verdict(&subject.directory, meshes, (ray32, ray), answer, scratch);
        found.count(&mut tally.row);
        if let Verdict::Wrong(wrong) = found {
            if tally.listed.len() < self.settings.most_listed {
                let truth = truth_text(subject.window, truth::first_hit(subject.window, ray));
                let (low, high) = wrong.allowed();
                let reason = format!("{}; {truth}", wrong_text(&wrong));
                shot.list(Expected::Between { low, high, reason }, tally);
            }
        } else if let (Some(hit), Verdict::Right { .. }) = (answer, &found) {
            measure(subject, meshes, ray, hit, &scratch.seen, tally);
        }
    }

    fn judge_by_oracle(&self, subject: &Subject, shot: &Shot, tally: &mut Tally) {
        let ray = &shot.ray;
        let t = shot.answer.as_ref().map(|hit| hit.t);
        tally.count(t.is_some());
        let Some(bounds) = truth::bounds(subject.window, ray) else {
            tally.row.unwitnessed += 1;
            return;
        };
        let is_band = bounds.is_open(ray.t_max);
        tally.row.band += u64::from(is_band);
        tally.row.witnessed += u64::from(!is_band);
        if !bounds.allows(t, ray.t_max) {
            tally.row.violations += 1;
            let expected = Expected::Between {
                low: bounds.low,
                high: bounds.high,
                reason: truth_text(subject.window, truth::first_hit(subject.window, ray)),
            };
            shot.list(expected, tally);
        }
    }
}

/// A ray with its number in its class, and the answer to it.
struct Shot {
    index: u64,
    ray32: Ray32,
    ray: Ray,
    answer: Option<ReportedHit>,
}

impl Shot {
    /// Lists a wrong answer.
    fn list(&self, expected: Expected, tally: &mut Tally) {
        let t = self.answer.as_ref().map(|hit| hit.t);
        let violation = Violation::new(&tally.row, self.index, self.ray, t, expected);
        tally.listed.push(violation);
    }
}

/// Measures how close the inscribed mesh is to a right answer.
fn measure(
    subject: &Subject,
    meshes: &Meshes,
    ray: &Ray,
    answer: &ReportedHit,
    seen: &[Seen],
    tally: &mut Tally,
) {
    let Some(hit) = solid_of(&subject.directory, answer, seen) else {
        return;
    };
    let Some(inner) = hit.bounds.inner else {
        return;
    };
    let dt = (inner - answer.t).abs();
    let local = LocalRay::new(&subject.window.solids[hit.solid as usize], ray);
    if tally.row.class == Class::Sphere.name() {
        tally.dt_radii.push(local.radii(dt));
    }
    let part = answer.place.as_ref().map(|place| place.part);
    let sagittas = part.and_then(|part| local.sagittas(answer.t, dt, part, meshes.segments));
    if let Some(sagittas) = sagittas {
        let greatest = &mut tally.row.max_dt_over_chord;
        *greatest = greatest.max(sagittas);
    }
}
