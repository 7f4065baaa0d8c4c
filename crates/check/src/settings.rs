//! What is to be checked.

use std::fmt;
use std::str::FromStr;

use cyltrace::embree::DeviceOptions;

/// How the rays of a check are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Class {
    /// From the scene's camera through its picture.
    Camera,
    /// From a sphere around the scene to random points in and around solids.
    Sphere,
    /// From inside solids, and from between the prisms.
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

    /// The name in tables and in what is replayed.
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
            format!("`{name}` is no class of rays: they are {names}")
        })
    }
}

/// How much is checked.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Sides of the prisms, at least 3 each; every number is checked with the
    /// same rays.
    pub segments: Vec<u32>,
    /// Rays of each class.
    pub rays: u64,
    /// Classes to check.
    pub classes: Vec<Class>,
    /// Chooses the rays and windows.
    pub seed: u64,
    /// Bytes that the meshes of one window may take with Embree's hierarchy.
    pub max_memory: u64,
    /// Violations that are listed; all are counted.
    pub most_listed: usize,
    /// Of the Embree that holds the meshes.
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

/// Why nothing could be checked.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// A prism needs three sides.
    #[error("{segments} segments: a prism has at least 3 and at most 4096")]
    Segments {
        /// The number given.
        segments: u32,
    },
    /// Not even one prism fits.
    #[error(
        "the meshes of the smallest part of the scene that was tried take more than the {allowed} \
         bytes allowed; even eight cylinders take {needed}"
    )]
    Memory {
        /// What eight cylinders take.
        needed: u64,
        /// [`Settings::max_memory`].
        allowed: u64,
    },
    /// Progress was told to stop.
    #[error("interrupted")]
    Interrupted,
    /// Nothing is asked for, which would hold.
    #[error("no rays, no class of rays or no number of segments: there is nothing to check")]
    NothingAsked,
    /// Nothing to check.
    #[error("the scene holds no solid")]
    Empty,
    /// Embree refused.
    #[error(transparent)]
    Embree(#[from] cyltrace::embree::Error),
}
