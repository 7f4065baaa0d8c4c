//! Signals: every command ends within a second while it waits or computes,
//! with the documented exit code and without a file that was not finished.
//!
//! A command that does not end fails by its timeout, which is generous, since tests
//! share the machine.

#![cfg(target_os = "linux")]

use crate::program;

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use program::{command, folder_of, words};

/// After this a command hangs.
const TIMEOUT: Duration = Duration::from_secs(30);

const SIGHUP: u32 = 1;
const SIGINT: u32 = 2;

const CYLINDER: &str = "[[cylinder]]\np0 = [0, 0, 0]\np1 = [0, 0, 1]\nradius = 1\n";

const RAY: &str = "ox,oy,oz,dx,dy,dz\n-50,0,0.5,1,0,0\n";

/// 64 levels that each place the next 8 times: 2^192 cylinders on one ray.
fn deep() -> String {
    let mut scene = "[[instance]]\nof = \"p1\"\n".to_owned();
    for level in 1..64 {
        scene += &format!("[[prototype]]\nname = \"p{level}\"\n");
        for place in 0..8 {
            scene += &format!(
                "[[prototype.instance]]\nof = \"p{}\"\ntranslate = [{place}, 0, 0]\n",
                level + 1
            );
        }
    }
    let solid = CYLINDER.replace("cylinder", "prototype.cylinder");
    scene + "[[prototype]]\nname = \"p64\"\n" + &solid
}

/// Waits until a condition is true.
fn wait_until(what: &str, mut is_true: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_true() {
        assert!(start.elapsed() < TIMEOUT, "{what}: not within {TIMEOUT:?}");
        sleep(Duration::from_millis(5));
    }
}

/// Waits until the program handles signals.
fn wait_for_handler(child: &Child) {
    wait_until("a handler of signals", || {
        is_in_mask(&child.id().to_string(), "SigCgt:", SIGINT)
    });
}

/// Whether a signal is in a mask of a process: of those caught or ignored.
fn is_in_mask(process: &str, mask: &str, signal: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix(mask));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill")
        .args([&format!("-{signal}"), &child.id().to_string()])
        .status();
    assert!(sent.expect("kill runs").success());
}

