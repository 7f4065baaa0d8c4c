//! The fast path of cylinders: direct access to their records, and callbacks that are compiled
//! for their caps.

use std::borrow::Borrow;
use std::marker::PhantomData;

use super::TracedKind;
use crate::embree::{self, prefetch};
use crate::scene::{CylinderList, SharedRecords};
use crate::solid::{Caps, Cylinder};
use crate::tracer::filter::{Sheath, Sheathed};
use crate::tracer::prototype::{Attaching, Numbers, PrototypeRef, Records};
use crate::tracer::query::Query;

impl TracedKind for Cylinder {
    fn attach(numbers: &Numbers, to: &mut Attaching) -> Result<(), embree::Error> {
        let list = &to.prototype_ref.prototype().solids.cylinders;
        match common_caps(list) {
            Some(Caps::None) => to.attach(numbers, CylinderRecords::<Open>::new(list)),
            Some(Caps::Both) => to.attach(numbers, CylinderRecords::<Capped>::new(list)),
            _ => to.attach(numbers, CylinderRecords::<Mixed>::new(list)),
        }
    }
}

impl Sheathed for Cylinder {
    fn sheath(&self) -> Sheath {
        Sheath::between(self.p0(), self.p1(), |length| [0.0, length], self.radius())
    }
}

/// The caps of all cylinders of a prototype, if known.
trait Ends: Send + Sync + 'static {
    /// The caps, if they are all the same.
    const CAPS: Option<Caps>;
}

/// All cylinders are tubes.
struct Open;

/// All cylinders have both disks.
struct Capped;

/// The caps differ.
struct Mixed;

impl Ends for Open {
    const CAPS: Option<Caps> = Some(Caps::None);
}

impl Ends for Capped {
    const CAPS: Option<Caps> = Some(Caps::Both);
}

impl Ends for Mixed {
    const CAPS: Option<Caps> = None;
}

/// The caps of all cylinders of a list, if they are the same.
fn common_caps(list: &CylinderList) -> Option<Caps> {
    let mut caps = list.iter().map(|record| record.cylinder().caps());
    let first = caps.next()?;
    caps.all(|caps| caps == first).then_some(first)
}

/// The records of cylinders with the caps `E`.
struct CylinderRecords<E> {
    /// Direct access for callbacks, without the latency of scene, prototype and list.
    records: SharedRecords,
    ends: PhantomData<E>,
}

impl<E: Ends> CylinderRecords<E> {
    fn new(list: &CylinderList) -> Self {
        Self {
            records: list.shared(),
            ends: PhantomData,
        }
    }
}

impl<E: Ends> Records for CylinderRecords<E> {
    type Solid = Cylinder;

    #[inline(always)]
    fn solid(&self, _: &PrototypeRef, record: u32) -> impl Borrow<Cylinder> {
        let cylinder = self.records.cylinder(record as usize);
        match E::CAPS {
            Some(caps) => cylinder.with_caps(caps),
            None => cylinder,
        }
    }

    #[inline(always)]
    fn prefetch(&self, _: &PrototypeRef, record: u32) {
        match &self.records {
            SharedRecords::F64(records) => prefetch(&records[record as usize]),
            SharedRecords::F32(records) => prefetch(&records[record as usize]),
        }
    }

    #[inline(always)]
    fn visit(&self, prototype_ref: &PrototypeRef, record: u32, query: &mut Query) {
        query.visit::<Cylinder>(
            self.solid(prototype_ref, record).borrow(),
            prototype_ref,
            record,
        );
    }

    #[inline(always)]
    fn intersects(&self, prototype_ref: &PrototypeRef, record: u32, query: &Query) -> bool {
        query.intersects::<Cylinder>(self.solid(prototype_ref, record).borrow())
    }
}
