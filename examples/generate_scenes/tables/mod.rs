//! The tables of the sample scenes, as text.
//!
//! Everything is drawn from [`cyltrace::math::Random`] with fixed seeds and
//! computed with `libm`, so the text is the same on every platform.

mod broadleaf;
mod conifer;
mod forest;
mod lattice;
mod neuron;
mod pipes;
mod skeleton;

use std::fmt::Write;

use cyltrace::math::Random;
use glam::DVec3;

/// A file of `scenes/`.
pub struct Table {
    /// The file's name.
    pub file: &'static str,
    /// The number of rows below the header.
    pub rows: usize,
    /// The whole content.
    pub text: String,
}

/// Every generated file.
pub fn all() -> Vec<Table> {
    let mut tables = broadleaf::tables();
    tables.extend(conifer::tables());
    tables.extend(forest::tables());
    tables.extend(lattice::tables());
    tables.extend(neuron::tables());
    tables.extend(pipes::tables());
    tables
}

impl Table {
    fn new(file: &'static str, header: &str) -> Self {
        Self {
            file,
            rows: 0,
            text: format!("{header}\n"),
        }
    }

    /// Adds a row of numbers, each rounded to its own number of decimals.
    fn push(&mut self, cells: &[(f64, usize)]) {
        for (index, &(value, decimals)) in cells.iter().enumerate() {
            let comma = if index == 0 { "" } else { "," };
            let cell = rounded(value, decimals);
            write!(self.text, "{comma}{cell}").expect("a String accepts every write");
        }
        self.text.push('\n');
        self.rows += 1;
    }
}

/// `value` with at most `decimals` decimals and without needless zeros.
fn rounded(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let short = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => text.as_str(),
    };
    match short {
        "-0" => String::from("0"),
        short => short.to_owned(),
    }
}

/// A point uniform in the unit ball.
fn ball(random: &mut Random) -> DVec3 {
    random.direction() * libm::cbrt(random.unit())
}
