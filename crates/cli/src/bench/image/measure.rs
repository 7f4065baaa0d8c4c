//! Pictures of one scene with one integrator: their times, and their errors against a reference.

use std::time::Instant;

use cyltrace::scene::{Integrator, Sampler};
use cyltrace::tracer::Tracer;
use cyltrace_bench::{PowerLaw, Spread, percentile};
use cyltrace_output::Film;
use cyltrace_render::{Picture, RenderError, Settings, Target, render, tile_errors};
use rayon::ThreadPool;

use crate::interrupt;

/// The least number of samples of the series with the same number for every pixel.
const LEAST: u32 = 4;

/// A reference has this many times the samples of the largest picture.
const REFERENCE: u32 = 16;

/// A reference until an error has this part of the least error of a picture. Errors of even samples
/// fall at most as the power 0.7 of the number of samples of what was measured, so that the
/// reference takes 7^(1/0.7) = 16 times as many or more.
const REFERENCE_ERROR: f64 = 1.0 / 7.0;

/// Most samples of a pixel of a reference.
const MOST_OF_REFERENCE: u32 = 1 << 18;

/// What is rendered of each scene.
pub struct Plan {
    pub samplers: Vec<Sampler>,
    /// The greatest number of samples for every pixel.
    pub spp: u32,
    pub errors: Vec<f64>,
    pub rounds: usize,
}

/// When a picture ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// With this number of samples for every pixel.
    Uniform(u32),
    /// When this error is reached.
    Error(f64),
}

/// What was found of a picture.
#[derive(Clone, Debug)]
pub struct Row {
    pub sampler: Sampler,
    pub mode: Mode,
    /// Samples per pixel, the mean over the picture.
    pub spp: f64,
    pub rays: u64,
    pub seconds: Spread,
    /// The root mean square of the differences of all components over their mean.
    pub rmse: f64,
    /// The 95th percentile and the greatest of the errors of tiles.
    pub p95: f64,
    pub greatest: f64,
    /// The tiles whose error is at most the one of `--error`, of all tiles.
    pub kept: Option<(u64, u64)>,
    /// The tiles that had all samples before they reached the error, by their own estimate.
    pub above: Option<u64>,
}

/// The pictures of a scene with an integrator.
#[derive(Clone, Debug)]
pub struct Group {
    pub scene: String,
    pub integrator: Integrator,
    pub rows: Vec<Row>,
}

impl Group {
    /// How an error falls with the number of samples, of a sampler with the same number for every
    /// pixel or until errors.
    pub fn slope(
        &self,
        sampler: Sampler,
        is_uniform: bool,
        of: fn(&Row) -> f64,
    ) -> Option<PowerLaw> {
        let own = self.series(sampler, is_uniform);
        let points = own.map(|row| (row.spp, of(row))).filter(|(_, y)| *y > 0.0);
        PowerLaw::of(&points.collect::<Vec<_>>())
    }

    /// The rows of a sampler with the same number for every pixel or until errors.
    pub fn series(&self, sampler: Sampler, is_uniform: bool) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| {
            row.sampler == sampler && matches!(row.mode, Mode::Uniform(_)) == is_uniform
        })
    }
}

impl Plan {
    /// The pictures of each sampler.
    fn modes(&self) -> Vec<Mode> {
        let doubled = std::iter::successors(Some(LEAST), |spp| spp.checked_mul(2));
        let uniform = doubled
            .take_while(|spp| *spp <= self.spp)
            .map(Mode::Uniform);
        let until = self.errors.iter().map(|&error| Mode::Error(error));
        uniform.chain(until).collect()
    }

    /// The number of steps that [`Plan::measure`] reports.
    pub fn steps(&self) -> u64 {
        (2 + self.rounds * self.modes().len() * self.samplers.len()) as u64
    }

