//! The outcome of a range of the rays, which is kept until the others are there.

use cyltrace::math::Ray;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::outcome::{Expected, Outcome, Row, Violation, Witness};
use super::settings::{Class, Settings};
use super::tally::Tally;

/// What a check found with some of its rays, see [`compare_rays`](crate::compare_rays).
#[derive(Clone, Debug, Default)]
pub struct PartialOutcome {
    pub(crate) windows: Vec<WindowOutcome>,
}

/// What a check found in a window of the scene.
#[derive(Clone, Debug)]
pub(crate) struct WindowOutcome {
    /// A description of the window.
    pub text: String,
    /// The tallies of [`rows`].
    pub tallies: Vec<Tally>,
}

/// Saved tallies are of other settings, or not what this version saves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("these are not the saved tallies of a check with these settings")]
pub struct NotTheseTallies;

/// The rows of a check with these settings, in the order of [`Outcome::rows`], without rays.
pub(crate) fn rows(settings: &Settings) -> impl Iterator<Item = Row> {
    let witnesses = settings.segments.iter().map(|&sides| Some(sides));
    witnesses.chain([None]).flat_map(|segments| {
        let witness = segments.map_or(Witness::Oracle, |_| Witness::Prisms);
        let classes = settings.classes.iter();
        classes.map(move |class| Row::new(class.name(), witness, segments))
    })
}

impl Outcome {
    /// The outcome of ranges of rays that follow one another: the same as that of all rays at
    /// once. The settings must be those of the parts.
    ///
    /// # Panics
    /// If the parts are of different scenes, so that they differ in the number of windows.
    #[must_use]
    pub fn of_parts(settings: &Settings, parts: impl IntoIterator<Item = PartialOutcome>) -> Self {
        let mut windows: Vec<WindowOutcome> = Vec::new();
        for part in parts {
            if windows.is_empty() {
                windows = part.windows;
                continue;
            }
            assert_eq!(windows.len(), part.windows.len(), "parts of one scene");
            for (window, later) in windows.iter_mut().zip(part.windows) {
                for (tally, later) in window.tallies.iter_mut().zip(later.tallies) {
                    tally.add(later, settings.most_listed);
                }
            }
        }
        // The rays of a window are judged before those of the next, so they are listed first.
        let mut tallies: Vec<Tally> = rows(settings).map(Tally::new).collect();
        let mut outcome = Self::default();
        for window in windows {
            outcome.windows.push(window.text);
            for (tally, later) in tallies.iter_mut().zip(window.tallies) {
                tally.add(later, settings.most_listed);
            }
        }
        for mut tally in tallies {
            if let Some(segments) = tally.row.segments
                && tally.row.class == Class::Sphere.name()
            {
                outcome.convergence.push(tally.convergence(segments));
            }
            outcome.rows.push(tally.row);
            outcome.violations.append(&mut tally.listed);
        }
        outcome
    }
}

impl PartialOutcome {
    /// The outcome as bytes, from which [`PartialOutcome::from_bytes`] makes the same.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let windows = self.windows.iter().map(|window| SavedWindow {
            text: window.text.clone(),
            tallies: window.tallies.iter().map(SavedTally::of).collect(),
        });
        let windows: Vec<SavedWindow> = windows.collect();
        postcard::to_allocvec(&windows).expect("numbers, texts and lists of known length")
    }

    /// The outcome that [`PartialOutcome::to_bytes`] saved in a check with these settings.
    ///
    /// # Errors
    /// If the bytes are anything else.
    pub fn from_bytes(settings: &Settings, bytes: &[u8]) -> Result<Self, NotTheseTallies> {
        let windows: Vec<SavedWindow> = postcard::from_bytes(bytes).map_err(|_| NotTheseTallies)?;
        let count = rows(settings).count();
        let window = |window: SavedWindow| {
            let is_same = window.tallies.len() == count;
            let tallies = rows(settings).zip(window.tallies);
            let tallies = tallies.map(|(row, saved)| saved.tally(row)).collect();
            let text = window.text;
            is_same.then_some(WindowOutcome { text, tallies })
        };
        let windows: Option<Vec<_>> = windows.into_iter().map(window).collect();
        windows
            .map(|windows| Self { windows })
            .ok_or(NotTheseTallies)
    }
}

/// A [`WindowOutcome`] as it is saved.
#[derive(Serialize, Deserialize)]
struct SavedWindow {
    text: String,
    tallies: Vec<SavedTally>,
}

/// A [`Tally`] as it is saved: without what the settings determine.
#[derive(Serialize, Deserialize)]
struct SavedTally {
    rays: u64,
    hits: u64,
    witnessed: u64,
    band: u64,
    unwitnessed: u64,
    triangle_errors: u64,
    violations: u64,
    wrong_normals: u64,
    max_dt_over_chord: f64,
    dt_radii: Vec<f64>,
    listed: Vec<SavedViolation>,
}

/// A [`Violation`] of drawn rays as it is saved.
#[derive(Serialize, Deserialize)]
struct SavedViolation {
    index: u64,
    origin: [f64; 3],
    direction: [f64; 3],
    range: [f64; 2],
    t: Option<f64>,
    low: f64,
    high: f64,
    reason: String,
}

impl SavedTally {
    fn of(tally: &Tally) -> Self {
        let row = &tally.row;
        Self {
            rays: row.rays,
            hits: row.hits,
            witnessed: row.witnessed,
            band: row.band,
            unwitnessed: row.unwitnessed,
            triangle_errors: row.triangle_errors,
            violations: row.violations,
            wrong_normals: row.wrong_normals,
            max_dt_over_chord: row.max_dt_over_chord,
            dt_radii: tally.dt_radii.clone(),
            listed: tally.listed.iter().map(SavedViolation::of).collect(),
        }
    }

    /// The tally of a row that has no ray yet.
    fn tally(self, row: Row) -> Tally {
        let violations = self.listed.into_iter();
        let listed = violations.map(|saved| saved.violation(&row)).collect();
        Tally {
            row: Row {
                rays: self.rays,
                hits: self.hits,
                witnessed: self.witnessed,
                band: self.band,
                unwitnessed: self.unwitnessed,
                triangle_errors: self.triangle_errors,
                violations: self.violations,
                wrong_normals: self.wrong_normals,
                max_dt_over_chord: self.max_dt_over_chord,
                ..row
            },
            dt_radii: self.dt_radii,
            listed,
        }
    }
}

impl SavedViolation {
    fn of(violation: &Violation) -> Self {
        let Expected::Between { low, high, reason } = &violation.expected else {
            unreachable!("drawn rays are compared with bounds");
        };
        let ray = &violation.ray;
        Self {
            index: violation.index,
            origin: ray.origin.to_array(),
            direction: ray.direction.to_array(),
            range: [ray.t_min, ray.t_max],
            t: violation.t,
            low: *low,
            high: *high,
            reason: reason.clone(),
        }
    }

    fn violation(self, row: &Row) -> Violation {
        let [t_min, t_max] = self.range;
        let ray = Ray {
            origin: DVec3::from_array(self.origin),
            direction: DVec3::from_array(self.direction),
            t_min,
            t_max,
        };
        let (low, high, reason) = (self.low, self.high, self.reason);
        let expected = Expected::Between { low, high, reason };
        Violation::new(row, self.index, ray, self.t, expected)
    }
}
