//! The C interface: from C, and what it refuses.
//!
//! C programs are compiled by the system's `cc` and linked with the shared
//! library that the example `cyltrace_c` is. `cargo test` builds it with all
//! examples; cargo is asked for it once more, so that it is never an old one
//! where a single test is run. That asks for no network and, as cargo lets go
//! of the target directory before it runs tests, waits for nobody.

#![allow(
    unsafe_code,
    reason = "the functions under test take pointers, all of them to locals"
)]

mod calls;
mod layout;

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

/// The folder of the shared library, built in the profile of this test.
fn library_folder() -> PathBuf {
    let test = env::current_exe().expect("a path");
    let profile_folder = test.ancestors().nth(2).expect("target/PROFILE/deps/test");
    let profile = profile_folder.file_name().and_then(|name| name.to_str());
    let profile = match profile.expect("a profile's name") {
        "debug" => "dev",
        other => other,
    };
    let target = profile_folder.parent().expect("a target directory");
    succeed(
        Command::new(env!("CARGO"))
            .current_dir(ROOT)
            .args(["build", "--offline", "--example", "cyltrace_c"])
            .args(["--profile", profile, "--target-dir"])
            .arg(target),
    );
    profile_folder.join("examples")
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
        let output = command.current_dir(ROOT).args(arguments).output();
        let output = output.expect("it runs");
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let code = output.status.code().expect("no signal");
        (code, text(&output.stdout), text(&output.stderr))
    };
    const SCENE: &str = "examples/c/scene.toml";

    let (code, out, err) = run("double", &[SCENE]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert!(out.ends_with("\nit holds\n") && out.contains("64 sides: 20000 rays, "));

    let (code, out, _) = run("double", &[SCENE, "1.001"]);
    assert_eq!(code, 1, "{out}");
    assert!(out.ends_with("\nit does not hold\n"), "{out}");
    assert!(
        out.contains("sphere ray ") && out.contains("answered t = "),
        "{out}"
    );

    // The textbook in float, as the example is compiled by itself.
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
        "#include \"cyltrace.h\"\nint main() { return CYLTRACE_OK; }\n",
    )
    .expect("written");
    succeed(
        Command::new("c++")
            .args(["-std=c++11", "-Wall", "-Wextra", "-Wpedantic", "-Werror"])
            .args(["-fsyntax-only", "-I", &format!("{ROOT}/include")])
            .arg(&source),
    );
}
