//! One ray again, with everything told.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;

use cyltrace::embree::{Device, Ray32};
use cyltrace::math::Ray;
use cyltrace::scene::Scene;

use super::bounding_meshes::mesh_frame::MeshFrame;
use super::bounding_meshes::meshes::{Meshes, Scratch};
use super::compare::chosen_windows;
use super::finding::{Intersector, ReportedHit};
use super::outcome::{Violation, Witness};
use super::rays::RaySource;
use super::report::words::{answer_text, instance_text, interval_text, ray_text};
use super::settings::{CheckError, Class, Settings};
use super::verdict::judge::first;
use super::verdict::truth;
use super::verdict::verdict::{Subject, Verdict, verdict};

/// A ray to look at again.
///
/// As text, `class:index`, or eight numbers of f64 by their bits in
/// hexadecimal digits, with colons between: origin, direction, `t_min`, `t_max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Replay {
    /// A ray of a check with the same scene and settings.
    Drawn {
        /// Its class.
        class: Class,
        /// Its number in the class.
        index: u64,
    },
    /// Any ray. Where the meshes cannot have it exactly, the nearest one that
    /// they can have is taken.
    Given(Ray),
}

/// What is known of one ray.
#[derive(Clone, Debug, Default)]
pub struct Replayed {
    /// The ray, its answer, the bounds of each solid, the truth: in words.
    pub lines: Vec<String>,
    /// What is wrong, by segments.
    pub violations: Vec<Violation>,
}

/// What a word for [`Replay`] looks like.
const REPLAY_WORDS: &str = "it must be CLASS:INDEX, such as grazing:17, or a ray as a run printed \
    it: 8 numbers of 16 hexadecimal digits with colons between";

impl fmt::Display for Replay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Drawn { class, index } => write!(f, "{class}:{index}"),
            Self::Given(ray) => {
                let (o, d) = (ray.origin, ray.direction);
                let numbers = [o.x, o.y, o.z, d.x, d.y, d.z, ray.t_min, ray.t_max];
                let bits = numbers.map(|x| format!("{:016x}", x.to_bits()));
                f.write_str(&bits.join(":"))
            }
        }
    }
}

impl Replay {
    /// What a violation is listed under; a ray that is given has no class of its
    /// own and counts as the first of the camera's.
    fn class_and_index(&self) -> (Class, u64) {
        match self {
            Self::Drawn { class, index } => (*class, *index),
            Self::Given(_) => (Class::Camera, 0),
        }
    }
}

impl FromStr for Replay {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split(':').collect();
        if let [class, index] = parts[..] {
            let index = index
                .parse()
                .map_err(|_| format!("`{index}` is no number of a ray: {REPLAY_WORDS}"))?;
            let class = class.parse()?;
            return Ok(Self::Drawn { class, index });
        }
        let numbers = parts
            .iter()
            .map(|bits| u64::from_str_radix(bits, 16).map(f64::from_bits));
        let bits: Vec<f64> = numbers
            .collect::<Result<_, _>>()
            .map_err(|_| REPLAY_WORDS.to_owned())?;
        let [ox, oy, oz, dx, dy, dz, t_min, t_max] = bits[..] else {
            return Err(REPLAY_WORDS.to_owned());
        };
        let ray = Ray {
            origin: DVec3::new(ox, oy, oz),
            direction: DVec3::new(dx, dy, dz),
            t_min,
            t_max,
        };
        if !ray.is_valid() {
            return Err(format!(
                "{} is not a ray that can hit anything",
                ray_text(&ray)
            ));
        }
        Ok(Self::Given(ray))
    }
}

impl Violation {
    /// The very ray, for [`replay`].
    #[must_use]
    pub fn replay(&self) -> Replay {
        Replay::Given(self.ray)
    }
}

/// Traces one ray and tells everything about it; `settings` are those of the
/// check that it comes from.
///
/// # Errors
/// As [`compare`](super::compare).
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
        let source = RaySource::new(scene, window, &frame, number, settings.seed);
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
        let subject = Subject::new(number, window, &frame, &source);
        let answer = intersector.closest(&ray);
        replayed.describe(which, &subject, &ray, answer.as_ref());
        replayed.judge_truly(which, &subject, &ray, answer.as_ref());
        for &segments in &settings.segments {
            let meshes = Meshes::new(&device, window, &frame, segments)?;
            replayed.judge(which, &subject, &meshes, (&ray32, &ray), answer.as_ref());
        }
    }
    if replayed.lines.is_empty() {
        let word = String::from("the ray meets no part of the scene that is checked");
        replayed.lines.push(word);
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
        about: &Subject,
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
                "    the nearest that the meshes can have; its origin moved by {moved:e}"
            ));
        }
        lines.push(format!("answer: {}", answer_text(answer)));
        lines.push(truth::in_words(about.window, ray));
    }

    /// Against the oracle.
    fn judge_truly(
        &mut self,
        which: &Replay,
        about: &Subject,
        ray: &Ray,
        answer: Option<&ReportedHit>,
    ) {
        let Some(bounds) = truth::bounds(about.window, ray) else {
            return;
        };
        self.lines.push(format!(
            "    with the solids displaced by what f64 rounds: {}",
            interval_text(bounds.low, bounds.high)
        ));
        if !truth::allows(&bounds, ray, answer) {
            let (class, index) = which.class_and_index();
            self.violations.push(Violation {
                class,
                witness: Witness::Oracle,
                segments: None,
                index,
                ray: *ray,
                answer: answer.cloned(),
                allowed: (bounds.low, bounds.high),
                what: truth::in_words(about.window, ray),
            });
        }
    }

    fn judge(
        &mut self,
        which: &Replay,
        about: &Subject,
        meshes: &Meshes,
        (ray32, ray): (&Ray32, &Ray),
        answer: Option<&ReportedHit>,
    ) {
        let mut scratch = Scratch::default();
        let verdict = verdict(about, meshes, ray32, ray, answer, &mut scratch);
        let bounds = first(&scratch.seen);
        self.lines.push(format!(
            "{} sides: {}",
            meshes.segments,
            interval_text(bounds.low, bounds.high)
        ));
        for seen in &scratch.seen {
            let solid = &about.window.solids[seen.solid as usize];
            let interval = seen.bounds.interval;
            self.lines.push(format!(
                "    {} {} of {}: {}",
                about.window.kind(seen.solid).name(),
                solid.primitive,
                instance_text(&solid.frame.instance),
                interval_text(interval.low, interval.high)
            ));
        }
        let words = match &verdict {
            Verdict::Unwitnessed => String::from("not witnessed"),
            Verdict::Right { is_cleared, .. } if *is_cleared => {
                String::from("right, by exact arithmetic: an error of the f32 traversal")
            }
            Verdict::Right { .. } => String::from("right"),
            Verdict::Wrong(wrong) => format!("WRONG: {wrong}"),
        };
        self.lines.push(format!("    {words}"));
        if let Verdict::Wrong(wrong) = verdict {
            let (class, index) = which.class_and_index();
            self.violations.push(Violation {
                class,
                witness: Witness::Prisms,
                segments: Some(meshes.segments),
                index,
                ray: *ray,
                answer: answer.cloned(),
                allowed: wrong.allowed(),
                what: wrong.to_string(),
            });
        }
    }
}
