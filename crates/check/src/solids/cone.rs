//! The cone: the hull of two disks.

use cyltrace::solid::{AnySolid, Cone};

use super::disks::Disks;
use super::{CheckedSolid, Shape};

impl CheckedSolid for Cone {
    fn shape(&self) -> Shape {
        let ends = [(self.p0(), self.radius0()), (self.p1(), self.radius1())];
        Shape::Disks(Disks::between(ends, self.caps()))
    }

    fn with_shape(&self, shape: &Shape) -> Option<AnySolid> {
        let Shape::Disks(disks) = shape else {
            return None;
        };
        let [(p0, radius0), (p1, radius1)] = disks.ends;
        Some(Self::new(p0, p1, radius0, radius1, disks.caps).ok()?.into())
    }
}
