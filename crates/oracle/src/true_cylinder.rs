//! The truth about a cylinder, as about other kinds: its first hit is that of `cylinder`, and
//! all hits are those of the cone with equal radii.

use glam::DVec3;

use super::any::TrueSolid;
use super::composed::{Leaf, TrueOperand};
use super::cylinder::{TrueHit, first_hit};
use super::gap::gap;
use super::normal::outward_normal;
use super::ray::ExactRay;
use cyltrace::math::Ray;
use cyltrace::solid::{Cone, Cylinder};

/// The cone that is the same set.
fn as_cone(cylinder: &Cylinder) -> Cone {
    let (p0, p1, radius) = (cylinder.p0(), cylinder.p1(), cylinder.radius());
    Cone::new(p0, p1, radius, radius, cylinder.caps()).expect("what is a cylinder is a cone")
}

impl TrueSolid for Cylinder {
    fn hits(&self, ray: &ExactRay) -> Vec<TrueHit> {
        as_cone(self).hits(ray)
    }

    fn first_hit(&self, ray: &Ray) -> Option<TrueHit> {
        first_hit(self, ray).hit
    }

    fn gap(&self, ray: &Ray) -> f64 {
        gap(self, ray, first_hit(self, ray).hit.as_ref())
    }

    fn outward_normal(&self, ray: &Ray, hit: &TrueHit) -> Option<DVec3> {
        Some(outward_normal(self, ray, hit))
    }

    fn truly_contains(&self, point: DVec3) -> bool {
        as_cone(self).truly_contains(point)
    }
}

impl TrueOperand for Cylinder {
    fn leaf(&self) -> Leaf {
        as_cone(self).leaf()
    }
}
