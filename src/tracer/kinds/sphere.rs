//! Spheres have a filter of their own.

use super::TracedKind;
use crate::solid::Sphere;
use crate::tracer::filter::SphereFilter;

impl TracedKind for Sphere {
    type Filter = SphereFilter;
}
