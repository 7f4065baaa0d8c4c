//! The settings of a check, and why it may fail to run.

use std::fmt;
use std::str::FromStr;

use cyltrace::embree::DeviceOptions;

/// A class of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Class {
    /// From the scene's camera through its picture.
    Camera,
    /// From a sphere around the scene to random points in and around solids.
    Sphere,
    /// From inside solids, and from between the meshes.
    Inside,
    /// Aimed at silhouettes and rims.
    Grazing,
    /// Parallel to a solid's axis.
    Axial,
}

impl Class {
    /// All classes, in the order of tables.
    pub const ALL: [Self; 5] = [
        Self::Camera,
        Self::Sphere,
        Self::Inside,
        Self::Grazing,
        Self::Axial,
    ];

    /// The name in tables and in words for a replay.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Camera => "camera",
            Self::Sphere => "sphere",
            Self::Inside => "inside",
            Self::Grazing => "grazing",
            Self::Axial => "axial",
        }
    }
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Class {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|class| class.name() == name);
        known.ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            format!("`{name}` is not a class of rays: use one of {names}")
        })
    }
}

/// The settings of a check.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Numbers of sides of the meshes, at least 3; all are checked with the
    /// same rays.
    pub segments: Vec<u32>,
    /// Rays of each class.
    pub rays: u64,
    /// Classes to check.
    pub classes: Vec<Class>,
    /// Determines the rays and windows.
    pub seed: u64,
    /// Bytes that the meshes of one window may take with Embree's hierarchy.
    pub max_memory: u64,
    /// Violations that are listed; all are counted.
    pub most_listed: usize,
    /// Options of the Embree device of the meshes.
    pub device: DeviceOptions,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            segments: vec![16, 64],
            rays: 100_000,
            classes: Class::ALL.to_vec(),
            seed: 0,
            max_memory: 4 << 30,
            most_listed: 20,
            device: DeviceOptions::default(),
        }
    }
}

impl Settings {
    /// The settings with each number of sides and each class once, in the order of tables.
    #[must_use]
    pub fn in_order(mut self) -> Self {
        self.segments.sort_unstable();
        self.segments.dedup();
        self.classes.sort_unstable();
        self.classes.dedup();
        self
    }

    /// The rays that a check draws with these settings, in words.
    #[must_use]
    pub fn rays_text(&self) -> String {
        format!("{} rays of each class, seed {}", self.rays, self.seed)
    }
}

/// Why nothing could be checked.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// A mesh needs three sides.
    #[error("{segments} segments: a mesh has at least 3 and at most 4096")]
    Segments {
        /// The number given.
        segments: u32,
    },
    /// Not even the smallest meshes fit.
    #[error(
        "the meshes of the smallest part of the scene that was tried take more than the allowed \
         {allowed} bytes; even eight cylinders take {needed}"
    )]
    Memory {
        /// The bytes of eight cylinders.
        needed: u64,
        /// [`Settings::max_memory`].
        allowed: u64,
    },
    /// Progress stopped the check.
    #[error("interrupted")]
    Interrupted,
    /// The settings require nothing, which proves nothing.
    #[error("no rays, no class of rays or no number of segments: there is nothing to check")]
    NothingToCheck,
    /// Nothing to check.
    #[error("the scene contains no solid")]
    Empty,
    /// Embree failed.
    #[error(transparent)]
    Embree(#[from] cyltrace::embree::Error),
}
