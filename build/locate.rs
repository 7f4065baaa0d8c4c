//! Where Embree is installed.
//!
//! Embree ships no pkg-config file, and one package name carries version 3 or
//! 4 depending on the distribution's release, so the headers themselves are
//! looked for: first where the environment says, then where package managers
//! put them. A place counts only when the library is there too.

use std::fs;
use std::path::{Path, PathBuf};

/// The environment variables that decide where Embree is taken from.
pub const VARIABLES: [&str; 10] = [
    "EMBREE_INCLUDE_DIR",
    "EMBREE_LIB_DIR",
    "EMBREE_LIB_NAME",
    "EMBREE_DIR",
    "EMBREE_MAJOR",
    "CONDA_PREFIX",
    "HOMEBREW_PREFIX",
    "VCPKG_INSTALLED_DIR",
    "VCPKG_ROOT",
    "VCPKG_DEFAULT_TRIPLET",
];

const OLDEST: (u32, u32) = (3, 12);
/// Later minor versions than were tried are let in: they have only ever added,
/// and the start-up guard looks at the hit layout.
const NEWEST_MAJOR: u32 = 4;

const INSTALL: &str = "\
Install it (`sh setup.sh` does) with one of
  apt install libembree-dev
  dnf install embree-devel
  pacman -S embree
  brew install embree
  conda install -c conda-forge embree
or name a place: EMBREE_DIR (contains include/ and lib/), or EMBREE_INCLUDE_DIR (contains embree4/rtcore.h) with EMBREE_LIB_DIR.";

/// An Embree that can be compiled against.
#[derive(Debug, PartialEq, Eq)]
pub struct Embree {
    /// 3 or 4.
    pub major: u32,
    /// The directory that contains `embree3/` or `embree4/`.
    pub include: PathBuf,
    /// The directory of the library.
    pub library_directory: PathBuf,
    /// The library's name for the linker, such as `embree3`.
    pub library: String,
}

impl Embree {
    /// The header that states the version and how Embree was configured.
    pub fn header(&self) -> PathBuf {
        config_header(&self.include, self.major)
    }
}

/// A directory of headers and the directories where their library may be.
struct Place {
    include: PathBuf,
    libraries: Vec<PathBuf>,
}

/// Finds Embree by the variables that `environment` reads, then under the
/// prefixes `system`, for the processor `arch`. Version 4 wins over 3 within a place, unless `EMBREE_MAJOR` says
/// which one is wanted.
///
/// # Errors
/// When there is none, or the one found is too old: the message lists what was
/// searched and how Embree is installed.
pub fn locate(
    environment: impl Fn(&str) -> Option<String>,
    system: &[PathBuf],
    arch: &str,
) -> Result<Embree, String> {
    let set = |name: &str| environment(name).filter(|value| !value.is_empty());
    let majors = match set("EMBREE_MAJOR").as_deref() {
        None => vec![4, 3],
        Some("3") => vec![3],
        Some("4") => vec![4],
        Some(other) => return Err(format!("EMBREE_MAJOR is {other:?}: it must be 3 or 4.")),
    };
    let mut searched = Vec::new();
    for place in places(&set, system, arch) {
        for &major in &majors {
            let header = config_header(&place.include, major);
            searched.push(header.display().to_string());
            let Ok(text) = fs::read_to_string(&header) else {
                continue;
            };
            check_version(&text, major)
                .map_err(|problem| format!("{}: {problem}\n{INSTALL}", header.display()))?;
            let library = set("EMBREE_LIB_NAME").unwrap_or_else(|| format!("embree{major}"));
            for directory in &place.libraries {
                if library_files(&library)
                    .iter()
                    .any(|file| directory.join(file).exists())
                {
                    return Ok(Embree {
                        major,
                        include: place.include,
                        library_directory: directory.clone(),
                        library,
                    });
                }
                searched.push(format!("{}/lib{library}.*", directory.display()));
            }
        }
    }
    Err(format!(
        "Embree 3.12 to 4.4 was not found. Searched:\n  {}\n{INSTALL}",
        searched.join("\n  ")
    ))
}

/// The places in the order in which they are tried.
fn places(set: &impl Fn(&str) -> Option<String>, system: &[PathBuf], arch: &str) -> Vec<Place> {
    // An explicit place is the only one: an error in it must not be hidden by
    // some other Embree.
    if let (Some(include), Some(library)) = (set("EMBREE_INCLUDE_DIR"), set("EMBREE_LIB_DIR")) {
        return vec![Place {
            include: include.into(),
            libraries: vec![library.into()],
        }];
    }
    if let Some(prefix) = set("EMBREE_DIR") {
        return vec![under(Path::new(&prefix), arch)];
    }
    let mut places = Vec::new();
    for name in ["CONDA_PREFIX", "HOMEBREW_PREFIX"] {
        if let Some(prefix) = set(name) {
            places.push(under(Path::new(&prefix), arch));
        }
    }
    let installed = set("VCPKG_INSTALLED_DIR")
        .map(PathBuf::from)
        .or_else(|| set("VCPKG_ROOT").map(|root| Path::new(&root).join("installed")));
    if let (Some(installed), Some(triplet)) = (installed, set("VCPKG_DEFAULT_TRIPLET")) {
        places.push(under(&installed.join(triplet), arch));
    }
    places.extend(system.iter().map(|prefix| under(prefix, arch)));
    places
}

/// The usual subdirectories of a prefix.
fn under(prefix: &Path, arch: &str) -> Place {
    let libraries = [
        format!("lib/{arch}-linux-gnu"),
        "lib64".into(),
        "lib".into(),
    ];
    Place {
        include: prefix.join("include"),
        libraries: libraries.iter().map(|name| prefix.join(name)).collect(),
    }
}

fn config_header(include: &Path, major: u32) -> PathBuf {
    include
        .join(format!("embree{major}"))
        .join("rtcore_config.h")
}

/// The names a shared or import library has on the platforms Embree runs on.
fn library_files(library: &str) -> [String; 3] {
    [
        format!("lib{library}.so"),
        format!("lib{library}.dylib"),
        format!("{library}.lib"),
    ]
}

/// Reads the version that a `rtcore_config.h` states.
fn check_version(header: &str, major: u32) -> Result<(), String> {
    let number = |name: &str| {
        header.lines().find_map(|line| {
            let mut words = line.split_whitespace();
            let is_definition = words.next() == Some("#define") && words.next() == Some(name);
            words.next().filter(|_| is_definition)?.parse::<u32>().ok()
        })
    };
    let (Some(found), Some(minor)) = (number("RTC_VERSION_MAJOR"), number("RTC_VERSION_MINOR"))
    else {
        return Err("states no RTC_VERSION_MAJOR and RTC_VERSION_MINOR.".into());
    };
    if found != major {
        return Err(format!(
            "states version {found}.{minor} in the directory of version {major}."
        ));
    }
    if (found, minor) < OLDEST || found > NEWEST_MAJOR {
        return Err(format!(
            "states version {found}.{minor}; this program needs 3.12 to 4.4."
        ));
    }
    Ok(())
}
