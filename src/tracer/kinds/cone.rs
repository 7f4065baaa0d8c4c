//! A cone is in the cylinder of its greater radius, which throws 17 % more shadow where radii
//! vary by a factor of three, twice as much where one of them is zero.

use super::TracedKind;
use crate::solid::Cone;
use crate::tracer::filter::{CylinderFilter, Sheath, Sheathed};

impl TracedKind for Cone {
    type Filter = CylinderFilter;
}

impl Sheathed for Cone {
    fn sheath(&self) -> Sheath {
        let radius = self.radius0().max(self.radius1());
        Sheath::between(self.p0(), self.p1(), |length| [0.0, length], radius)
    }
}
