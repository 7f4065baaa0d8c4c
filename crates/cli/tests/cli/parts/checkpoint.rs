//! `render --checkpoint`, with processes that are killed.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::{bytes, refused, run, scene};
use crate::program::{command, cyltrace, words};

/// Runs a command with the checkpoint `c` and kills it some time after it has written tiles.
/// Returns whether it was killed before it was done.
fn killed(folder: &Path, line: &str, later: Duration) -> bool {
    let length = || fs::metadata(folder.join("c")).map_or(0, |file| file.len());
    let before = length();
    let mut child = command(folder, &words(line))
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .expect("it runs");
    let start = Instant::now();
    // The first line alone has some hundred bytes.
    while length() < before.max(1_000) + 1_000 && child.try_wait().expect("a child").is_none() {
        assert!(start.elapsed() < Duration::from_secs(60), "nothing written");
        thread::sleep(Duration::from_millis(1));
    }
    thread::sleep(later);
    child.kill().expect("killed, or at its end");
    !child.wait().expect("it ends").success()
}

/// The figures of a command that goes on from a checkpoint and ends.
fn resumed(folder: &Path, line: &str) -> Value {
    run(folder, &format!("{line} --json figures.json"));
    assert!(!folder.join("c").exists(), "the checkpoint stays");
    serde_json::from_slice(&bytes(folder, "figures.json")).expect("JSON")
}

#[test]
fn picture_of_killed_processes_is_that_of_one() {
    let folder = scene();
    let folder = folder.path();
    let line = "render scene.toml --size 160x96 --spp 1024";
    let whole = format!("{line} -o whole.png -q --json whole.json");
    run(folder, &whole);
    let line = format!("{line} -o out.png --checkpoint c -q --threads");
    for (threads, later) in [(1, 0), (2, 17), (2, 5)] {
        let is_killed = killed(
            folder,
            &format!("{line} {threads}"),
            Duration::from_millis(later),
        );
        assert!(is_killed || !folder.join("c").exists());
        if !folder.join("c").exists() {
            // A very fast machine: the picture is written.
            break;
        }
    }
    let has_tiles = folder.join("c").exists();
    let figures = resumed(folder, &format!("{line} 1"));
    assert!(bytes(folder, "whole.png") == bytes(folder, "out.png"));
    let whole: Value = serde_json::from_slice(&bytes(folder, "whole.json")).expect("JSON");
    assert_eq!(figures["rays"], whole["rays"]);
    let tiles = figures["resumed"]["tiles"].as_u64().expect("a number");
    assert_eq!(tiles > 0, has_tiles, "{tiles} of 60 tiles");
}

#[test]
fn errors_and_channels_are_those_of_one_process() {
    let folder = scene();
    let folder = folder.path();
    let text = fs::read_to_string(folder.join("scene.toml")).expect("read");
    let text = format!("background = \"transparent\"\n{text}");
    fs::write(folder.join("scene.toml"), text).expect("written");
    let line = "render scene.toml --size 160x96 --error 0.01 --channels depth,ids,samples";
    run(folder, &format!("{line} -o whole.exr -q --json whole.json"));
    let line = format!("{line} -o out.exr --checkpoint c -q");
    if killed(folder, &line, Duration::ZERO) {
        // The end of the file is lost.
        let file = fs::OpenOptions::new().write(true).open(folder.join("c"));
        let file = file.expect("opened");
        let length = file.metadata().expect("there").len();
        file.set_len(length - 1).expect("cut");
    }
    let figures = resumed(folder, &line);
    assert!(bytes(folder, "whole.exr") == bytes(folder, "out.exr"));
    let whole: Value = serde_json::from_slice(&bytes(folder, "whole.json")).expect("JSON");
    for key in ["rays", "reached"] {
        assert_eq!(figures[key], whole[key], "{key}");
    }
}

#[test]
fn checkpoint_of_something_else_is_refused_and_stays() {
    let folder = scene();
    let folder = folder.path();
    let line = "render scene.toml --spp 1 -o out.png --checkpoint c";
    fs::write(folder.join("c"), "mine").expect("written");
    let message = refused(folder, line);
    assert!(message.contains("is not a checkpoint"), "{message}");
    assert_eq!(bytes(folder, "c"), b"mine");
    fs::remove_file(folder.join("c")).expect("removed");

    let begun = "render scene.toml --size 160x96 --spp 4096 -o out.png --checkpoint c -q";
    assert!(
        killed(folder, begun, Duration::ZERO),
        "too fast to be killed"
    );
    let kept = bytes(folder, "c");
    let other = begun.replace("4096", "4095");
    let message = refused(folder, &other);
    assert!(message.contains("its spp is 4096, not 4095"), "{message}");
    let twigs = fs::read_to_string(folder.join("twigs.csv")).expect("read");
    fs::write(folder.join("twigs.csv"), twigs.replace("0.2", "0.3")).expect("written");
    let message = refused(folder, begun);
    assert!(message.contains("has another content"), "{message}");
    assert!(message.contains("remove the file"), "{message}");
    assert!(bytes(folder, "c") == kept);

    let lock = fs::File::open(folder.join("c")).expect("opened");
    lock.lock().expect("locked");
    let message = refused(folder, begun);
    assert!(message.contains("another run"), "{message}");

    for option in ["--time 1", "--part 1/2", "--workers 2"] {
        let line = format!("{line} {option}");
        let (code, _, message) = cyltrace(folder, &words(&line));
        assert_eq!(code, 2, "{message}");
        assert!(message.contains("--checkpoint"), "{message}");
    }
}
