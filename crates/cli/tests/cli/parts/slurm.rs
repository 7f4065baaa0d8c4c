//! `farm slurm-script`, run as Slurm runs it.

use std::fs;

use super::{bytes, refused, run, scene};
use crate::program::cyltrace;

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
