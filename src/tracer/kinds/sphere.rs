//! Spheres have a filter of their own (`filter/spheres.rs`).

use super::TracedKind;
use crate::solid::Sphere;

impl TracedKind for Sphere {}
