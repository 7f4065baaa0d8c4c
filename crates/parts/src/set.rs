//! The parts of one whole result.

use std::path::PathBuf;

use super::error::PartError;
use super::file::PartFile;
use super::header::{Header, difference};

/// Parts that together are one whole result, in the order of their ranges.
#[derive(Clone, Debug)]
pub struct PartSet {
    parts: Vec<PartFile>,
}

impl PartSet {
    /// Reads parts in any order. They may differ in the number of parts that they are of, as
    /// long as their ranges fit together.
    ///
    /// # Errors
    /// If there is none, one is damaged or belongs to another result, or their ranges leave a
    /// gap or overlap.
    pub fn read(paths: &[PathBuf]) -> Result<Self, PartError> {
        let parts: Result<Vec<_>, _> = paths.iter().map(|path| PartFile::read(path)).collect();
        Self::new(parts?)
    }

    /// Orders parts; see [`PartSet::read`].
    pub(crate) fn new(mut parts: Vec<PartFile>) -> Result<Self, PartError> {
        let first = parts.first().ok_or(PartError::None)?.clone();
        for part in &parts[1..] {
            if let Some(difference) = difference(first.header(), part.header()) {
                return Err(PartError::Foreign {
                    path: part.path().into(),
                    first: first.path().into(),
                    difference,
                });
            }
        }
        // An empty range at the end of another follows it.
        parts.sort_by_key(|part| (part.header().range.start, part.header().range.end));
        let whole = first.header().whole;
        let unit = &first.header().unit;
        let gap = |before: Option<&PartFile>, from: u64, end: u64| PartError::Gap {
            before: before.map(|part| part.path().into()),
            unit: unit.clone(),
            from,
            to: end - 1,
            whole,
        };
        let mut before: Option<&PartFile> = None;
        for part in &parts {
            let end = before.map_or(0, |part| part.header().range.end);
            let range = &part.header().range;
            if range.start > end {
                return Err(gap(before, end, range.start));
            }
            if let Some(before) = before.filter(|_| range.start < end && !range.is_empty()) {
                return Err(PartError::Overlap {
                    first: before.path().into(),
                    second: part.path().into(),
                    unit: unit.clone(),
                    from: range.start,
                    to: end.min(range.end) - 1,
                });
            }
            if !range.is_empty() {
                before = Some(part);
            }
        }
        let end = before.map_or(0, |part| part.header().range.end);
        match end < whole {
            true => Err(gap(before, end, whole)),
            false => Ok(Self { parts }),
        }
    }

    /// The parts in the order of their ranges, at least one.
    #[must_use]
    pub fn parts(&self) -> &[PartFile] {
        &self.parts
    }

    /// The header of the first part. All parts agree in the command, the settings and the
    /// number of units.
    #[must_use]
    pub fn header(&self) -> &Header {
        self.parts[0].header()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::PartWriter;
    use crate::file::tests::header;
    use serde_json::json;
    use std::io::Write;
    use std::path::Path;

    /// A part with a range of units, whose header `change` changes.
    fn part(folder: &Path, name: &str, numbers: (u64, u64), change: fn(&mut Header)) -> PathBuf {
        let mut header = header(numbers.0, numbers.1);
        change(&mut header);
        let path = folder.join(name);
        let mut writer = PartWriter::create(&path, &header).expect("created");
        writer.write_all(b"payload").expect("written");
        writer.finish(&json!({})).expect("finished");
        path
    }

    #[test]
    fn parts_in_any_order_and_of_several_divisions_are_a_whole() {
        let folder = tempfile::tempdir().expect("directory");
        let folder = folder.path();
        let same = |_: &mut Header| {};
        let paths = [
            part(folder, "d", (4, 4), same),
            part(folder, "a", (1, 2), same),
            part(folder, "c", (3, 4), same),
        ];
        let set = PartSet::read(&paths).expect("whole");
        let starts: Vec<_> = set
            .parts()
            .iter()
            .map(|part| part.header().range.start)
            .collect();
        assert_eq!(starts, [0, 50, 75]);

        // More parts than units: some are empty.
        let many: Vec<_> = (1..=130)
            .map(|number| part(folder, &format!("m{number}"), (number, 130), same))
            .collect();
        assert!(PartSet::read(&many).is_ok());
    }

    #[test]
    fn parts_that_are_no_whole_are_refused_by_name() {
        let folder = tempfile::tempdir().expect("directory");
        let folder = folder.path();
        let same = |_: &mut Header| {};
        let first = part(folder, "first", (1, 4), same);
        let second = part(folder, "second", (2, 4), same);
        let third = part(folder, "third", (3, 4), same);
        let last = part(folder, "last", (4, 4), same);
        let half = part(folder, "half", (1, 2), same);
        let spp = part(folder, "spp", (4, 4), |header| {
            header.settings = json!({ "spp": 8, "seed": 0 });
        });
        let scene = part(folder, "scene", (4, 4), |header| {
            header.fingerprint = "11".into()
        });
        let other = part(folder, "other", (4, 4), |header| {
            header.command = "trace".into()
        });
        let old = part(folder, "old", (4, 4), |header| {
            header.version = "0.0.9".into()
        });
        let refused = |paths: &[&PathBuf], words: &[&str]| {
            let paths: Vec<_> = paths.iter().map(|&path| path.clone()).collect();
            let message = PartSet::read(&paths).expect_err("no whole").to_string();
            for word in words {
                assert!(message.contains(word), "{message}");
            }
        };
        refused(&[], &["no part"]);
        refused(
            &[&second, &third, &last],
            &["missing", "tiles 0 to 24 of 100", "before the first"],
        );
        refused(
            &[&first, &third, &last],
            &["missing", "tiles 25 to 49", "after", "first"],
        );
        refused(
            &[&first, &second, &third],
            &["missing", "tiles 75 to 99", "third"],
        );
        refused(
            &[&half, &second, &third, &last],
            &["overlap", "half", "second", "tiles 25 to 49"],
        );
        refused(
            &[&first, &first, &second, &third, &last],
            &["overlap", "tiles 0 to 24"],
        );
        refused(
            &[&first, &second, &third, &spp],
            &["spp", "its spp is 8, not 4"],
        );
        refused(
            &[&first, &second, &third, &scene],
            &["scene", "another content"],
        );
        refused(
            &[&first, &second, &third, &other],
            &["other", "trace, not render"],
        );
        refused(
            &[&first, &second, &third, &old],
            &["old", "0.0.9, not 0.1.0"],
        );
    }
}
