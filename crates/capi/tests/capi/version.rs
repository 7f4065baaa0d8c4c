//! Programs that were compiled with another header are refused.

use cyltrace_c::*;

use super::loaded::{last_error, scene_path};

/// The message of loading a scene for a program with this layout.
fn refusal(program: &CyltraceLayout) -> String {
    let path = scene_path("minimal.toml");
    let path = std::ffi::CString::new(path.to_str().expect("UTF-8")).expect("no NUL");
    // SAFETY: a text with its NUL, and a layout.
    let scene = unsafe { cyltrace_scene_load_checked(path.as_ptr(), program) };
    assert!(scene.is_null(), "{program:?}");
    last_error()
}

#[test]
fn program_with_other_sizes_or_another_version_is_refused() {
    let layout = CyltraceLayout::LIBRARY;
    let (size, hit) = (layout.size, layout.hit);
    for (program, message) in [
        (
            CyltraceLayout {
                hit: hit - 8,
                ..layout
            },
            format!(
                "struct cyltrace_hit has {} bytes in the program and {hit} in the library",
                hit - 8
            ),
        ),
        (
            CyltraceLayout {
                check_settings: 0,
                ..layout
            },
            "struct cyltrace_check_settings has 0 bytes".to_owned(),
        ),
        (
            CyltraceLayout {
                version: layout.version + 100,
                ..layout
            },
            "the program was compiled for cyltrace 0.2.0 and the library is 0.1.0".to_owned(),
        ),
        (
            CyltraceLayout {
                size: size + 4,
                ..layout
            },
            format!("struct cyltrace_layout has {} bytes", size + 4),
        ),
    ] {
        let refusal = refusal(&program);
        let expected = format!("cyltrace_scene_load: {message}");
        assert!(refusal.starts_with(&expected), "{refusal}");
        let remedy = "; compile the program with the header of this library";
        assert!(refusal.ends_with(remedy), "{refusal}");
    }
}

#[test]
fn version_is_that_of_the_crate() {
    let [major, minor, patch] = [10_000, 100, 1].map(|unit| cyltrace_version() / unit % 100);
    let version = format!("{major}.{minor}.{patch}");
    assert_eq!(version, env!("CARGO_PKG_VERSION"));
}