/// Waits for the end: the exit code and standard error.
fn end_of(mut child: Child) -> (Option<i32>, String) {
    let start = Instant::now();
    while child.try_wait().expect("waited").is_none() {
        if start.elapsed() > TIMEOUT {
            child.kill().expect("killed");
            panic!("it did not end");
        }
        sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().expect("output");
    let error = String::from_utf8(output.stderr).expect("UTF-8");
    (output.status.code(), error)
}

fn start(folder: &Path, line: &str) -> Child {
    let mut command = command(folder, &words(line));
    command.stdin(Stdio::piped()).stdout(Stdio::null());
    let child = command.stderr(Stdio::piped()).spawn().expect("it starts");
    wait_for_handler(&child);
    child
}

/// Whether a temporary file of an output exists.
fn has_temporary(folder: &Path) -> bool {
    let entries = fs::read_dir(folder).expect("readable");
    entries.into_iter().any(|entry| {
        let name = entry.expect("an entry").file_name();
        name.to_string_lossy().starts_with(".cyltrace-")
    })
}

#[test]
fn a_signal_ends_a_command_that_waits_for_rays() {
    let folder = folder_of(&[("scene.toml", CYLINDER), ("hits.csv", "old")]);
    let made = Command::new("mkfifo")
        .arg(folder.path().join("pipe"))
        .status();
    assert!(made.expect("mkfifo runs").success());
    // Somebody who never writes anything.
    let _writer = fs::OpenOptions::new()
        .read(true)
        .write(true)
        .open(folder.path().join("pipe"))
        .expect("opened");
    let mut signals = vec![("INT", 130), ("TERM", 143)];
    if is_in_mask("self", "SigIgn:", SIGHUP) {
        // So does the program then, which it inherits.
        println!("SIGHUP is not tested: it is ignored here, as under nohup");
    } else {
        signals.push(("HUP", 129));
    }
    for (signal, code) in signals {
        for table in ["-", "pipe"] {
            let line = format!("trace scene.toml --rays {table} -o hits.csv");
            let child = start(folder.path(), &line);
            wait_until("a temporary file", || has_temporary(folder.path()));
            send(signal, &child);
            let (ended, error) = end_of(child);
            assert_eq!(ended, Some(code), "{signal} {line}: {error}");
            assert!(error.starts_with("error: interrupted"), "{error}");
            assert!(!has_temporary(folder.path()), "{signal} {line}");
            let hits = fs::read_to_string(folder.path().join("hits.csv"));
            assert_eq!(hits.expect("read"), "old");
        }
    }
}

#[test]
fn a_signal_ends_a_single_endless_ray() {
    let folder = folder_of(&[("scene.toml", deep().as_str()), ("rays.csv", RAY)]);
    let line = "trace scene.toml --rays rays.csv --all -o hits.csv";
    for signals in [&["INT"][..], &["TERM", "TERM"]] {
        let child = start(folder.path(), line);
        wait_until("a temporary file", || has_temporary(folder.path()));
        for signal in signals {
            send(signal, &child);
        }
        let (code, error) = end_of(child);
        let expected = if signals[0] == "INT" { 130 } else { 143 };
        assert_eq!(code, Some(expected), "{signals:?}: {error}");
        assert!(!has_temporary(folder.path()), "{signals:?}");
        assert!(!folder.path().join("hits.csv").exists());
    }
}

#[test]
fn a_signal_ends_a_command_that_reads_a_scene() {
    let scene = CYLINDER.repeat(150_000);
    let folder = folder_of(&[("scene.toml", scene.as_str())]);
    for line in ["info scene.toml", "render scene.toml -o picture.png"] {
        let child = start(folder.path(), line);
        send("INT", &child);
        let (code, error) = end_of(child);
        assert_eq!(code, Some(130), "{line}: {error}");
        assert_eq!(error, "error: interrupted; nothing was written\n", "{line}");
        assert!(!folder.path().join("picture.png").exists());
    }
}

/// The pictures of a film that are complete stay.
#[test]
fn a_signal_ends_a_film_with_whole_pictures() {
    let folder = folder_of(&[("scene.toml", CYLINDER)]);
    let line = "render scene.toml -o film.png --size 16x16 --frames 100000 --orbit --quiet";
    let child = start(folder.path(), line);
    let third = folder.path().join("film_00002.png");
    wait_until("three pictures", || third.exists());
    send("INT", &child);
    let (code, error) = end_of(child);
    assert_eq!(code, Some(130), "{error}");
    assert!(error.contains("pictures that are complete: "), "{error}");
    assert!(!has_temporary(folder.path()));
    let files = fs::read_dir(folder.path()).expect("a folder");
    for file in files {
        let path = file.expect("a file").path();
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .expect("a name");
        if name.ends_with(".png") {
            // The last chunk of a whole file.
            let bytes = fs::read(&path).expect("a picture");
            assert!(bytes.ends_with(b"IEND\xaeB`\x82"), "{name}");
        }
    }
}

#[test]
fn a_signal_ends_commands_that_compute() {
    let folder = folder_of(&[("scene.toml", CYLINDER)]);
    for line in [
        "check scene.toml --rays 1000000000 --quiet",
        "stress --cases 10000000 --quiet",
        "render scene.toml -o picture.png --size 8000x8000 --spp 4096 --quiet",
        "bench accuracy --cases 1000000 --quiet",
    ] {
        let child = start(folder.path(), line);
        sleep(Duration::from_millis(200));
        send("TERM", &child);
        let (code, error) = end_of(child);
        assert_eq!(code, Some(143), "{line}: {error}");
        assert!(error.contains("interrupted"), "{line}: {error}");
        assert!(!has_temporary(folder.path()), "{line}");
    }
}
