//! `--part`, `merge` and `parts`: the bytes of one process, whatever happens to the parts.

use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

use crate::program::{command, cyltrace, folder_of, words};

/// Cylinders in a table, placed twice, and a sphere.
const SCENE: &str = r#"
[film]
width = 75
height = 50

[[sphere]]
center = [0, 0, 0]
radius = 0.7

[[instance]]
of = "twigs"
translate = [-1, 0, 0]
[[instance]]
of = "twigs"
translate = [1, 0.2, 0]
scale = 0.6

[[prototype]]
name = "twigs"
[[prototype.cylinder_table]]
file = "twigs.csv"
columns = { p0 = ["x0", "y0", "z0"], p1 = ["x1", "y1", "z1"], radius = "r" }
"#;

const TWIGS: &str = "\
x0,y0,z0,x1,y1,z1,r
0,0,-1,0,0,1,0.2
0,0,0,1,1,0.5,0.1
-1,0,0,1,0.5,0.2,0.05
0,-1,0,0,1,1,0.1
";

fn scene() -> TempDir {
    folder_of(&[("scene.toml", SCENE), ("twigs.csv", TWIGS)])
}

/// Runs a command line that succeeds.
fn run(folder: &Path, line: &str) -> String {
    let (code, output, error) = cyltrace(folder, &words(line));
    assert_eq!(code, 0, "{line}: {output}{error}");
    output
}

/// The error message of a command line that fails.
fn refused(folder: &Path, line: &str) -> String {
    let (code, output, error) = cyltrace(folder, &words(line));
    assert_eq!(code, 2, "{line}: {output}{error}");
    error
}

/// Runs a command line in `count` parts, each in a file of the folder `parts`.
fn make_parts(folder: &Path, line: &str, count: u64) {
    fs::create_dir_all(folder.join("parts")).expect("created");
    for number in 1..=count {
        run(
            folder,
            &format!("{line} --part {number}/{count} -o parts/{number} -q"),
        );
    }
}

fn bytes(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).expect("a file")
}

#[test]
fn picture_merged_from_parts_has_the_bytes_of_one_process() {
    let folder = scene();
    let folder = folder.path();
    for integrator in ["sun", "ao", "normal"] {
        let line = format!("render scene.toml --spp 3 --seed 5 --integrator {integrator}");
        // 20 tiles: more parts than tiles are empty.
        for count in [1, 7, 23] {
            make_parts(folder, &line, count);
            for picture in ["whole.png", "whole.exr"] {
                run(folder, &format!("{line} -o {picture} -q"));
                let merged = picture.replace("whole", "merged");
                run(folder, &format!("merge parts -o {merged} -q"));
                assert!(
                    bytes(folder, picture) == bytes(folder, &merged),
                    "{integrator}, {count} parts, {picture}"
                );
            }
            fs::remove_dir_all(folder.join("parts")).expect("removed");
        }
    }
}

/// Rays of every kind of line end, with comments and blank lines between them.
fn rays() -> String {
    let mut text = String::from("# rays\nox,oy,oz,dx,dy,dz,note\n");
    for number in 0..500 {
        let x = f64::from(number) / 100.0 - 2.5;
        let end = ["\n", "\r\n", "\r", "\n\n", "\n# note\n"][number as usize % 5];
        text += &format!("{x},0.1,5,0,{},-1,ray {number}{end}", 0.01 * x);
    }
    text
}

#[test]
fn table_merged_from_parts_has_the_bytes_of_one_process() {
    let folder = scene();
    let folder = folder.path();
    fs::write(folder.join("rays.csv"), rays()).expect("written");
    fs::write(
        folder.join("points.csv"),
        "x y z\n0 0 0\n5 5 5\n1 0 0\n-1 0 0.5\n",
    )
    .expect("written");
    for line in [
        "trace scene.toml --rays rays.csv",
        "trace scene.toml --rays rays.csv --all",
        "trace scene.toml --points points.csv",
    ] {
        run(folder, &format!("{line} -o whole.csv -q"));
        for count in [1, 7, 40] {
            make_parts(folder, line, count);
            run(folder, "merge parts -o merged.csv -q");
            assert!(
                bytes(folder, "whole.csv") == bytes(folder, "merged.csv"),
                "{line}, {count} parts"
            );
            let merged = cyltrace(folder, &words("merge parts -o -"));
            assert_eq!(merged.1.as_bytes(), bytes(folder, "whole.csv"));
            fs::remove_dir_all(folder.join("parts")).expect("removed");
        }
    }
}

