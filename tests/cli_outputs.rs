//! Outputs of the commands: none may destroy an input or another output, and
//! what cannot be written is said in plain words.

use std::fs;
use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

const SCENE: &str = r#"
[[cylinder_table]]
file = "tree.csv"
columns = { p0 = ["a", "b", "c"], p1 = ["d", "e", "f"], radius = "r" }
degenerate = "skip"

[[prototype]]
name = "neuron"
[[prototype.swc]]
file = "neuron.swc"

[[instance_table]]
of = "neuron"
file = "places.csv"
columns = { position = ["x", "y", "z"] }
"#;

const FILES: [(&str, &str); 5] = [
    ("scene.toml", SCENE),
    ("tree.csv", "a,b,c,d,e,f,r\n0,0,0,0,0,1,1\n0,0,0,0,0,1,0\n"),
    ("neuron.swc", "1 1 0 0 0 1 -1\n2 1 0 0 1 1 1\n"),
    ("places.csv", "x,y,z\n9,0,0\n"),
    ("rays.csv", "ox,oy,oz,dx,dy,dz\n-4,0,0.5,1,0,0\n"),
];

fn workplace() -> TempDir {
    let directory = tempfile::tempdir().expect("directory");
    for (name, text) in FILES {
        fs::write(directory.path().join(name), text).expect("written");
    }
    fs::create_dir(directory.path().join("sub")).expect("directory");
    directory
}

fn command(directory: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cyltrace"));
    command.current_dir(directory).args(arguments);
    command
}

fn cyltrace(directory: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = command(directory, arguments).output().expect("it runs");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8 output");
    let code = output.status.code().expect("no signal");
    (code, text(output.stdout), text(output.stderr))
}

/// The words of a command line without quoting.
fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// Runs a command that must be refused, name its reasons, and change nothing.
fn refused(directory: &Path, line: &str, expected: &[&str]) {
    let count = fs::read_dir(directory).expect("readable").count();
    let (code, out, err) = cyltrace(directory, &words(line));
    assert_eq!((code, out.as_str()), (2, ""), "{line}: {err}");
    for fragment in expected {
        assert!(err.contains(fragment), "{line}: {fragment:?} not in {err}");
    }
    for (name, text) in FILES {
        let now = fs::read_to_string(directory.join(name)).expect("still there");
        assert_eq!(now, text, "{line} changed {name}");
    }
    let left = fs::read_dir(directory).expect("readable").count();
    assert_eq!(left, count, "{line} left a file");
}

#[test]
fn output_that_is_an_input_refused_with_both_names() {
    let directory = workplace();
    let trace = "trace scene.toml --rays rays.csv";
    let destroys = "would destroy";
    for (line, expected) in [
        (
            format!("{trace} -o rays.csv"),
            ["-o \"rays.csv\"", "table of rays \"rays.csv\""],
        ),
        (
            format!("{trace} -o ./sub/../rays.csv"),
            ["-o \"./sub/../rays.csv\"", "\"rays.csv\""],
        ),
        (
            format!("{trace} -o scene.toml"),
            ["-o \"scene.toml\"", "the scene file"],
        ),
        (
            format!("{trace} -o h.csv --json rays.csv"),
            ["--json \"rays.csv\"", "table of rays"],
        ),
        (
            format!("{trace} -o places.csv"),
            ["-o \"places.csv\"", "\"places.csv\": it is"],
        ),
        (
            format!("{trace} -o h.csv --json tree.csv"),
            ["--json", "\"tree.csv\": it is"],
        ),
        (
            format!("{trace} -o neuron.swc"),
            ["-o", "\"neuron.swc\": it is"],
        ),
        (
            "info scene.toml --json scene.toml".into(),
            ["--json", "the scene file"],
        ),
        (
            "info scene.toml --json neuron.swc".into(),
            ["--json", "\"neuron.swc\": it is"],
        ),
        (
            "render scene.toml -o a.png --json tree.csv".into(),
            ["--json", "\"tree.csv\""],
        ),
    ] {
        refused(
            directory.path(),
            &line,
            &[destroys, expected[0], expected[1]],
        );
    }
}

#[test]
fn two_outputs_to_one_place_refused() {
    let directory = workplace();
    let trace = "trace scene.toml --rays rays.csv";
    for (line, expected) in [
        (
            format!("{trace} -o new.csv --json sub/../new.csv"),
            "are the same file",
        ),
        (
            "render scene.toml -o a.png --json ./a.png".into(),
            "are the same file",
        ),
        (
            format!("{trace} -o - --json -"),
            "both write to standard output",
        ),
    ] {
        refused(directory.path(), &line, &["-o", "--json", expected]);
    }
    // Devices are not replaced.
    let line = format!("{trace} -o /dev/null --json /dev/null");
    assert_eq!(cyltrace(directory.path(), &words(&line)).0, 0);
}

#[cfg(unix)]
#[test]
fn output_that_is_a_link_to_an_input_refused() {
    let directory = workplace();
    let at = |name| directory.path().join(name);
    std::os::unix::fs::symlink("scene.toml", at("link.png")).expect("linked");
    fs::hard_link(at("rays.csv"), at("hard.csv")).expect("linked");
    refused(
        directory.path(),
        "render scene.toml -o link.png",
        &["would destroy", "link.png", "scene.toml"],
    );
    refused(
        directory.path(),
        "trace scene.toml --rays rays.csv -o hard.csv",
        &["would destroy", "hard.csv", "rays.csv"],
    );
}
