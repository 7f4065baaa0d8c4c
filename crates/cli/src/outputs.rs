//! Rejects outputs that would destroy an input of the command, or another output.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::bail;
use cyltrace::scene::SceneFile;
use cyltrace_output::followed;

use super::output_sink::is_standard_stream;

/// The files of a command, each with its role in messages.
pub struct Files<'a> {
    inputs: Vec<(&'static str, PathBuf)>,
    outputs: Vec<(&'static str, &'a Path)>,
}

impl<'a> Files<'a> {
    /// The scene file, and the JSON if it is written.
    pub fn new(scene: &Path, json: Option<&'a Path>) -> Self {
        let mut files = Self::without_scene(json);
        files.inputs.push(("the scene file", scene.into()));
        files
    }

    /// The JSON if it is written.
    pub fn without_scene(json: Option<&'a Path>) -> Self {
        Self {
            inputs: Vec::new(),
            outputs: json.map(|path| ("--json", path)).into_iter().collect(),
        }
    }

    /// Adds a file that is read.
    pub fn input(mut self, what: &'static str, path: &Path) -> Self {
        if !is_standard_stream(path) {
            self.inputs.push((what, path.into()));
        }
        self
    }

    /// Adds a file that is written.
    pub fn output(mut self, option: &'static str, path: &'a Path) -> Self {
        self.outputs.push((option, path));
        self
    }

    /// Rejects outputs that are inputs, or each other.
    pub fn check(&self) -> anyhow::Result<()> {
        for (number, (option, output)) in self.outputs.iter().enumerate() {
            for (other, path) in &self.outputs[..number] {
                if is_standard_stream(output) && is_standard_stream(path) {
                    bail!(
                        "{option} and {other} both write to standard output: write one of them to a file"
                    );
                }
                if is_same(output, path) {
                    bail!(
                        "{option} {output:?} and {other} {path:?} are the same file: choose different names"
                    );
                }
            }
            for (what, path) in &self.inputs {
                if is_same(output, path) {
                    bail!(
                        "{option} {output:?} is the same file as {what} {path:?} and would overwrite it: choose another name"
                    );
                }
            }
        }
        Ok(())
    }

    /// Rejects outputs that are inputs, those that the scene file names included.
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
        (Ok(of_a), Ok(of_b)) if of_a.is_file() && of_b.is_file() => {
            // Files that cannot be opened are compared by their names.
            same_file::is_same_file(a, b).unwrap_or_else(|_| a == b)
        }
        (Err(_), Err(_)) => match (new_name(a), new_name(b)) {
            (Some(a), Some(b)) => a == b,
            _ => false,
        },
        _ => false,
    }
}

/// The path of a file that does not exist, with its directory in canonical form.
fn new_name(path: &Path) -> Option<PathBuf> {
    let path = followed(path).ok()?;
    let directory = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    Some(fs::canonicalize(directory).ok()?.join(path.file_name()?))
}
