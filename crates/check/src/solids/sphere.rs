//! The sphere: one ball.

use cyltrace::solid::{AnySolid, Part, Sphere};

use super::balls::Balls;
use super::{CheckedSolid, Shape};

impl CheckedSolid for Sphere {
    fn shape(&self) -> Shape {
        Shape::Balls(Balls {
            ends: [(self.center(), self.radius()); 2],
            parts: [Part::Side; 2],
        })
    }

    fn with_shape(&self, shape: &Shape) -> Option<AnySolid> {
        let Shape::Balls(balls) = shape else {
            return None;
        };
        let (center, radius) = balls.ends[0];
        Some(Self::new(center, radius).ok()?.into())
    }
}