    /// Renders all pictures in each round, which begins with another one each time.
    pub fn measure(
        &self,
        tracer: &Tracer,
        settings: &Settings,
        workers: &ThreadPool,
        after_step: &dyn Fn(),
    ) -> anyhow::Result<Vec<Row>> {
        let modes = self.modes();
        let samplers = self.samplers.iter();
        let all: Vec<(Sampler, Mode)> = samplers
            .flat_map(|&sampler| modes.iter().map(move |&mode| (sampler, mode)))
            .collect();
        let picture = |settings: &Settings| -> Result<Picture, RenderError> {
            let picture = render(
                tracer,
                settings,
                workers,
                &|_| {},
                interrupt::end_in_order(),
            );
            after_step();
            picture
        };
        let (uniform, until) = self.references(settings);
        let uniform = picture(&uniform)?.film;
        let until = match &until {
            Some(until) => picture(until)?.film,
            None => uniform.clone(),
        };
        let mut pictures: Vec<Option<Picture>> = vec![None; all.len()];
        let mut seconds = vec![Vec::new(); all.len()];
        for round in 0..self.rounds {
            for turn in 0..all.len() {
                let index = (round + turn) % all.len();
                let settings = settings_of(settings, all[index]);
                let start = Instant::now();
                let made = picture(&settings)?;
                seconds[index].push(start.elapsed().as_secs_f64());
                pictures[index] = Some(made);
            }
        }
        let rows = all.into_iter().zip(pictures).zip(seconds);
        let row = |((of, made), seconds): ((_, Option<Picture>), Vec<f64>)| {
            let reference = match of {
                (_, Mode::Uniform(_)) => &uniform,
                (_, Mode::Error(_)) => &until,
            };
            Some(row(of, &made?, reference, Spread::of(&seconds)))
        };
        Ok(rows.filter_map(row).collect())
    }

    /// The settings of the references: of pictures with the same number for every pixel, and of
    /// those until an error.
    fn references(&self, settings: &Settings) -> (Settings, Option<Settings>) {
        let reference = Settings {
            sampler: Sampler::Sobol,
            seed: settings.seed.wrapping_add(1),
            ..settings.clone()
        };
        let uniform = Settings {
            spp: self.spp.saturating_mul(REFERENCE),
            ..reference.clone()
        };
        let least = self.errors.iter().copied().reduce(f64::min);
        let until = least.map(|least| Settings {
            spp: MOST_OF_REFERENCE,
            target: Some(Target {
                error: least * REFERENCE_ERROR,
                time: None,
            }),
            ..reference
        });
        (uniform, until)
    }
}

fn settings_of(settings: &Settings, (sampler, mode): (Sampler, Mode)) -> Settings {
    let (spp, target) = match mode {
        Mode::Uniform(spp) => (spp, None),
        Mode::Error(error) => (Target::MOST_SAMPLES, Some(Target { error, time: None })),
    };
    Settings {
        sampler,
        spp,
        target,
        ..settings.clone()
    }
}

fn row(
    (sampler, mode): (Sampler, Mode),
    picture: &Picture,
    reference: &Film,
    seconds: Spread,
) -> Row {
    let errors = tile_errors(&picture.film, reference);
    let pixels = reference.pixels().len() as f64;
    let (spp, kept) = match mode {
        Mode::Uniform(spp) => (f64::from(spp), None),
        Mode::Error(error) => {
            let samples = picture.reached.map_or(0, |reached| reached.samples);
            let within = errors.iter().filter(|one| **one <= error).count();
            let kept = (within as u64, errors.len() as u64);
            (samples as f64 / pixels, Some(kept))
        }
    };
    Row {
        sampler,
        mode,
        spp,
        rays: picture.rays.total(),
        seconds,
        rmse: relative_error(&picture.film, reference),
        greatest: errors.iter().copied().fold(0.0, f64::max),
        p95: percentile(95, errors).unwrap_or_default(),
        kept,
        above: picture.reached.map(|reached| reached.tiles_above),
    }
}

/// The root mean square of all differences over the mean.
fn relative_error(picture: &Film, reference: &Film) -> f64 {
    let own = picture.pixels().as_flattened().iter();
    let both = own.zip(reference.pixels().as_flattened());
    let (mut squares, mut sum, mut count) = (0.0, 0.0, 0.0);
    for (&value, &truth) in both {
        let (value, truth) = (f64::from(value), f64::from(truth));
        squares += (value - truth) * (value - truth);
        sum += truth;
        count += 1.0;
    }
    (squares * count).sqrt() / sum
}
