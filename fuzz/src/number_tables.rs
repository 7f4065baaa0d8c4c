//! Tables of numbers that commands read: rays, points and hits of another program.

use std::path::Path;

use cyltrace::math::Ray;
use cyltrace::scene::{Decimal, Delimiter, GivenHits, NumberRow, NumberTable, TableFormat};
use glam::DVec3;

use super::scene_files::said;

/// The most hits that a table may have.
const MOST_HITS: usize = 1 << 16;

/// A table of rays; the first byte chooses the format that is stated.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn rays(bytes: &[u8]) {
    let is_finite = |ray: &Ray| ray.origin.is_finite() && ray.direction.is_finite();
    for ray in rows::<Ray>(bytes) {
        assert!(is_finite(&ray) && ray.is_valid(), "{ray:?}");
    }
}

/// A table of points; the first byte chooses the format that is stated.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn points(bytes: &[u8]) {
    for point in rows::<DVec3>(bytes) {
        assert!(point.is_finite(), "{point}");
    }
}

/// A table of hits; the first byte chooses the format that is stated.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn hits(bytes: &[u8]) {
    let Some((format, _, content)) = stated(bytes) else {
        return;
    };
    match GivenHits::read(content, Path::new("hits.csv"), format, MOST_HITS) {
        Ok(given) => {
            let numbers = given.hits.iter().filter_map(|hit| hit.t);
            assert!(numbers.into_iter().all(f64::is_finite), "{given:?}");
            let lines = given.hits.iter().map(|hit| hit.line);
            assert!(lines.is_sorted(), "{given:?}");
        }
        Err(error) => said(&error),
    }
}

/// The format that the first byte chooses, whether columns are numbered, and the rest.
fn stated(bytes: &[u8]) -> Option<(TableFormat, bool, &[u8])> {
    const DELIMITERS: [Option<Delimiter>; 5] = [
        None,
        Some(Delimiter::Comma),
        Some(Delimiter::Semicolon),
        Some(Delimiter::Tab),
        Some(Delimiter::Blanks),
    ];
    let (&choice, content) = bytes.split_first()?;
    let delimiter = DELIMITERS[usize::from(choice) % DELIMITERS.len()];
    let decimal = match choice & 64 {
        0 => Decimal::Point,
        _ => Decimal::Comma,
    };
    let format = TableFormat { delimiter, decimal };
    Some((format, choice & 128 != 0, content))
}

/// The rows of a table, the same however it is cut into blocks; none if it is refused.
fn rows<R: NumberRow>(bytes: &[u8]) -> Vec<R> {
    let Some((format, is_numbered, content)) = stated(bytes) else {
        return Vec::new();
    };
    let columns: Vec<u64> = match is_numbered {
        true => (0..R::REQUIRED as u64).collect(),
        false => Vec::new(),
    };
    let mut all = Vec::new();
    let mut read = || {
        let mut table = NumberTable::<R, _>::new(content, Path::new("a.csv"), format, &columns)?;
        let columns = table.columns();
        while let Some(block) = table.next_block()? {
            all.extend(columns.rows(&block)?);
        }
        Ok(())
    };
    let outcome: Result<(), cyltrace::scene::SceneError> = read();
    match outcome {
        Ok(()) => all,
        Err(error) => {
            said(&error);
            Vec::new()
        }
    }
}
