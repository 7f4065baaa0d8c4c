//! The C interface: from C, and what it refuses.
//!
//! The system's `cc` compiles C programs and links them with the shared library, which cargo
//! builds beside these tests, as they depend on the same package.

#![allow(
    unsafe_code,
    reason = "the functions under test take pointers, all of them to locals"
)]

mod batches;
mod calls;
mod layout;
mod loaded;
mod version;

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Runs a command that must succeed.
fn succeed(command: &mut Command) -> Output {
    let output = command.output().expect("it runs");
    assert!(
        output.status.success(),
        "{command:?}\n{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    output
}

/// The folder of the shared library, which is that of this test.
fn library_folder() -> PathBuf {
    let test = env::current_exe().expect("a path");
    test.parent().expect("target/PROFILE/deps").to_owned()
}

/// Compiles a C program against the header, strictly.
fn compile(source: &str, output: &Path, more: &[&str]) {
    succeed(
        Command::new("cc")
            .current_dir(ROOT)
            .args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"])
            .args(["-O1", "-I", "include", source, "-o"])
            .arg(output)
            .args(more),
    );
}

#[cfg(target_os = "linux")]
#[test]
fn example_in_c_checks_its_own_intersector() {
    let folder = tempfile::tempdir().expect("directory");
    let library = library_folder();
    let library = library.to_str().expect("UTF-8");
    let run = |real: &str, arguments: &[&str]| {
        let program = folder.path().join(format!("check_{real}"));
        let real = format!("-DREAL={real}");
        let rpath = format!("-Wl,-rpath,{library}");
        let link = [&real, "-L", library, "-lcyltrace_c", "-lm", &rpath];
        compile("examples/c/check.c", &program, &link);
        let mut command = Command::new(&program);
        // cargo's own variable names a folder that may have an older library.
        command.env_remove("LD_LIBRARY_PATH");
        let output = command.current_dir(ROOT).args(arguments).output();
        let output = output.expect("it runs");
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let code = output.status.code().expect("no signal");
        (code, text(&output.stdout), text(&output.stderr))
    };
    const SCENE: &str = "examples/c/scene.toml";

    let (code, out, err) = run("double", &[SCENE]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.ends_with("\nit passes\n"), "{out}");
    // A row of the table: class, witness, sides, rays.
    let is_row = |line: &str| {
        let cells = line.split_whitespace();
        cells.skip(1).take(3).eq(["prisms", "64", "20000"])
    };
    assert!(out.lines().any(is_row), "{out}");

    let (code, out, _) = run("double", &[SCENE, "1.001"]);
    assert_eq!(code, 1, "{out}");
    assert!(out.ends_with("\nit fails\n"), "{out}");
    assert!(
        out.contains("sphere ray ") && out.contains("answered t "),
        "{out}"
    );

    // The textbook's formula in float, the default of the example.
    let (code, out, _) = run("float", &[SCENE]);
    assert_eq!(code, 1, "{out}");

    let (code, out, err) = run("double", &["missing.toml"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("missing.toml"), "{err}");
}

#[test]
fn header_is_clean_in_cpp() {
    let folder: TempDir = tempfile::tempdir().expect("directory");
    let source = folder.path().join("header.cpp");
    std::fs::write(
        &source,
        "#include \"cyltrace.h\"\nint main() { return cyltrace_scene_load(\"\") ? 1 : 0; }\n",
    )
    .expect("written");
    succeed(
        Command::new("c++")
            .args(["-std=c++11", "-Wall", "-Wextra", "-Wpedantic", "-Werror"])
            .args(["-fsyntax-only", "-I", &format!("{ROOT}/include")])
            .arg(&source),
    );
}
