//! Outputs of the commands: none may destroy an input or another output, and
//! what cannot be written is said in plain words.

use crate::program;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use program::{command, cyltrace, folder_of, words};
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
    let directory = folder_of(&FILES);
    fs::create_dir(directory.path().join("sub")).expect("directory");
    directory
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
    let overwrites = "would overwrite";
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
            ["-o \"places.csv\"", "\"places.csv\" and would"],
        ),
        (
            format!("{trace} -o h.csv --json tree.csv"),
            ["--json", "\"tree.csv\" and would"],
        ),
        (
            format!("{trace} -o neuron.swc"),
            ["-o", "\"neuron.swc\" and would"],
        ),
        (
            "info scene.toml --json scene.toml".into(),
            ["--json", "the scene file"],
        ),
        (
            "info scene.toml --json neuron.swc".into(),
            ["--json", "\"neuron.swc\" and would"],
        ),
        (
            "render scene.toml -o a.png --json tree.csv".into(),
            ["--json", "\"tree.csv\""],
        ),
    ] {
        refused(
            directory.path(),
            &line,
            &[overwrites, expected[0], expected[1]],
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
        &["would overwrite", "link.png", "scene.toml"],
    );
    refused(
        directory.path(),
        "trace scene.toml --rays rays.csv -o hard.csv",
        &["would overwrite", "hard.csv", "rays.csv"],
    );
}

#[test]
fn skipped_rows_counted_in_text_and_json_of_every_command() {
    let directory = workplace();
    for line in [
        "info scene.toml",
        "render scene.toml -o a.png --size 8x8",
        "trace scene.toml --rays rays.csv -o h.csv",
    ] {
        let (code, out, err) = cyltrace(directory.path(), &words(line));
        assert_eq!(code, 0, "{line}: {err}");
        let told = out
            .matches("skipped: degenerate rows of tables: 1\n")
            .count();
        assert_eq!(told, 1, "{line}: {out}");
        let (_, out, _) = cyltrace(directory.path(), &words(&format!("{line} --json -")));
        let figures: serde_json::Value = serde_json::from_str(&out).expect("JSON");
        assert_eq!(figures["skipped_rows"], 1, "{line}");
    }
}

#[test]
fn bounds_that_touch_zero_printed_short() {
    let directory = workplace();
    let (_, out, _) = cyltrace(directory.path(), &["info", "scene.toml"]);
    let bounds = out
        .lines()
        .find(|line| line.starts_with("bounds: "))
        .expect(&out);
    assert!(bounds.len() < 200, "{bounds}");
}

const LINES: [&str; 8] = [
    "--help",
    "render --help",
    "--version",
    "info scene.toml",
    "info scene.toml --json -",
    "render scene.toml -o a.png --size 8x8",
    "trace scene.toml --rays rays.csv -o -",
    "trace scene.toml --rays rays.csv -o h.csv",
];

/// Starts a command whose standard output nobody reads; gives its code and
/// what it says.
fn into_closed_pipe(directory: &Path, line: &str) -> (Option<i32>, String) {
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let mut command = command(directory, &words(line));
    let output = command
        .stdout(writer)
        .stderr(Stdio::piped())
        .output()
        .expect("it runs");
    (
        output.status.code(),
        String::from_utf8_lossy(&output.stderr).into(),
    )
}

#[cfg(unix)]
#[test]
fn closed_pipe_ends_every_command_quietly() {
    let directory = workplace();
    for line in LINES {
        let (code, err) = into_closed_pipe(directory.path(), line);
        assert_eq!((code, err.as_str()), (Some(0), ""), "{line}");
    }
    // The figures asked for are written all the same.
    let (code, _) = into_closed_pipe(directory.path(), "info scene.toml --json a.json");
    assert_eq!(code, Some(0));
    assert!(directory.path().join("a.json").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn full_standard_output_named_and_exits_2() {
    let directory = workplace();
    for line in LINES {
        let full = fs::File::create("/dev/full").expect("a full device");
        let mut command = command(directory.path(), &words(line));
        let output = command
            .stdout(full)
            .stderr(Stdio::piped())
            .output()
            .expect("it runs");
        let err = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {err}");
        assert!(
            err.starts_with("error: cannot write to standard output: ") && err.lines().count() == 1,
            "{line}: {err}"
        );
    }
}

#[cfg(unix)]
#[test]
fn interrupted_trace_to_standard_output_does_not_claim_that_nothing_was_written() {
    use std::io::{BufRead, BufReader, Read};
    let directory = workplace();
    let rays = "ox,oy,oz,dx,dy,dz\n".to_owned() + &"-4,0,0.5,1,0,0\n".repeat(400_000);
    fs::write(directory.path().join("many.csv"), rays).expect("written");
    let mut child = command(
        directory.path(),
        &words("trace scene.toml --rays many.csv -o -"),
    )
    .stdout(Stdio::piped())
    .stderr(Stdio::piped())
    .spawn()
    .expect("it runs");
    // Once rows come it is under way; then the pipe fills, and it waits.
    let mut rows = BufReader::new(child.stdout.take().expect("piped"));
    let mut line = String::new();
    rows.read_line(&mut line).expect("a header");
    rows.read_line(&mut line).expect("a row");
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .expect("kill runs");
    assert!(sent.success());
    std::thread::sleep(std::time::Duration::from_millis(200));
    std::io::copy(&mut rows, &mut std::io::sink()).expect("read");
    let mut err = String::new();
    child
        .stderr
        .take()
        .expect("piped")
        .read_to_string(&mut err)
        .expect("text");
    assert_eq!(child.wait().expect("a status").code(), Some(130), "{err}");
    assert_eq!(
        err,
        "error: interrupted; the table written so far is incomplete\n"
    );
}
