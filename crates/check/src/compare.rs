//! Many rays of every class against both meshes, and a few against the oracle.
//!
//! Every number of sides and every class get the same rays: the windows of the
//! scene take turns, ray `i` belongs to window `i mod windows`. Rays are traced
//! in blocks on rayon's threads; the counts of the blocks are added in the order
//! of the rays, so the outcome is the same for any number of threads.

use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use rayon::prelude::*;

use cyltrace::embree::Device;
use cyltrace::math::Ray;
use cyltrace::scene::Scene;

use super::bounding_meshes::hull_list::{bytes_needed, triangles_within};
use super::bounding_meshes::mesh_frame::MeshFrame;
use super::bounding_meshes::meshes::{Meshes, Scratch, Seen};
use super::bounding_meshes::placed::{Budget, windows};
use super::bounding_meshes::window::Window;
use super::finding::{Intersector, ReportedHit};
use super::outcome::{Outcome, Violation, Witness};
use super::rays::RaySource;
use super::report::plan::{self, Missing};
use super::settings::{CheckError, Class, Settings};
use super::tally::Tally;
use super::verdict::judge::solid_of;
use super::verdict::surface::LocalRay;
use super::verdict::truth;
use super::verdict::verdict::{Subject, Verdict, verdict};

/// Rays that a thread takes at a time: long enough to share the work evenly
/// without a word about it, short enough to stop at once when told to.
const BLOCK: u64 = 512;

/// One ray of so many is given to the oracle, which takes some milliseconds.
const RAYS_A_TRUTH: u64 = 1000;

/// Is told how many of how many rays are done and what is going on, and may
/// break off.
pub type Progress<'a> = dyn Fn(u64, u64, &str) -> ControlFlow<()> + Sync + 'a;

/// Checks an intersector of a scene.
///
/// # Errors
/// When the settings are wrong, the scene is empty, or Embree refuses.
pub fn compare(
    scene: &Scene,
    intersector: &impl Intersector,
    settings: &Settings,
) -> Result<Outcome, CheckError> {
    compare_with(scene, intersector, settings, &|_, _, _| {
        ControlFlow::Continue(())
    })
}

/// The same, with a word about how far it is.
///
/// # Errors
/// As [`compare`], and [`CheckError::Interrupted`] when `progress` breaks off.
pub fn compare_with(
    scene: &Scene,
    intersector: &impl Intersector,
    settings: &Settings,
    progress: &Progress,
) -> Result<Outcome, CheckError> {
    let windows = chosen_windows(scene, settings)?;
    let device = Device::new(&settings.device)?;
    let of_class = settings.segments.len() as u64 * settings.rays;
    let run = Run {
        intersector,
        settings,
        windows: windows.len() as u64,
        device,
        total: of_class * settings.classes.len() as u64,
        done: AtomicU64::new(0),
        is_stopped: AtomicBool::new(false),
        progress,
    };
    let mut rows = Rows::new(settings);
    let mut outcome = Outcome::default();
    for (number, window) in (0..).zip(&windows) {
        let frame = MeshFrame::new(window);
        let source = RaySource::new(scene, window, &frame, number, settings.seed);
        let about = Subject::new(number, window, &frame, &source);
        outcome.windows.push(run.window(&about, &mut rows)?);
    }
    rows.finish(settings, &mut outcome);
    Ok(outcome)
}

/// The windows in which a scene is checked.
pub(super) fn chosen_windows(
    scene: &Scene,
    settings: &Settings,
) -> Result<Vec<Window>, CheckError> {
    if settings.rays == 0 || settings.classes.is_empty() || settings.segments.is_empty() {
        return Err(CheckError::NothingAsked);
    }
    for &segments in &settings.segments {
        if !(3..=4096).contains(&segments) {
            return Err(CheckError::Segments { segments });
        }
    }
    let scene_stats = scene.scene_stats();
    if scene_stats.cylinders_instanced == 0 && scene_stats.other_solids_unique == 0 {
        return Err(CheckError::Empty);
    }
    let segments = settings.segments.iter().copied().max().unwrap_or(3);
    let budget = Budget {
        triangles: triangles_within(settings.max_memory),
        segments,
    };
    let windows = windows(scene, budget, settings.seed);
    if windows.is_empty() {
        return Err(CheckError::Memory {
            needed: bytes_needed(8 * 4 * u64::from(segments)),
            allowed: settings.max_memory,
        });
    }
    Ok(windows)
}

