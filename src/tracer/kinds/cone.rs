//! A cone is represented by the cylinder of its greater radius. Its shadow is 17 % larger than
//! the cone's if radii vary by a factor of three, and twice as large if one of them is zero.

use super::TracedKind;
use crate::solid::Cone;
use crate::tracer::filter::{Sheath, Sheathed};

impl TracedKind for Cone {}

impl Sheathed for Cone {
    fn sheath(&self) -> Sheath {
        let radius = self.radius0().max(self.radius1());
        Sheath::between(self.p0(), self.p1(), |length| [0.0, length], radius)
    }
}
