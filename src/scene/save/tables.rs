//! The files of a scene: tables while their rows are made, and the scene file at the end.

use std::fmt::Write as _;
use std::io::{self, Write};

use rayon::prelude::*;

use super::SaveError;
use crate::scene::colors::Texture;

/// The rows that are made at once by a thread, some 500 kB of text.
const BLOCK: usize = 1 << 12;

/// The blocks that are made before they are written.
const BLOCKS: usize = 32;

/// The outputs of a scene.
pub(super) struct Tables<'a, W> {
    stem: &'a str,
    create: &'a mut dyn FnMut(&str) -> io::Result<W>,
    complete: &'a mut dyn FnMut(W) -> io::Result<()>,
    /// How many are complete.
    count: usize,
}

impl<'a, W: Write> Tables<'a, W> {
    pub fn new(
        stem: &'a str,
        create: &'a mut dyn FnMut(&str) -> io::Result<W>,
        complete: &'a mut dyn FnMut(W) -> io::Result<()>,
    ) -> Self {
        Self {
            stem,
            create,
            complete,
            count: 0,
        }
    }

    /// Writes a table of numbers, with `count` rows below its header, and returns its name.
    /// `row` adds the row at a position, without the end of its line.
    pub fn add(
        &mut self,
        what: &str,
        header: &str,
        count: usize,
        row: impl Fn(&mut String, usize) + Sync,
    ) -> Result<String, SaveError> {
        self.add_file(what, "csv", |output| {
            writeln!(output, "{header}")?;
            for first in (0..count).step_by(BLOCK * BLOCKS) {
                let end = count.min(first + BLOCK * BLOCKS);
                let starts = (first..end).into_par_iter().step_by(BLOCK);
                let blocks = starts.map(|start| {
                    let mut text = String::new();
                    for position in start..end.min(start + BLOCK) {
                        row(&mut text, position);
                        text.push('\n');
                    }
                    text
                });
                for block in blocks.collect::<Vec<_>>() {
                    output.write_all(block.as_bytes())?;
                }
            }
            Ok(())
        })
    }

    /// Writes a file of any kind and returns its name.
    pub fn add_file(
        &mut self,
        what: &str,
        extension: &str,
        write: impl FnOnce(&mut W) -> io::Result<()>,
    ) -> Result<String, SaveError> {
        let name = format!("{}_{what}_{}.{extension}", self.stem, self.count + 1);
        self.output(&name, write)?;
        Ok(name)
    }

    /// Writes an image, and returns its name.
    pub fn image(&mut self, image: &Texture) -> Result<String, SaveError> {
        let name = format!("{}_image_{}.png", self.stem, self.count + 1);
        self.output(&name, |output| image.write(output))?;
        Ok(name)
    }

    /// Writes the scene file.
    pub fn finish(mut self, text: &str) -> Result<(), SaveError> {
        let name = format!("{}.toml", self.stem);
        self.output(&name, |output| output.write_all(text.as_bytes()))
    }

    /// Creates, writes and completes an output.
    fn output(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut W) -> io::Result<()>,
    ) -> Result<(), SaveError> {
        let written = (self.create)(name).and_then(|mut output| {
            write(&mut output)?;
            output.flush()?;
            (self.complete)(output)
        });
        self.count += 1;
        written.map_err(|source| SaveError::Output {
            name: name.to_owned(),
            source,
        })
    }
}

/// A cell with a name in quotes, which may contain delimiters. Names of columns contain no quotes.
pub(super) fn quoted_name(name: &str) -> String {
    format!("\"{name}\"")
}

/// The names of columns, each with as many underscores in front that it is no column of values.
pub(super) fn distinct<const N: usize>(names: [&str; N], columns: &[&str]) -> [String; N] {
    names.map(|name| {
        let mut name = name.to_owned();
        while columns.contains(&name.as_str()) {
            name.insert(0, '_');
        }
        name
    })
}

/// Adds a cell with a value, which is empty without one.
pub(super) fn push_value(row: &mut String, value: Option<f32>) {
    row.push(',');
    if let Some(value) = value {
        // A String accepts everything.
        let _ = write!(row, "{:?}", f64::from(value));
    }
}

/// Adds the cells of a row.
pub(super) fn push_cells(row: &mut String, numbers: &[f64]) {
    for (index, number) in numbers.iter().enumerate() {
        let separator = if index > 0 { "," } else { "" };
        // A String accepts everything.
        let _ = write!(row, "{separator}{number:?}");
    }
}
