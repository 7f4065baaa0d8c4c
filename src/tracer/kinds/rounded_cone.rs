//! A rounded cone is represented by the cylinder of its greater radius. Its shadow is 17 %
//! larger than the solid's if radii vary by a factor of three, and twice as large if one of
//! them is zero.

use super::TracedKind;
use crate::solid::RoundedCone;
use crate::tracer::filter::{Sheath, Sheathed};

impl TracedKind for RoundedCone {}

impl Sheathed for RoundedCone {
    fn sheath(&self) -> Sheath {
        let (r0, r1) = (self.radius0(), self.radius1());
        // One ball may be within the other.
        let heights = |length: f64| [(-r0).min(length - r1), r0.max(length + r1)];
        Sheath::between(self.p0(), self.p1(), heights, r0.max(r1))
    }
}
