//! The records of solids: what the description stores of each.
//!
//! In f64 the record of a cylinder fills a cache line, primitive number included. In f32 it
//! fills half a cache line: [`CylinderList`](super::CylinderList) stores the numbers separately.
//!
//! **Rounding.** A number is rounded to the nearest f32 once, when it is added.
//! From then on the rounded cylinder *is* the cylinder: its conversion to f64 is
//! exact, and every error bound refers to its surface. The difference of a number
//! from the stated one is at most
//!
//! ```text
//! |f32(x) - x| <= 2^-24 |x|     where |x| >= 2^-126,
//!                 2^-150        below, where f32 is denormal
//! ```
//!
//! A cylinder is rejected if its ends become the same point, its radius becomes zero or a
//! number exceeds f32.

use glam::{DVec3, Vec3};

use crate::solid::{Caps, Composition, Cylinder, CylinderError};

/// The position of a material in [`Scene::materials`](super::Scene::materials).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MaterialIndex(pub u16);

/// A solid with its number and material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidRecord<S> {
    /// The solid.
    pub solid: S,
    /// The number within the prototype, as `trace` reports it.
    pub primitive: u32,
    /// The material.
    pub material: MaterialIndex,
}

impl<S> SolidRecord<S> {
    /// The record of a solid. `primitive` is its number within its prototype.
    #[must_use]
    pub fn new(solid: S, primitive: u32, material: MaterialIndex) -> Self {
        Self {
            solid,
            primitive,
            material,
        }
    }
}

/// A composed solid with its number and material.
pub type CompositionRecord = SolidRecord<Composition>;

/// A cylinder with its number and material, in one cache line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct CylinderRecord {
    p0: DVec3,
    p1: DVec3,
    radius: f64,
    primitive: u32,
    material: MaterialIndex,
    caps: Caps,
}

const _: () = assert!(size_of::<CylinderRecord>() == 64);

impl CylinderRecord {
    /// The record of a cylinder. `primitive` is its number within its
    /// prototype, as `trace` reports it.
    #[must_use]
    pub fn new(cylinder: &Cylinder, primitive: u32, material: MaterialIndex) -> Self {
        Self {
            p0: cylinder.p0(),
            p1: cylinder.p1(),
            radius: cylinder.radius(),
            primitive,
            material,
            caps: cylinder.caps(),
        }
    }

    /// The cylinder.
    #[inline]
    #[must_use]
    pub fn cylinder(&self) -> Cylinder {
        Cylinder::from_valid(self.p0, self.p1, self.radius, self.caps)
    }

    /// The number within the prototype.
    #[must_use]
    pub fn primitive(&self) -> u32 {
        self.primitive
    }

    /// The material.
    #[must_use]
    pub fn material(&self) -> MaterialIndex {
        self.material
    }
}

/// The precision in which cylinders are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Records {
    /// Unrounded, 64 bytes a cylinder.
    #[default]
    F64,
    /// Rounded to f32, 32 bytes a cylinder.
    F32,
}

impl Records {
    /// The name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::F32 => "f32",
        }
    }

    /// The bytes of one record.
    #[must_use]
    pub fn record_bytes(self) -> usize {
        match self {
            Self::F64 => size_of::<CylinderRecord>(),
            Self::F32 => size_of::<CylinderRecord32>(),
        }
    }
}

/// A cylinder of f32 numbers and its material, in half a cache line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct CylinderRecord32 {
    p0: [f32; 3],
    p1: [f32; 3],
    radius: f32,
    material: MaterialIndex,
    caps: Caps,
}

const _: () = assert!(size_of::<CylinderRecord32>() == 32);

impl CylinderRecord32 {
    /// The record of a rounded cylinder.
    ///
    /// # Errors
    /// If the rounded cylinder is invalid.
    pub(super) fn new(cylinder: &Cylinder, material: MaterialIndex) -> Result<Self, CylinderError> {
        let record = Self {
            p0: cylinder.p0().as_vec3().to_array(),
            p1: cylinder.p1().as_vec3().to_array(),
            radius: cylinder.radius() as f32,
            material,
            caps: cylinder.caps(),
        };
        let rounded = record.cylinder();
        Cylinder::new(rounded.p0(), rounded.p1(), rounded.radius(), rounded.caps())?;
        Ok(record)
    }

    /// The cylinder of exactly these numbers.
    #[inline]
    #[must_use]
    pub fn cylinder(&self) -> Cylinder {
        let widened = |point: [f32; 3]| Vec3::from_array(point).as_dvec3();
        let radius = f64::from(self.radius);
        Cylinder::from_valid(widened(self.p0), widened(self.p1), radius, self.caps)
    }

    /// The material.
    #[must_use]
    pub fn material(&self) -> MaterialIndex {
        self.material
    }
}
