//! Tables of numbers that commands read: rays, points and hits of another program.

use std::ops::Range;
use std::path::Path;

use cyltrace::math::Ray;
use cyltrace::scene::{
    Decimal, Delimiter, GivenHits, NumberRow, NumberTable, SceneError, TableFormat,
};
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

/// A table of points, as [`points`], read whole and in up to 16 ranges of its bytes. The ranges
/// contain the rows of the whole, or both are refused, or a range is refused because a row is on
/// several lines.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn point_ranges(bytes: &[u8]) {
    let Some((&choice, rest)) = bytes.split_first() else {
        return;
    };
    let Some((format, _, content)) = stated(rest) else {
        return;
    };
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), content).expect("written");
    let whole = read_range(file.path(), format, 0..u64::MAX);
    let (count, length) = (u64::from(choice % 16) + 1, content.len() as u64);
    let ranges = (0..count).map(|part| part * length / count..(part + 1) * length / count);
    let parts: Result<Vec<Vec<DVec3>>, String> = ranges
        .map(|range| read_range(file.path(), format, range))
        .collect();
    match (whole, parts) {
        (Ok(whole), Ok(parts)) => assert_eq!(whole, parts.concat()),
        // Of several faults, either may be found first.
        (Err(_), Err(_)) => {}
        (Ok(_), Err(part)) => assert!(part.contains("on one line"), "{part}"),
        (Err(whole), Ok(_)) => panic!("only the whole is refused: {whole}"),
    }
}

/// The points of a range, or the message of the error.
fn read_range(path: &Path, format: TableFormat, range: Range<u64>) -> Result<Vec<DVec3>, String> {
    let table = NumberTable::<DVec3>::open_range(path, format, &[], range);
    let mut table = table.map_err(|error| error.to_string())?;
    let columns = table.columns();
    let mut all = Vec::new();
    let mut read = || {
        while let Some(block) = table.next_block()? {
            all.extend(columns.rows(&block)?);
        }
        Ok(())
    };
    let outcome: Result<(), SceneError> = read();
    match outcome {
        Ok(()) => Ok(all),
        Err(error) => Err(error.to_string()),
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
    let outcome: Result<(), SceneError> = read();
    match outcome {
        Ok(()) => all,
        Err(error) => {
            said(&error);
            Vec::new()
        }
    }
}
