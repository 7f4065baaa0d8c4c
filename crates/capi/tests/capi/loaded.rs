//! Scenes and texts of the library, as tests use them.

use std::ffi::{CStr, CString, c_char};
use std::path::{Path, PathBuf};

use cyltrace_c::*;

/// A loaded scene that is freed in the end.
pub struct Loaded(pub *mut CyltraceScene);

impl Loaded {
    /// A scene of the folder `scenes`.
    pub fn new(name: &str) -> Self {
        Self::at(&scene_path(name))
    }

    pub fn at(path: &Path) -> Self {
        let path = CString::new(path.to_str().expect("UTF-8")).expect("no NUL");
        // SAFETY: a text with its NUL, and a layout.
        let scene = unsafe { cyltrace_scene_load_checked(path.as_ptr(), &CyltraceLayout::LIBRARY) };
        assert!(!scene.is_null(), "{}", last_error());
        Self(scene)
    }
}

impl Drop for Loaded {
    fn drop(&mut self) {
        // SAFETY: it was loaded and is freed here alone.
        unsafe { cyltrace_scene_free(self.0) };
    }
}

pub fn scene_path(name: &str) -> PathBuf {
    Path::new(super::ROOT).join("../../scenes").join(name)
}

pub fn last_error() -> String {
    text(cyltrace_last_error())
}

pub fn text(pointer: *const c_char) -> String {
    assert!(!pointer.is_null());
    // SAFETY: the library's texts end with a NUL.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().expect("UTF-8").to_owned()
}
