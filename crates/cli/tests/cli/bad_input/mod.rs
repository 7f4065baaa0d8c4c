//! Broken scenes and tables, each of which must be refused with a message that
//! names the file, the line and what would be right: by the library, and by
//! the program, which must leave no picture behind.

use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

mod files;
mod keys;
mod lattices;
mod prototypes;
mod rows;
mod set_operations;
mod solids;
use test_support::three_mf;
mod values;

/// More than any message needs, in bytes.
const LONGEST_MESSAGE: usize = 2_000;

/// A broken scene: `scene.toml`, other files, and what the message must hold.
pub struct Case {
    name: &'static str,
    scene: Cow<'static, [u8]>,
    files: Vec<(&'static str, Cow<'static, [u8]>)>,
    message: &'static [&'static str],
}

impl Case {
    fn new(
        name: &'static str,
        scene: impl Into<Cow<'static, str>>,
        message: &'static [&'static str],
    ) -> Self {
        Self::of_bytes(name, bytes(scene.into()), message)
    }

    fn of_bytes(
        name: &'static str,
        scene: impl Into<Cow<'static, [u8]>>,
        message: &'static [&'static str],
    ) -> Self {
        Self {
            name,
            scene: scene.into(),
            files: Vec::new(),
            message,
        }
    }

    fn with(mut self, file: &'static str, text: impl Into<Cow<'static, str>>) -> Self {
        self.files.push((file, bytes(text.into())));
        self
    }

    fn with_bytes(mut self, file: &'static str, bytes: impl Into<Cow<'static, [u8]>>) -> Self {
        self.files.push((file, bytes.into()));
        self
    }

    /// Writes the files to a folder of their own.
    fn write(&self) -> (TempDir, PathBuf) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let scene = folder.path().join("scene.toml");
        fs::write(&scene, &self.scene).expect("writing the scene");
        for (file, bytes) in &self.files {
            fs::write(folder.path().join(file), bytes).expect("writing a table");
        }
        (folder, scene)
    }

    /// What is wrong with the text of a refusal.
    fn problems(&self, text: &str) -> Vec<String> {
        let mut problems: Vec<_> = self
            .message
            .iter()
            .filter(|fragment| !text.contains(**fragment))
            .map(|fragment| format!("{}: {fragment:?} is missing in\n{text}\n", self.name))
            .collect();
        if text.len() > LONGEST_MESSAGE || text.contains('\u{1b}') {
            let start: String = text.chars().take(LONGEST_MESSAGE).collect();
            problems.push(format!(
                "{}: {} bytes, or control characters: {start:?}\n",
                self.name,
                text.len()
            ));
        }
        problems
    }
}

fn bytes(text: Cow<'static, str>) -> Cow<'static, [u8]> {
    match text {
        Cow::Borrowed(text) => text.as_bytes().into(),
        Cow::Owned(text) => text.into_bytes().into(),
    }
}

fn cases() -> Vec<Case> {
    [
        files::cases(),
        keys::cases(),
        values::cases(),
        prototypes::cases(),
        rows::cases(),
        solids::cases(),
        set_operations::cases(),
        lattices::cases(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The message of the library for a scene that it must refuse.
fn refusal(name: &str, scene: &Path) -> String {
    match cyltrace::scene::load(scene) {
        Err(error) => error.to_string(),
        Ok(_) => format!("{name} was loaded"),
    }
}

#[test]
fn load_of_every_broken_scene_says_where_and_why() {
    let cases = cases();
    assert!(cases.len() >= 40, "{} cases", cases.len());
    let mut problems = Vec::new();
    for case in &cases {
        let (_folder, scene) = case.write();
        problems.extend(case.problems(&refusal(case.name, &scene)));
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn case_names_are_unique() {
    let mut names: Vec<_> = cases().iter().map(|case| case.name).collect();
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn load_of_no_file_and_of_a_folder_says_so() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let missing = refusal("missing", &folder.path().join("missing.toml"));
    assert!(
        missing.contains("missing.toml: the file does not exist"),
        "{missing}"
    );
    let directory = refusal("folder", folder.path());
    assert!(
        directory.contains("it is a directory: a file is needed"),
        "{directory}"
    );
}

#[test]
fn load_of_data_or_a_picture_shows_the_scene_that_it_needs() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, content, expected) in [
        (
            "tree.csv",
            &b"a,b\n1,2\n"[..],
            ["this is a table", "file = \"tree.csv\""],
        ),
        (
            "n.SWC",
            b"1 1 0 0 0 1 -1\n",
            ["this is a neuron", "[[swc]]\nfile = \"n.SWC\""],
        ),
        (
            "l.3mf",
            b"PK\x03\x04",
            [
                "this is a model in 3MF",
                "[[beam_lattice]]\nfile = \"l.3mf\"",
            ],
        ),
        (
            "p.png",
            b"\x89PNG\r\n\x1a\n",
            ["this is a picture", "[[cylinder_table]]\nfile"],
        ),
    ] {
        let path = folder.path().join(name);
        fs::write(&path, content).expect("written");
        let text = refusal(name, &path);
        for fragment in expected.into_iter().chain(["a scene is a TOML file"]) {
            assert!(
                text.contains(fragment),
                "{name}: {fragment:?} not in {text}"
            );
        }
    }
    let missing = refusal("missing", &folder.path().join("missing.csv"));
    assert!(missing.contains("the file does not exist"), "{missing}");
}

#[test]
fn render_of_every_broken_scene_exits_with_2_and_leaves_no_picture() {
    let mut problems = Vec::new();
    for case in &cases() {
        let (folder, scene) = case.write();
        let text = render_refusal(case.name, folder.path(), &scene);
        problems.extend(case.problems(&text));
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));

    let folder = tempfile::tempdir().expect("a temporary folder");
    let missing = render_refusal(
        "missing",
        folder.path(),
        &folder.path().join("missing.toml"),
    );
    assert!(
        missing.contains("missing.toml: the file does not exist"),
        "{missing}"
    );
}

/// What the program prints about a scene that it must refuse.
fn render_refusal(name: &str, folder: &Path, scene: &Path) -> String {
    let before = listing(folder);
    let output = assert_cmd::Command::cargo_bin("cyltrace")
        .expect("the program")
        .arg("render")
        .arg(scene)
        .arg("-o")
        .arg(folder.join("out.png"))
        .output()
        .expect("running the program");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{name}: {text}");
    assert_eq!(listing(folder), before, "{name}: a file was left behind");
    text
}

fn listing(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<_> = fs::read_dir(folder)
        .expect("the folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    paths
}
