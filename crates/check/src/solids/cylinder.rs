//! The cylinder: the hull of two equal disks.

use cyltrace::solid::{AnySolid, Cylinder};

use super::disks::Disks;
use super::{CheckedSolid, Shape};

impl CheckedSolid for Cylinder {
    fn shape(&self) -> Shape {
        let ends = [self.p0(), self.p1()].map(|end| (end, self.radius()));
        Shape::Disks(Disks::between(ends, self.caps()))
    }

    fn with_shape(&self, shape: &Shape) -> Option<AnySolid> {
        let Shape::Disks(disks) = shape else {
            return None;
        };
        let [(p0, radius), (p1, _)] = disks.ends;
        Some(Self::new(p0, p1, radius, disks.caps).ok()?.into())
    }
}
