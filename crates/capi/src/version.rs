//! The version of the interface, and the refusal of programs that were compiled for another.
//!
//! A C program contains the sizes of the structures as its header had them. With a library
//! of another version it would misplace each hit of an array. So a program states what it
//! was compiled with once, when it loads a scene, and every call that takes a structure
//! needs a scene.

use super::types::{CyltraceCheckOutcome, CyltraceCheckSettings, CyltraceHit, CyltraceRay};

/// The version of this library: major * 10000 + minor * 100 + patch.
pub const CYLTRACE_VERSION: u32 = 10_000 * number(env!("CARGO_PKG_VERSION_MAJOR"))
    + 100 * number(env!("CARGO_PKG_VERSION_MINOR"))
    + number(env!("CARGO_PKG_VERSION_PATCH"));

const fn number(digits: &str) -> u32 {
    match u32::from_str_radix(digits, 10) {
        Ok(number) => number,
        Err(_) => panic!("a version consists of numbers"),
    }
}

/// The version of the library, as [`CYLTRACE_VERSION`] counts it.
#[unsafe(no_mangle)]
pub extern "C" fn cyltrace_version() -> u32 {
    CYLTRACE_VERSION
}

/// `struct cyltrace_layout`: the version of a header and the sizes of its structures.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CyltraceLayout {
    /// The size of this structure.
    pub size: u32,
    /// `CYLTRACE_VERSION`.
    pub version: u32,
    /// The size of [`CyltraceRay`].
    pub ray: u32,
    /// The size of [`CyltraceHit`].
    pub hit: u32,
    /// The size of [`CyltraceCheckSettings`].
    pub check_settings: u32,
    /// The size of [`CyltraceCheckOutcome`].
    pub check_outcome: u32,
}

impl CyltraceLayout {
    /// The layout of this library.
    pub const LIBRARY: Self = Self {
        size: size_of::<Self>() as u32,
        version: CYLTRACE_VERSION,
        ray: size_of::<CyltraceRay>() as u32,
        hit: size_of::<CyltraceHit>() as u32,
        check_settings: size_of::<CyltraceCheckSettings>() as u32,
        check_outcome: size_of::<CyltraceCheckOutcome>() as u32,
    };

    /// Checks that a program with this layout can use the library; the error is a message.
    /// [`check_size`] comes first: the fields of a layout of another size are elsewhere.
    pub(super) fn check(&self) -> Result<(), String> {
        check_version(self.version, CYLTRACE_VERSION)?;
        let Self {
            ray,
            hit,
            check_settings,
            check_outcome,
            ..
        } = Self::LIBRARY;
        for (name, program, library) in [
            ("cyltrace_ray", self.ray, ray),
            ("cyltrace_hit", self.hit, hit),
            (
                "cyltrace_check_settings",
                self.check_settings,
                check_settings,
            ),
            ("cyltrace_check_outcome", self.check_outcome, check_outcome),
        ] {
            if program != library {
                return Err(format!(
                    "struct {name} has {program} bytes in the program and {library} in the library; {REMEDY}"
                ));
            }
        }
        Ok(())
    }
}

/// The end of each message.
const REMEDY: &str = "compile the program with the header of this library";

/// Checks `size`, the first field of a program's layout.
pub(super) fn check_size(size: u32) -> Result<(), String> {
    let expected = CyltraceLayout::LIBRARY.size;
    if size != expected {
        return Err(format!(
            "struct cyltrace_layout has {size} bytes in the program and {expected} in the library; {REMEDY}"
        ));
    }
    Ok(())
}

/// Accepts a program for the same or an older minor version of the same major version.
/// Below 1.0.0 every minor version may break programs.
fn check_version(program: u32, library: u32) -> Result<(), String> {
    let compatible = |version: u32| version / if library < 10_000 { 100 } else { 10_000 };
    if compatible(program) == compatible(library) && program / 100 <= library / 100 {
        return Ok(());
    }
    let shown = |version: u32| {
        let (major, minor, patch) = (version / 10_000, version / 100 % 100, version % 100);
        format!("{major}.{minor}.{patch}")
    };
    let (program, library) = (shown(program), shown(library));
    Err(format!(
        "the program was compiled for cyltrace {program} and the library is {library}; {REMEDY}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_that_may_have_another_interface_are_refused() {
        for (program, library, is_accepted) in [
            (100, 100, true),
            (107, 100, true),
            (100, 107, true),
            (200, 100, false),
            (100, 200, false),
            (100, 10_000, false),
            (10_000, 10_203, true),
            (10_299, 10_203, true),
            (10_300, 10_203, false),
            (20_000, 10_203, false),
        ] {
            let checked = check_version(program, library);
            assert_eq!(checked.is_ok(), is_accepted, "{program} {library}");
        }
        assert_eq!(
            check_version(20_005, 10_203).unwrap_err(),
            "the program was compiled for cyltrace 2.0.5 and the library is 1.2.3; \
             compile the program with the header of this library"
        );
    }
}
