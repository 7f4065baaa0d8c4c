//! The ulp map: which formulations answer right on neighbouring floats.
//!
//! Around the case of a family that is hardest (of the least gap among the
//! first thousand) two coordinates of the ray's origin, those across its
//! flight, are stepped to their neighbours of the inputs' precision. Each
//! formulation gets a tile; a pixel is one such ray. The first tile is the
//! truth.

use rayon::prelude::*;

use crate::formulations::{Answer, Problem};
use cyltrace::solid::Part;
use cyltrace_oracle::cases::{Family, Inputs};
use cyltrace_output::Film;

use super::contender::Contender;

/// Rays across a tile, an odd number so that the case itself is in the middle.
const ACROSS: i32 = 65;
/// Pixels that a ray takes.
const ZOOM: usize = 3;
/// Pixels between tiles.
const MARGIN: usize = 8;
/// Tiles in a row.
const COLUMNS: usize = 5;
/// Cases among which the hardest is looked for.
const SEARCHED: u64 = 1_000;

const PAPER: [f32; 3] = [0.9, 0.9, 0.9];
const RIGHT_HIT: [f32; 3] = [0.04, 0.22, 0.45];
const RIGHT_MISS: [f32; 3] = [0.55, 0.72, 0.85];
const WRONG_HIT: [f32; 3] = [0.75, 0.05, 0.03];
const WRONG_MISS: [f32; 3] = [0.95, 0.45, 0.02];
const WRONG_PART: [f32; 3] = [0.45, 0.05, 0.5];

/// The meaning of the colours, for those who print it beside the picture.
const LEGEND: &str = "dark blue: right, a hit; light blue: right, a miss; red: hit instead of \
    miss; orange: miss instead of hit; purple: another part";

/// A picture and what it shows.
pub struct UlpMap {
    /// The picture: tiles in rows.
    pub film: Film,
    /// The case in the middle of every tile.
    pub center: Problem,
    /// Each tile from the left of the top row, and its share of wrong rays.
    pub tiles: Vec<(String, f64)>,
    /// What the colours mean.
    pub legend: &'static str,
}

/// The map of a family's hardest case.
#[must_use]
pub fn ulp_map(contenders: &[Contender], family: Family, inputs: Inputs, seed: u64) -> UlpMap {
    let center = hardest(family, inputs, seed);
    let problems = neighbours(&center, inputs);
    let truth: Vec<Option<Part>> = problems
        .par_iter()
        .map(|problem| {
            cyltrace_oracle::first_hit(&problem.cylinder, &problem.ray)
                .hit
                .map(|hit| hit.part)
        })
        .collect();

    let mut names = vec![(String::from("truth"), 0.0)];
    let mut tiles = vec![
        truth
            .iter()
            .map(|&truth| colour(truth, truth))
            .collect::<Vec<_>>(),
    ];
    for contender in contenders {
        let Contender::Formulation(formulation) = contender else {
            continue;
        };
        let answers = formulation.answers(&problems);
        let found = |answer: &Option<Answer>| answer.map(|answer| answer.part);
        let pairs = || truth.iter().zip(answers.iter().map(found));
        let wrong = pairs().filter(|(truth, found)| *truth != found).count();
        let name = format!("{} {}", formulation.name(), formulation.precision().name());
        names.push((name, wrong as f64 / problems.len() as f64));
        tiles.push(
            pairs()
                .map(|(&truth, found)| colour(truth, found))
                .collect(),
        );
    }
    UlpMap {
        film: picture(&tiles),
        center,
        tiles: names,
        legend: LEGEND,
    }
}

fn hardest(family: Family, inputs: Inputs, seed: u64) -> Problem {
    let gaps: Vec<(f64, u64)> = (0..SEARCHED)
        .into_par_iter()
        .map(|index| {
            let Problem { cylinder, ray } = family.case(seed, index, inputs);
            let hit = cyltrace_oracle::first_hit(&cylinder, &ray).hit;
            (cyltrace_oracle::gap(&cylinder, &ray, hit.as_ref()), index)
        })
        .collect();
    let least = gaps
        .into_iter()
        .min_by(|one, other| one.0.total_cmp(&other.0));
    let (_, index) = least.expect("cases were searched");
    family.case(seed, index, inputs)
}

/// Row by row from the top, the case itself in the middle.
fn neighbours(center: &Problem, inputs: Inputs) -> Vec<Problem> {
    let along = center.ray.direction.abs().max_position();
    let (across, up) = ((along + 1) % 3, (along + 2) % 3);
    let half = ACROSS / 2;
    let grid = (-half..=half).flat_map(|row| (-half..=half).map(move |column| (row, column)));
    grid.map(|(row, column)| {
        let mut problem = *center;
        let origin = &mut problem.ray.origin;
        origin[across] = inputs.stepped(origin[across], column);
        origin[up] = inputs.stepped(origin[up], -row);
        problem
    })
    .collect()
}

fn colour(truth: Option<Part>, found: Option<Part>) -> [f32; 3] {
    match (truth, found) {
        (None, None) => RIGHT_MISS,
        (None, Some(_)) => WRONG_HIT,
        (Some(_), None) => WRONG_MISS,
        (Some(truth), Some(found)) if truth == found => RIGHT_HIT,
        _ => WRONG_PART,
    }
}

fn picture(tiles: &[Vec<[f32; 3]>]) -> Film {
    let columns = COLUMNS.min(tiles.len());
    let across = ACROSS as usize;
    let tile = across * ZOOM + MARGIN;
    let (width, height) = (
        columns * tile + MARGIN,
        tiles.len().div_ceil(columns) * tile + MARGIN,
    );
    let mut pixels = vec![PAPER; width * height];
    for (number, colours) in tiles.iter().enumerate() {
        let (left, top) = (
            number % columns * tile + MARGIN,
            number / columns * tile + MARGIN,
        );
        for y in 0..across * ZOOM {
            for x in 0..across * ZOOM {
                pixels[(top + y) * width + left + x] = colours[y / ZOOM * across + x / ZOOM];
            }
        }
    }
    Film::new(width as u32, height as u32, pixels)
}
