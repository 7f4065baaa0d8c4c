//! What parts there are in a folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::error::PartError;
use super::file::PartFile;

/// The parts in a folder.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    /// The results that there are parts of, in the order of the names of their first parts.
    pub wholes: Vec<Whole>,
    /// The parts that are damaged or have another format.
    pub damaged: Vec<Damaged>,
}

/// A result, and its parts that are there.
#[derive(Clone, Debug)]
pub struct Whole {
    /// Its valid parts, in the order of their ranges.
    pub parts: Vec<PartFile>,
}

/// A part that cannot be used.
#[derive(Clone, Debug)]
pub struct Damaged {
    /// The file.
    pub path: PathBuf,
    /// Why it cannot be used, as a sentence that names the file.
    pub reason: String,
}

impl Survey {
    /// Reads the parts in a folder, not in folders within it. Other files are skipped.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn of(folder: &Path) -> io::Result<Self> {
        let entries: Result<Vec<_>, _> = fs::read_dir(folder)?.collect();
        let mut paths: Vec<PathBuf> = entries?.iter().map(fs::DirEntry::path).collect();
        paths.retain(|path| path.is_file());
        paths.sort();
        let mut survey = Self::default();
        for path in paths {
            match PartFile::read(&path) {
                Ok(part) => survey.add(part),
                Err(PartError::NotAPart { .. }) => {}
                Err(error) => survey.damaged.push(Damaged {
                    path,
                    reason: error.to_string(),
                }),
            }
        }
        for whole in &mut survey.wholes {
            whole.parts.sort_by_key(|part| part.header().range.start);
        }
        Ok(survey)
    }

    fn add(&mut self, part: PartFile) {
        let same = |whole: &&mut Whole| {
            let first = whole.parts[0].header();
            let other = part.header();
            (&first.command, &first.fingerprint) == (&other.command, &other.fingerprint)
        };
        match self.wholes.iter_mut().find(same) {
            Some(whole) => whole.parts.push(part),
            None => self.wholes.push(Whole { parts: vec![part] }),
        }
    }
}

impl Whole {
    /// The numbers of missing parts, in the division that its first part is of, or `None` if
    /// its parts are of several divisions.
    #[must_use]
    pub fn missing(&self) -> Option<Vec<u64>> {
        let of = self.parts[0].header().number.of();
        let numbers = self.parts.iter().map(|part| part.header().number);
        let numbers: Option<Vec<u64>> = numbers
            .map(|number| (number.of() == of).then(|| number.number()))
            .collect();
        let numbers: std::collections::HashSet<u64> = numbers?.into_iter().collect();
        Some(
            (1..=of)
                .filter(|number| !numbers.contains(number))
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::{Header, PartWriter};
    use crate::number::PartNumber;
    use serde_json::json;

    #[test]
    fn folder_with_parts_of_two_results_and_other_files() {
        let folder = tempfile::tempdir().expect("directory");
        let write = |name: &str, number: u64, of: u64, fingerprint: &str| {
            let number = PartNumber::new(number, of).expect("valid");
            let header = Header {
                version: "0.1.0".into(),
                command: "render".into(),
                number,
                unit: "tiles".into(),
                range: number.range(100),
                whole: 100,
                settings: json!({}),
                fingerprint: fingerprint.into(),
            };
            let path = folder.path().join(name);
            let writer = PartWriter::create(&path, &header).expect("created");
            writer.finish(&json!({})).expect("finished");
            path
        };
        for number in [5, 1, 3] {
            write(&format!("a{number}"), number, 5, "aa");
        }
        write("b1", 1, 2, "bb");
        write("b2", 2, 2, "bb");
        let cut = write("c", 1, 1, "cc");
        fs::write(&cut, &fs::read(&cut).expect("read")[..200]).expect("written");
        fs::write(folder.path().join("notes.txt"), "no part").expect("written");
        fs::create_dir(folder.path().join("folder")).expect("created");

        let survey = Survey::of(folder.path()).expect("readable");
        let missing: Vec<_> = survey.wholes.iter().map(Whole::missing).collect();
        assert_eq!(missing, [Some(vec![2, 4]), Some(vec![])]);
        assert_eq!(survey.damaged.len(), 1);
        assert_eq!(survey.damaged[0].path, cut);
    }
}