/// Every division into two parts: each place of the file is a border once.
#[test]
fn every_border_of_a_table_gives_each_row_to_one_part() {
    let folder = scene();
    let folder = folder.path();
    let table = "#a\r\nx,y,z\r\n0,0,0\r\n\r\n5,5,5\r1,0,0\n\n-1,0,0.5";
    fs::write(folder.join("points.csv"), table).expect("written");
    let line = "trace scene.toml --points points.csv";
    run(folder, &format!("{line} -o whole.csv -q"));
    let whole = bytes(folder, "whole.csv");
    let count = table.len() as u64;
    // One part for each byte: all borders are used.
    make_parts(folder, line, count);
    run(folder, "merge parts -o merged.csv -q");
    assert_eq!(
        String::from_utf8(bytes(folder, "merged.csv")),
        String::from_utf8(whole)
    );
}

#[test]
fn wrong_row_of_a_part_is_named_by_its_line_in_the_whole_table() {
    let folder = scene();
    let folder = folder.path();
    let mut table = rays().replace("\n# note\n", "\n").replace("\n\n", "\n");
    table += "0,0,0,0,0,0,no direction\r\n";
    fs::write(folder.join("rays.csv"), table).expect("written");
    let line = "trace scene.toml --rays rays.csv";
    let whole = refused(folder, &format!("{line} -o whole.csv"));
    assert!(whole.contains("rays.csv:503:"), "{whole}");
    let part = refused(folder, &format!("{line} --part 5/5 -o part"));
    assert_eq!(part, whole);
    // The other parts do not read that row.
    run(folder, &format!("{line} --part 4/5 -o part -q"));

    // A cell that continues on the next line could begin in one part and end in another.
    let quoted = "ox,oy,oz,dx,dy,dz,note\n0,0,5,0,0,-1,\"two\nlines\"\n";
    fs::write(folder.join("rays.csv"), quoted).expect("written");
    run(folder, &format!("{line} -o whole.csv -q"));
    let message = refused(folder, &format!("{line} --part 1/1 -o part"));
    assert!(
        message.contains("rays.csv:2:") && message.contains("on one line"),
        "{message}"
    );
}

