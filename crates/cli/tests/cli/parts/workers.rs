//! `render --workers`, with workers that die.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::{bytes, refused, run, scene, unfinished};
use crate::program::{command, words};

#[test]
fn workers_make_the_picture_of_one_process() {
    let folder = scene();
    let folder = folder.path();
    run(folder, "render scene.toml --spp 2 --exact -o whole.png -q");
    let line = "render scene.toml --spp 2 --exact -o shared.png --workers 2 --json figures.json";
    let output = run(folder, line);
    assert!(output.contains("16 parts by 2 workers"), "{output}");
    assert!(bytes(folder, "whole.png") == bytes(folder, "shared.png"));
    assert!(!folder.join("shared.png.parts").exists());
    let figures: Value = serde_json::from_slice(&bytes(folder, "figures.json")).expect("JSON");
    assert_eq!(figures["rays"]["camera"], 75 * 50 * 2);
    assert_eq!(figures["workers"], 2);

    // Wrong input is reported once, and is not tried again.
    fs::write(folder.join("twigs.csv"), "x0\n1\n").expect("written");
    let message = refused(folder, "render scene.toml -o bad.png --workers 4");
    assert_eq!(message.matches("twigs.csv").count(), 1, "{message}");
    assert!(!message.contains("again"), "{message}");
    assert!(!folder.join("bad.png.parts").exists());
}

#[test]
fn folder_of_workers_keeps_what_is_not_theirs() {
    let folder = scene();
    let folder = folder.path();
    let parts = folder.join("out.png.parts");
    fs::create_dir(&parts).expect("created");
    fs::write(parts.join("notes.txt"), "mine").expect("written");
    let line = "render scene.toml --spp 1 -o out.png --workers 2 -q";
    let message = refused(folder, line);
    assert!(message.contains("--resume"), "{message}");
    run(folder, &format!("{line} --resume"));
    let left = fs::read_dir(&parts).expect("readable");
    let left: Vec<_> = left
        .map(|entry| entry.expect("entry").file_name())
        .collect();
    assert!(
        left.contains(&"notes.txt".into()) && left.len() <= 2,
        "{left:?}"
    );

    // Another run is at work in the folder.
    let lock = fs::File::create(parts.join("lock")).expect("created");
    lock.lock().expect("locked");
    let message = refused(folder, &format!("{line} --resume"));
    assert!(message.contains("another run"), "{message}");
}

#[test]
fn fewer_workers_use_the_parts_of_more() {
    let folder = scene();
    let folder = folder.path();
    run(folder, "render scene.toml --spp 1 -o whole.png -q");
    fs::create_dir(folder.join("out.png.parts")).expect("created");
    for number in 1..=5 {
        let part = format!("render scene.toml --spp 1 --part {number}/6 -q -o");
        run(folder, &format!("{part} out.png.parts/{number}.cylpart"));
    }
    let line = "render scene.toml --spp 1 -o out.png --workers 1 --resume";
    let output = run(folder, line);
    assert!(output.contains("6 parts by 1 workers"), "{output}");
    assert!(bytes(folder, "whole.png") == bytes(folder, "out.png"));
}

/// The process of a part that `parent` has started, if there is one.
#[cfg(target_os = "linux")]
fn child_of(parent: u32) -> Option<u32> {
    let tasks = fs::read_to_string(format!("/proc/{parent}/task/{parent}/children")).ok()?;
    let others = fs::read_dir(format!("/proc/{parent}/task")).ok()?;
    let others =
        others.filter_map(|task| fs::read_to_string(task.ok()?.path().join("children")).ok());
    let all: String = others.chain([tasks]).collect::<Vec<_>>().join(" ");
    all.split_whitespace().next()?.parse().ok()
}

/// The process of a part that `parent` starts, once there is one.
#[cfg(target_os = "linux")]
fn first_child_of(parent: u32) -> u32 {
    let start = Instant::now();
    loop {
        assert!(start.elapsed() < Duration::from_secs(60), "no worker");
        match child_of(parent) {
            Some(child) => return child,
            None => thread::sleep(Duration::from_millis(1)),
        }
    }
}

#[cfg(target_os = "linux")]
fn kill(process: u32) {
    let mut command = std::process::Command::new("kill");
    let killed = command.args(["-9", &process.to_string()]).status();
    assert!(killed.expect("it runs").success());
}

#[cfg(target_os = "linux")]
#[test]
fn workers_end_with_the_process_that_started_them() {
    let folder = scene();
    let folder = folder.path();
    let line = "render scene.toml --size 1000x1000 --spp 4096 -o out.png --workers 1 --parts 1";
    let mut all = command(folder, &words(line))
        .stdout(Stdio::null())
        .spawn()
        .expect("it runs");
    let child = first_child_of(all.id());
    // In the middle of its part, long after its start.
    let start = Instant::now();
    while unfinished(&folder.join("out.png.parts")) == 0 {
        assert!(
            start.elapsed() < Duration::from_secs(60),
            "no part is begun"
        );
        thread::sleep(Duration::from_millis(1));
    }
    kill(all.id());
    all.wait().expect("it ends");
    let start = Instant::now();
    let is_there = || Path::new(&format!("/proc/{child}")).exists();
    while is_there() && start.elapsed() < Duration::from_secs(20) {
        thread::sleep(Duration::from_millis(10));
    }
    if is_there() {
        kill(child);
        panic!("the worker went on");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn worker_that_dies_is_started_again() {
    let folder = scene();
    let folder = folder.path();
    // Long enough to be killed in the middle.
    let line = "render scene.toml --spp 256";
    run(folder, &format!("{line} -o whole.png -q"));
    let mut all = command(
        folder,
        &words(&format!("{line} -o shared.png --workers 1 --parts 2")),
    )
    .stderr(Stdio::piped())
    .spawn()
    .expect("it runs");
    kill(first_child_of(all.id()));
    let status = all.wait().expect("it ends");
    let mut message = String::new();
    std::io::Read::read_to_string(&mut all.stderr.take().expect("a pipe"), &mut message)
        .expect("UTF-8");
    assert!(status.success(), "{message}");
    assert!(message.contains("rendered again"), "{message}");
    assert!(bytes(folder, "whole.png") == bytes(folder, "shared.png"));
}
