//! That no output of a command destroys one of its inputs, or another output.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::bail;
use cyltrace::scene::SceneFile;
use cyltrace_output::followed;

use super::output_sink::is_standard_stream;

/// The files of a command, each with what it is to the user.
pub struct Files<'a> {
    inputs: Vec<(&'static str, PathBuf)>,
    outputs: Vec<(&'static str, &'a Path)>,
}

impl<'a> Files<'a> {
    /// The scene file, and the figures where they are asked for.
    pub fn new(scene: &Path, json: Option<&'a Path>) -> Self {
        Self {
            inputs: vec![("the scene file", scene.into())],
            outputs: json.map(|path| ("--json", path)).into_iter().collect(),
        }
    }

    /// One more file that is read.
    pub fn input(mut self, what: &'static str, path: &Path) -> Self {
        if !is_standard_stream(path) {
            self.inputs.push((what, path.into()));
        }
        self
    }

    /// One more file that is written.
    pub fn output(mut self, option: &'static str, path: &'a Path) -> Self {
        self.outputs.push((option, path));
        self
    }

    /// Refuses outputs that are inputs, or each other.
    pub fn check(&self) -> anyhow::Result<()> {
        for (number, (option, output)) in self.outputs.iter().enumerate() {
            for (other, path) in &self.outputs[..number] {
                if is_standard_stream(output) && is_standard_stream(path) {
                    bail!(
                        "{option} and {other} both write to standard output: send one of them to a file"
                    );
                }
                if is_same(output, path) {
                    bail!(
                        "{option} {output:?} and {other} {path:?} are the same file: one would destroy the other"
                    );
                }
            }
            for (what, path) in &self.inputs {
                if is_same(output, path) {
                    bail!(
                        "{option} {output:?} would destroy {what} {path:?}: it is the same file; choose another name"
                    );
                }
            }
        }
        Ok(())
    }

    /// The same for the files that the scene file names.
    pub fn check_with(mut self, scene: &SceneFile) -> anyhow::Result<()> {
        let files = scene.files().into_iter();
        self.inputs
            .extend(files.map(|path| ("a file of the scene,", path)));
        self.check()
    }
}

/// Whether two paths name one file, which writing would replace. Devices and
/// pipes are not replaced.
fn is_same(a: &Path, b: &Path) -> bool {
    if is_standard_stream(a) || is_standard_stream(b) {
        return false;
    }
    match (fs::metadata(a), fs::metadata(b)) {
        (Ok(of_a), Ok(of_b)) => {
            of_a.is_file() && of_b.is_file() && is_same_file(a, b, &of_a, &of_b)
        }
        (Err(_), Err(_)) => match (new_name(a), new_name(b)) {
            (Some(a), Some(b)) => a == b,
            _ => false,
        },
        _ => false,
    }
}

#[cfg(unix)]
fn is_same_file(_: &Path, _: &Path, a: &fs::Metadata, b: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn is_same_file(a: &Path, b: &Path, _: &fs::Metadata, _: &fs::Metadata) -> bool {
    matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b)
}

/// The name that a file which does not exist would get, whatever the way to
/// its directory.
fn new_name(path: &Path) -> Option<PathBuf> {
    let path = followed(path).ok()?;
    let directory = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    Some(fs::canonicalize(directory).ok()?.join(path.file_name()?))
}