/// The JSON of a check without its time, which differs from run to run.
fn without_time(folder: &Path, name: &str) -> String {
    let text = String::from_utf8(bytes(folder, name)).expect("UTF-8");
    let lines = text.lines().filter(|line| !line.contains("\"check_s\""));
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn check_merged_from_parts_has_the_json_of_one_process() {
    let folder = scene();
    let folder = folder.path();
    let more = (0..60).map(|x| format!("[[instance]]\nof = \"twigs\"\ntranslate = [{x}, 3, 0]\n"));
    let (head, tail) = SCENE.split_once("[[prototype]]").expect("a prototype");
    let text = format!("{head}{}[[prototype]]{tail}", more.collect::<String>());
    fs::write(folder.join("scene.toml"), text).expect("written");
    // The second takes the scene in several windows.
    for memory in ["4GiB", "1MB"] {
        let line = format!("check scene.toml --rays 2500 --segments 12,32 --max-memory {memory}");
        run(folder, &format!("{line} --json whole.json -q"));
        let whole: Value = serde_json::from_slice(&bytes(folder, "whole.json")).expect("JSON");
        let windows = whole["windows"].as_array().expect("an array").len();
        assert_eq!(windows > 1, memory == "1MB", "{windows} windows");
        for count in [1, 3, 7] {
            make_parts(folder, &line, count);
            let printed = run(folder, "merge parts -o merged.json");
            assert!(printed.contains("passes: no answer is wrong"), "{printed}");
            assert_eq!(
                without_time(folder, "merged.json"),
                without_time(folder, "whole.json"),
                "{memory}, {count} parts"
            );
            fs::remove_dir_all(folder.join("parts")).expect("removed");
        }
    }
}

#[test]
fn merge_refuses_what_is_no_whole_and_writes_nothing() {
    let folder = scene();
    let folder = folder.path();
    let line = "render scene.toml --spp 1";
    make_parts(folder, line, 4);
    run(folder, "render scene.toml --spp 2 --part 2/4 -o other -q");
    fs::write(folder.join("merged.png"), "old").expect("written");
    let merge = |parts: &str, expected: &[&str]| {
        let message = refused(folder, &format!("merge {parts} -o merged.png"));
        for word in expected {
            assert!(message.contains(word), "{parts}: {message}");
        }
        assert_eq!(bytes(folder, "merged.png"), b"old");
    };
    merge(
        "parts/1 parts/2 parts/4",
        &["missing", "tiles 10 to 14 of 20", "parts/2"],
    );
    merge(
        "parts/1 parts/2 parts/2 parts/3 parts/4",
        &["overlap", "parts/2"],
    );
    merge(
        "parts/1 other parts/3 parts/4",
        &["other", "its spp is 2, not 1"],
    );
    merge("parts/1 scene.toml", &["scene.toml", "not a part"]);
    merge("parts/1 absent", &["absent"]);

    // A file of the scene has changed between two parts.
    fs::write(folder.join("twigs.csv"), TWIGS.replace("0.2\n", "0.3\n")).expect("written");
    run(folder, "render scene.toml --spp 1 --part 2/4 -o changed -q");
    merge(
        "parts/1 changed parts/3 parts/4",
        &["changed", "another content"],
    );

    let mut damaged = bytes(folder, "parts/3");
    let middle = damaged.len() / 2;
    damaged[middle] ^= 4;
    fs::write(folder.join("parts/3"), &damaged).expect("written");
    merge("parts", &["parts/3", "damaged", "checksum"]);
    fs::write(folder.join("parts/3"), &damaged[..middle]).expect("written");
    merge(
        "parts/1 parts/2 parts/3 parts/4",
        &["parts/3", "damaged", "cut off"],
    );

    for line in [
        "merge parts/1 parts/2 parts/4 -o parts/1",
        "merge parts/1 parts/2 parts/4 -o other.png --json parts/1",
        "merge parts/1 parts/2 parts/4 -o other.png --json other.png",
        "parts parts --json parts/1",
    ] {
        let message = refused(folder, line);
        assert!(message.contains("choose"), "{line}: {message}");
    }
    fs::create_dir(folder.join("empty")).expect("created");
    merge("empty", &["no parts in", "empty"]);
    // A picture is not replaced by a part.
    let message = refused(folder, "render scene.toml --part 1/2 -o merged.png");
    assert!(message.contains("not a part"), "{message}");
}

#[test]
fn parts_lists_what_is_there_missing_and_damaged() {
    let folder = scene();
    let folder = folder.path();
    make_parts(folder, "render scene.toml --spp 1", 5);
    let (code, output, _) = cyltrace(folder, &words("parts parts"));
    assert_eq!(code, 0, "{output}");
    assert!(
        output.contains("render") && output.contains("5 of 5"),
        "{output}"
    );

    fs::remove_file(folder.join("parts/2")).expect("removed");
    fs::write(folder.join("parts/4"), &bytes(folder, "parts/4")[..300]).expect("written");
    let (code, output, _) = cyltrace(folder, &words("parts parts --json -"));
    assert_eq!(code, 1, "{output}");
    let figures: Value = serde_json::from_str(&output).expect("JSON");
    assert_eq!(figures["results"][0]["missing"], serde_json::json!([2, 4]));
    assert_eq!(figures["damaged"][0]["file"], "parts/4");
    let (_, output, _) = cyltrace(folder, &words("parts parts"));
    assert!(output.contains("missing: 2, 4"), "{output}");

    // A part twice, which `merge` refuses.
    make_parts(folder, "render scene.toml --spp 1", 5);
    fs::copy(folder.join("parts/2"), folder.join("parts/twice")).expect("copied");
    let (code, output, _) = cyltrace(folder, &words("parts parts"));
    assert_eq!(code, 1, "{output}");
    assert!(output.contains("overlap"), "{output}");
}

#[test]
fn resume_keeps_valid_parts_only() {
    let folder = scene();
    let folder = folder.path();
    let line = "render scene.toml --spp 1 --part 1/2 -o part --resume";
    run(folder, line);
    let changed = || {
        folder
            .join("part")
            .metadata()
            .and_then(|file| file.modified())
    };
    let first = changed().expect("a file");
    let output = run(folder, line);
    assert!(output.contains("already there"), "{output}");
    assert_eq!(changed().expect("a file"), first);

    let whole = bytes(folder, "part");
    fs::write(folder.join("part"), &whole[..whole.len() - 10]).expect("written");
    let output = run(folder, line);
    assert!(!output.contains("already there"), "{output}");
    run(folder, "render scene.toml --spp 1 --part 2/2 -o other -q");
    run(folder, "merge part other -o merged.png");

    // The figures of a part that is kept.
    run(folder, &format!("{line} --json figures.json"));
    let figures: Value = serde_json::from_slice(&bytes(folder, "figures.json")).expect("JSON");
    assert_eq!(figures["part"], "1/2");

    // Another setting, another scene.
    let output = run(folder, &line.replace("--spp 1", "--spp 2"));
    assert!(!output.contains("already there"), "{output}");
    fs::write(folder.join("scene.toml"), SCENE.replace("0.7", "0.6")).expect("written");
    let output = run(folder, &line.replace("--spp 1", "--spp 2"));
    assert!(!output.contains("already there"), "{output}");
}

#[test]
fn rows_that_change_are_traced_again() {
    let folder = scene();
    let folder = folder.path();
    let row = |x: u32| format!("{x:06},0,5,0,0,-1\n");
    // Longer than the ends that every part reads.
    let rows: String = (0..20_000).map(|_| row(0)).collect();
    let table = |rows: &str| format!("ox,oy,oz,dx,dy,dz\n{rows}");
    fs::write(folder.join("rays.csv"), table(&rows)).expect("written");
    let line = "trace scene.toml --rays rays.csv --part 2/3 -o part --resume";
    run(folder, line);
    assert!(run(folder, line).contains("already there"));
    let (head, tail) = rows.split_at(row(0).len() * 10_000);
    let changed = format!("{head}{}{}", row(9), &tail[row(0).len()..]);
    fs::write(folder.join("rays.csv"), table(&changed)).expect("written");
    assert!(!run(folder, line).contains("already there"));
}

#[test]
fn part_of_what_can_be_read_only_once_is_refused() {
    let folder = scene();
    let folder = folder.path();
    let message = refused(folder, "trace scene.toml --rays - -o part --part 1/2");
    assert!(message.contains("standard input"), "{message}");
    let message = refused(folder, "trace scene.toml --rays twigs.csv -o - --part 1/2");
    assert!(message.contains("standard output"), "{message}");
    for wrong in ["0/2", "3/2", "1", "1/0"] {
        let message = refused(folder, &format!("render scene.toml -o part --part {wrong}"));
        assert!(message.contains("K/N"), "{message}");
    }
}

/// A full disk, as the process sees it: files may not be longer than some kilobytes.
#[cfg(unix)]
#[test]
fn disk_that_fills_up_leaves_no_part() {
    let folder = scene();
    let folder = folder.path();
    let program = env!("CARGO_BIN_EXE_cyltrace");
    let script =
        format!("ulimit -f 8; exec {program} render scene.toml --spp 1 --part 1/1 -o part");
    let output = std::process::Command::new("sh")
        .args(["-c", &script])
        .current_dir(folder)
        .output()
        .expect("it runs");
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(message.contains("cannot write \"part\""), "{message}");
    let left = fs::read_dir(folder).expect("readable").count();
    assert_eq!(left, 2, "the scene and its table");
}

#[test]
fn one_part_rendered_twice_at_the_same_time_is_whole() {
    let folder = scene();
    let folder = folder.path();
    let line = words("render scene.toml --spp 512 --part 1/1 -o part -q");
    let both: Vec<Child> = (0..2)
        .map(|_| command(folder, &line).spawn().expect("it runs"))
        .collect();
    // Both have begun to write.
    let start = Instant::now();
    let begun = || {
        let entries = fs::read_dir(folder).expect("readable");
        let names = entries.map(|entry| entry.expect("entry").file_name());
        names
            .filter(|name| name.to_string_lossy().starts_with(".cyltrace-"))
            .count()
    };
    while begun() < 2 {
        assert!(
            start.elapsed() < Duration::from_secs(60),
            "{} writers",
            begun()
        );
    }
    for mut child in both {
        assert!(child.wait().expect("it ends").success());
    }
    run(folder, "render scene.toml --spp 512 -o whole.exr -q");
    run(folder, "merge part -o merged.exr -q");
    assert!(bytes(folder, "whole.exr") == bytes(folder, "merged.exr"));
}

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
    let mut all = command(folder, &words(line)).spawn().expect("it runs");
    let child = first_child_of(all.id());
    kill(all.id());
    all.wait().expect("it ends");
    let start = Instant::now();
    while Path::new(&format!("/proc/{child}")).exists() {
        assert!(
            start.elapsed() < Duration::from_secs(20),
            "the worker goes on"
        );
        thread::sleep(Duration::from_millis(10));
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

#[test]
fn slurm_script_makes_and_merges_parts() {
    let folder = scene();
    let folder = folder.path();
    run(folder, "render scene.toml --spp 2 -o whole.png -q");
    let program = env!("CARGO_BIN_EXE_cyltrace");
    let line = format!(
        "farm slurm-script --parts 3 --program {program} --sbatch=--time=01:00:00 -- render scene.toml --spp 2 -q -o out.png"
    );
    let script = run(folder, &line);
    fs::write(folder.join("script"), &script).expect("written");
    // As Slurm would: the script submits itself, and then runs as each task of the array.
    let sbatch = "#!/bin/sh\necho \"$@\" >> submitted\necho 17\n";
    let path = format!(
        "{}:{}",
        folder.display(),
        std::env::var("PATH").expect("a PATH")
    );
    fs::write(folder.join("sbatch"), sbatch).expect("written");
    let sh = |script: &str, task: Option<&str>| {
        let mut shell = std::process::Command::new("sh");
        shell
            .args(["-c", script])
            .current_dir(folder)
            .env("PATH", &path);
        if let Some(task) = task {
            shell.env("SLURM_ARRAY_TASK_ID", task);
        }
        assert!(shell.status().expect("it runs").success(), "{script}");
    };
    sh("chmod +x sbatch && sh ./script", None);
    let submitted = String::from_utf8(bytes(folder, "submitted")).expect("UTF-8");
    let submitted: Vec<&str> = submitted.lines().collect();
    assert!(
        submitted[0].contains("--array=1-3 --time=01:00:00 ./script"),
        "{submitted:?}"
    );
    assert!(submitted[1].contains("afterok:17"), "{submitted:?}");
    for task in ["2", "1", "3"] {
        sh("sh ./script", Some(task));
    }
    let (_, merge) = submitted[1].split_once("--wrap=").expect("a command");
    sh(merge, None);
    assert!(bytes(folder, "whole.png") == bytes(folder, "out.png"));

    assert!(!folder.join("out.png.3.parts/4.cylpart").exists());
    for (command, words) in [
        ("render scene.toml -o out.jpg", ".png or .exr"),
        ("trace scene.toml --rays - -o out.csv", "standard input"),
        ("render scene.toml -o out.png --json out.json", "--json"),
        ("render scene.toml -o out.png --part 1/2", "--part"),
    ] {
        let message = refused(folder, &format!("farm slurm-script --parts 3 -- {command}"));
        assert!(message.contains(words), "{command}: {message}");
    }
    let array = "farm slurm-script --parts 3 --sbatch=--array=1-9 -- render scene.toml -o out.png";
    let message = refused(folder, array);
    assert!(message.contains("--array"), "{message}");
    // Names are words of the shell, whatever they contain.
    let name = "a b'c\n$(touch broken).png";
    let words = [
        "farm",
        "slurm-script",
        "--parts",
        "1",
        "--",
        "render",
        "scene.toml",
        "-o",
        name,
    ];
    let (code, script, error) = cyltrace(folder, &words);
    assert_eq!(code, 0, "{error}");
    fs::write(folder.join("script"), &script).expect("written");
    sh(
        "mkdir -p \"$(printf \"a b'c\\n\\$(touch broken).png.1.parts\")\"; sh -n ./script",
        None,
    );
    sh("sh ./script", None);
    assert!(!folder.join("broken").exists());

    let message = refused(folder, "farm slurm-script --parts 3 -- info scene.toml");
    assert!(message.contains("after `--`"), "{message}");
    let message = refused(folder, "farm slurm-script --parts 3 -- render scene.toml");
    assert!(message.contains("--output"), "{message}");
}