/// What stays the same from window to window.
struct Run<'a, I> {
    intersector: &'a I,
    settings: &'a Settings,
    windows: u64,
    device: Device,
    total: u64,
    done: AtomicU64,
    is_stopped: AtomicBool,
    progress: &'a Progress<'a>,
}

impl<I: Intersector> Run<'_, I> {
    /// Checks one window and says what it held.
    fn window(&self, about: &Subject, rows: &mut Rows) -> Result<String, CheckError> {
        let mut missing = Vec::new();
        for (&segments, rows) in self.settings.segments.iter().zip(&mut rows.prisms) {
            self.tell(0, &format!("building prisms of {segments} sides"))?;
            let meshes = Meshes::new(&self.device, about.window, about.frame, segments)?;
            missing.push(Missing {
                segments,
                inscribed: meshes.empty(),
                circumscribed: meshes.unbounded().len(),
            });
            for (&class, row) in self.settings.classes.iter().zip(rows) {
                let what = format!("{class}, {segments} sides");
                let tally = self.trace(about, &what, BLOCK, |range, scratch| {
                    self.prism_block(about, &meshes, class, range, scratch)
                })?;
                row.add(tally, self.settings.most_listed);
            }
        }
        for (&class, row) in self.settings.classes.iter().zip(&mut rows.truths) {
            let what = format!("{class}, oracle");
            let tally = self.trace(about, &what, RAYS_A_TRUTH, |range, _| {
                self.truth(about, class, range.start)
            })?;
            row.add(tally, self.settings.most_listed);
        }
        let number = about.number;
        Ok(plan::in_words(about.window, number, self.windows, &missing))
    }

    /// Gives the rays of a window to `block`, in ranges of the window's own
    /// count, and adds up what comes back.
    fn trace(
        &self,
        about: &Subject,
        what: &str,
        block_size: u64,
        block: impl Fn(Range<u64>, &mut Scratch) -> Tally + Sync,
    ) -> Result<Tally, CheckError> {
        let later = (self.windows - 1 - about.number) + self.settings.rays;
        let rays = later / self.windows;
        let blocks: Vec<Option<Tally>> = (0..rays.div_ceil(block_size))
            .into_par_iter()
            .map_init(Scratch::default, |scratch, number| {
                let range = number * block_size..rays.min((number + 1) * block_size);
                if self.is_stopped.load(Ordering::Relaxed) {
                    return None;
                }
                let tally = block(range, scratch);
                self.tell(tally.rays, what).ok().map(|()| tally)
            })
            .collect();
        let mut sum = Tally::default();
        for tally in blocks {
            sum.add(
                tally.ok_or(CheckError::Interrupted)?,
                self.settings.most_listed,
            );
        }
        Ok(sum)
    }

    fn tell(&self, rays: u64, what: &str) -> Result<(), CheckError> {
        let done = self.done.fetch_add(rays, Ordering::Relaxed) + rays;
        if (self.progress)(done.min(self.total), self.total, what).is_break() {
            self.is_stopped.store(true, Ordering::Relaxed);
            return Err(CheckError::Interrupted);
        }
        Ok(())
    }

    /// The number that a ray of a window has in its class.
    fn index(&self, about: &Subject, number: u64) -> u64 {
        number * self.windows + about.number
    }

    fn prism_block(
        &self,
        about: &Subject,
        meshes: &Meshes,
        class: Class,
        range: Range<u64>,
        scratch: &mut Scratch,
    ) -> Tally {
        let mut tally = Tally::default();
        for number in range {
            let index = self.index(about, number);
            let (ray32, ray) = about.source.ray(class, index);
            let answer = self.intersector.closest(&ray);
            tally.count(answer.as_ref());
            let verdict = verdict(about, meshes, &ray32, &ray, answer.as_ref(), scratch);
            verdict.count(&mut tally);
            if let Verdict::Wrong(wrong) = verdict
                && tally.listed.len() < self.settings.most_listed
            {
                let truth = truth::in_words(about.window, &ray);
                tally.listed.push(Violation {
                    class,
                    witness: Witness::Prisms,
                    segments: Some(meshes.segments),
                    index,
                    ray,
                    answer,
                    allowed: wrong.allowed(),
                    what: format!("{wrong}; {truth}"),
                });
            } else if let (Some(finding), Verdict::Right { .. }) = (&answer, &verdict) {
                let is_sphere = class == Class::Sphere;
                let seen = &scratch.seen;
                measure(about, meshes, &ray, finding, seen, is_sphere, &mut tally);
            }
        }
        tally
    }

    /// One ray against the oracle.
    fn truth(&self, about: &Subject, class: Class, number: u64) -> Tally {
        let mut tally = Tally::default();
        let index = self.index(about, number);
        let (_, ray) = about.source.ray(class, index);
        let answer = self.intersector.closest(&ray);
        tally.count(answer.as_ref());
        let Some(bounds) = truth::bounds(about.window, &ray) else {
            tally.unwitnessed += 1;
            return tally;
        };
        let is_band = bounds.is_open(ray.t_max);
        tally.band += u64::from(is_band);
        tally.witnessed += u64::from(!is_band);
        if !truth::allows(&bounds, &ray, answer.as_ref()) {
            tally.violations += 1;
            tally.listed.push(Violation {
                class,
                witness: Witness::Oracle,
                segments: None,
                index,
                ray,
                answer,
                allowed: (bounds.low, bounds.high),
                what: truth::in_words(about.window, &ray),
            });
        }
        tally
    }
}

