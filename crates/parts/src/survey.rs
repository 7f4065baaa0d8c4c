//! Lists the parts in a folder.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use cyltrace_output::is_unfinished;

use super::error::PartError;
use super::file::PartFile;
use super::set::PartSet;

/// The parts in a folder.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    /// Results with at least one part, in the order of the names of their first parts.
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
    /// Reads the parts in a folder, not in folders within it. Other files are skipped, and so
    /// are the temporary files of processes that were killed.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn of(folder: &Path) -> io::Result<Self> {
        let entries: Result<Vec<_>, _> = fs::read_dir(folder)?.collect();
        let mut paths: Vec<PathBuf> = entries?.iter().map(fs::DirEntry::path).collect();
        paths.retain(|path| path.is_file() && !is_unfinished(path));
        paths.sort();
        let mut survey = Self::default();
        for path in paths {
            match PartFile::read(&path) {
                Ok(part) => survey.add(part),
                Err(PartError::NotAPart { .. }) => {}
                Err(error) => survey.damaged.push(Damaged {
                    path,
                    reason: with_source(&error),
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

/// An error and its cause.
fn with_source(error: &PartError) -> String {
    match std::error::Error::source(error) {
        Some(source) => format!("{error}: {source}"),
        None => error.to_string(),
    }
}

impl Whole {
    /// Whether the parts make up the result.
    ///
    /// # Errors
    /// What is missing, or contained twice.
    pub fn check(&self) -> Result<(), PartError> {
        PartSet::new(self.parts.clone()).map(|_| ())
    }

    /// The numbers of missing parts; `None` if some parts were made with another number of
    /// parts than the first.
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
    use crate::file::PartWriter;
    use crate::file::tests::header;
    use serde_json::json;

    #[test]
    fn folder_with_parts_of_two_results_and_other_files() {
        let folder = tempfile::tempdir().expect("directory");
        let write = |name: &str, number: u64, of: u64, fingerprint: &str| {
            let mut header = header(number, of);
            header.fingerprint = fingerprint.into();
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
        // As a process leaves it that is killed.
        fs::copy(&cut, folder.path().join(".cyltrace-ab12")).expect("copied");
        fs::create_dir(folder.path().join("folder")).expect("created");

        let survey = Survey::of(folder.path()).expect("readable");
        let missing: Vec<_> = survey.wholes.iter().map(Whole::missing).collect();
        assert_eq!(missing, [Some(vec![2, 4]), Some(vec![])]);
        assert!(survey.wholes[0].check().is_err());
        assert!(survey.wholes[1].check().is_ok());
        assert_eq!(survey.damaged.len(), 1);
        assert_eq!(survey.damaged[0].path, cut);
    }
}
