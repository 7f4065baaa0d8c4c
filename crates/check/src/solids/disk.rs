//! The disk. Grown, it is a cylinder.

use cyltrace::solid::{AnySolid, Cylinder, Disk};

use super::disks::Disks;
use super::{CheckedSolid, Shape};

impl CheckedSolid for Disk {
    fn shape(&self) -> Shape {
        Shape::Disks(Disks::flat(self.center(), self.radius(), self.normal()))
    }

    fn with_shape(&self, shape: &Shape) -> Option<AnySolid> {
        let Shape::Disks(disks) = shape else {
            return None;
        };
        let [(p0, radius), (p1, _)] = disks.ends;
        if disks.is_flat() {
            return Some(Self::new(p0, disks.axis, radius).ok()?.into());
        }
        Some(Cylinder::new(p0, p1, radius, disks.caps).ok()?.into())
    }
}