/// How near the inscribed prism is to a right answer.
fn measure(
    about: &Subject,
    meshes: &Meshes,
    ray: &Ray,
    finding: &ReportedHit,
    seen: &[Seen],
    is_sphere: bool,
    tally: &mut Tally,
) {
    let Some(hit) = solid_of(&about.directory, finding, seen) else {
        return;
    };
    let Some(inner) = hit.bounds.inner else {
        return;
    };
    let dt = (inner - finding.t).abs();
    let local = LocalRay::new(&about.window.solids[hit.solid as usize], ray);
    if is_sphere {
        tally.dt_radii.push(local.radii(dt));
    }
    let part = finding.place.as_ref().map(|place| place.part);
    let sagittas = part.and_then(|part| local.sagittas(finding.t, dt, part, meshes.segments));
    if let Some(sagittas) = sagittas {
        tally.max_dt_over_chord = tally.max_dt_over_chord.max(sagittas);
    }
}

/// The rows as they grow.
struct Rows {
    /// By segments, then class.
    prisms: Vec<Vec<Tally>>,
    /// By class.
    truths: Vec<Tally>,
}

impl Rows {
    fn new(settings: &Settings) -> Self {
        let classes = vec![Tally::default(); settings.classes.len()];
        Self {
            prisms: vec![classes.clone(); settings.segments.len()],
            truths: classes,
        }
    }

    fn finish(self, settings: &Settings, outcome: &mut Outcome) {
        for (&segments, row) in settings.segments.iter().zip(self.prisms) {
            for (&class, mut tally) in settings.classes.iter().zip(row) {
                let row = tally.row(class, Witness::Prisms, Some(segments));
                outcome.rows.push(row);
                if class == Class::Sphere {
                    outcome.convergence.push(tally.convergence(segments));
                }
                outcome.violations.append(&mut tally.listed);
            }
        }
        for (&class, mut tally) in settings.classes.iter().zip(self.truths) {
            outcome.rows.push(tally.row(class, Witness::Oracle, None));
            outcome.violations.append(&mut tally.listed);
        }
    }
}
