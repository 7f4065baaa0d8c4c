//! A disk is represented by a cylinder of no length. Its half axis is long enough to represent
//! the normal to within the growth of the radius: 25 % more shadow in a thicket.

use super::TracedKind;
use crate::solid::Disk;
use crate::tracer::filter::{Sheath, Sheathed};

impl TracedKind for Disk {}

impl Sheathed for Disk {
    fn sheath(&self) -> Sheath {
        Sheath {
            anchor: self.center(),
            axis: self.normal().normalize(),
            heights: [0.0; 2],
            radius: self.radius(),
        }
    }
}
