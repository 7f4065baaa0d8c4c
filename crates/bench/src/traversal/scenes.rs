//! The scenes that rays are traced through.

use std::path::{Path, PathBuf};

use super::random_scene::{random_scene, sticks};
use cyltrace::scene::{self, Scene};
use cyltrace::solid::SolidKind;

/// A scene of the benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SceneName {
    /// 10^4 random sticks.
    Sticks1e4,
    /// 10^5 random sticks.
    Sticks1e5,
    /// 10^6 random sticks.
    Sticks1e6,
    /// The block of octet truss of `lattice.toml`.
    Lattice,
    /// The trees of `forest.toml`.
    Forest,
    /// 10^5 random cones.
    Cones1e5,
    /// 10^5 random rounded cones.
    RoundedCones1e5,
    /// 10^5 random spheres.
    Spheres1e5,
    /// 10^5 random cuboids.
    Cuboids1e5,
    /// 10^5 random disks.
    Disks1e5,
}

impl SceneName {
    /// All, in the order of tables.
    pub const ALL: [Self; 10] = [
        Self::Sticks1e4,
        Self::Sticks1e5,
        Self::Sticks1e6,
        Self::Lattice,
        Self::Forest,
        Self::Cones1e5,
        Self::RoundedCones1e5,
        Self::Spheres1e5,
        Self::Cuboids1e5,
        Self::Disks1e5,
    ];

    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sticks1e4 => "sticks_1e4",
            Self::Sticks1e5 => "sticks_1e5",
            Self::Sticks1e6 => "sticks_1e6",
            Self::Lattice => "lattice",
            Self::Forest => "forest",
            Self::Cones1e5 => "cones_1e5",
            Self::RoundedCones1e5 => "rounded_cones_1e5",
            Self::Spheres1e5 => "spheres_1e5",
            Self::Cuboids1e5 => "cuboids_1e5",
            Self::Disks1e5 => "disks_1e5",
        }
    }

    /// Makes the scene, or reads its file from `directory`. The error is why it
    /// is not there.
    pub(super) fn make(self, directory: &Path, seed: u64) -> Result<Scene, String> {
        let others = |kind| Ok(random_scene(kind, 100_000, seed));
        let file: PathBuf = match self {
            Self::Sticks1e4 => return Ok(sticks(10_000, seed)),
            Self::Sticks1e5 => return Ok(sticks(100_000, seed)),
            Self::Sticks1e6 => return Ok(sticks(1_000_000, seed)),
            Self::Lattice => directory.join("lattice.toml"),
            Self::Forest => directory.join("forest.toml"),
            Self::Cones1e5 => return others(SolidKind::Cone),
            Self::RoundedCones1e5 => return others(SolidKind::RoundedCone),
            Self::Spheres1e5 => return others(SolidKind::Sphere),
            Self::Cuboids1e5 => return others(SolidKind::Cuboid),
            Self::Disks1e5 => return others(SolidKind::Disk),
        };
        if !file.exists() {
            return Err(format!("{} is not there", file.display()));
        }
        scene::load(&file).map_err(|error| error.to_string())
    }

    /// How many rays of a kind the oracle judges. In the forest a ray passes
    /// hundreds of trees, each of which is searched by brute force.
    pub(super) fn judged(self) -> usize {
        if self == Self::Forest { 304 } else { 1008 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn make_absent_file_is_named() {
        let absent = SceneName::Forest.make(Path::new("nowhere"), 0);
        let reason = absent.expect_err("there is no such directory");
        assert!(reason.contains("forest.toml is not there"), "{reason}");
    }
}
