//! The rounded cone: the hull of two balls.

use cyltrace::solid::{AnySolid, Part, RoundedCone};

use super::balls::Balls;
use super::{CheckedSolid, Shape};

impl CheckedSolid for RoundedCone {
    fn shape(&self) -> Shape {
        Shape::Balls(Balls {
            ends: [(self.p0(), self.radius0()), (self.p1(), self.radius1())],
            parts: [Part::Cap0, Part::Cap1],
        })
    }

    fn with_shape(&self, shape: &Shape) -> Option<AnySolid> {
        let Shape::Balls(balls) = shape else {
            return None;
        };
        let [(p0, radius0), (p1, radius1)] = balls.ends;
        Some(Self::new(p0, p1, radius0, radius1).ok()?.into())
    }
}
