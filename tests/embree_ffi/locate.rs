//! The build script's search for Embree, in made-up directories.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

#[path = "../../build/locate.rs"]
mod build_locate;

use build_locate::{Embree, VARIABLES, locate};

/// A prefix with headers that state a version, and a library.
fn install(prefix: &Path, library_directory: &str, major: u32, minor: u32) {
    let headers = prefix.join(format!("include/embree{major}"));
    fs::create_dir_all(&headers).unwrap();
    let config = format!(
        "#pragma once\n#define RTC_VERSION_MAJOR {major}\n#define RTC_VERSION_MINOR {minor}\n#define RTC_VERSION_PATCH 0\n"
    );
    fs::write(headers.join("rtcore_config.h"), config).unwrap();
    let libraries = prefix.join(library_directory);
    fs::create_dir_all(&libraries).unwrap();
    fs::write(libraries.join(format!("libembree{major}.so")), "").unwrap();
}

fn search(variables: &[(&str, &Path)], system: &[PathBuf]) -> Result<Embree, String> {
    let variables: HashMap<&str, &Path> = variables.iter().copied().collect();
    let read = |name: &str| {
        assert!(
            VARIABLES.contains(&name),
            "{name} would not trigger a rebuild"
        );
        Some(variables.get(name)?.to_str()?.to_owned())
    };
    locate(read, system, "x86_64")
}

#[test]
fn locate_system_prefix_prefers_4_and_finds_multiarch_directory() {
    let root = TempDir::new().unwrap();
    let system = [root.path().to_owned()];
    install(root.path(), "lib/x86_64-linux-gnu", 3, 13);
    let found = search(&[], &system).unwrap();
    assert_eq!((found.major, found.library.as_str()), (3, "embree3"));
    assert_eq!(
        found.library_directory,
        root.path().join("lib/x86_64-linux-gnu")
    );
    assert!(found.header().is_file());

    install(root.path(), "lib64", 4, 4);
    assert_eq!(search(&[], &system).unwrap().major, 4);
    let wanted = search(&[("EMBREE_MAJOR", Path::new("3"))], &system).unwrap();
    assert_eq!(wanted.major, 3);
}

#[test]
fn locate_environment_wins_over_system() {
    let (root, own) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    let system = [root.path().to_owned()];
    install(root.path(), "lib", 4, 3);
    install(own.path(), "lib", 3, 12);
    let found = search(&[("EMBREE_DIR", own.path())], &system).unwrap();
    assert_eq!(found.major, 3);
    let found = search(&[("CONDA_PREFIX", own.path())], &system).unwrap();
    assert_eq!(found.major, 3);
    let include = own.path().join("include");
    let library = own.path().join("lib");
    let pair = [
        ("EMBREE_INCLUDE_DIR", include.as_path()),
        ("EMBREE_LIB_DIR", library.as_path()),
    ];
    assert_eq!(search(&pair, &system).unwrap().include, include);
}

#[test]
fn locate_nothing_lists_places_and_install_lines() {
    let root = TempDir::new().unwrap();
    let message = search(&[], &[root.path().to_owned()]).unwrap_err();
    let header = root.path().join("include/embree4/rtcore_config.h");
    assert!(message.contains(header.to_str().unwrap()), "{message}");
    for manager in ["apt", "dnf", "pacman", "brew", "conda"] {
        assert!(
            message.contains(&format!("{manager} install")) || manager == "pacman",
            "{message}"
        );
    }
    assert!(message.contains("pacman -S embree"), "{message}");
}

#[test]
fn locate_headers_without_library_are_passed_over() {
    let (root, other) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    install(root.path(), "lib", 4, 4);
    fs::remove_file(root.path().join("lib/libembree4.so")).unwrap();
    let alone = search(&[], &[root.path().to_owned()]).unwrap_err();
    assert!(alone.contains("libembree4"), "{alone}");
    install(other.path(), "lib", 3, 13);
    let system = [root.path().to_owned(), other.path().to_owned()];
    assert_eq!(search(&[], &system).unwrap().major, 3);
}

#[test]
fn locate_unsupported_version_is_refused_with_its_number() {
    let root = TempDir::new().unwrap();
    install(root.path(), "lib", 3, 11);
    let message = search(&[], &[root.path().to_owned()]).unwrap_err();
    assert!(
        message.contains("3.11") && message.contains("3.12 to 4.4"),
        "{message}"
    );
    let message = search(&[("EMBREE_MAJOR", Path::new("5"))], &[]).unwrap_err();
    assert!(message.contains("\"5\""), "{message}");
}
