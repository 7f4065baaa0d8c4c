//! Which ends the cylinders of a prototype have: a type for each kind, so that
//! the callbacks of a prototype whose cylinders are alike are compiled without
//! the question.

use crate::math::LANES;
use crate::scene::CylinderList;
use crate::solid::lanes::{AllCapped, AllOpen, LaneCaps, MixedCaps};
use crate::solid::{Caps, Cylinder};

/// What is known of the ends before any ray is traced.
pub(crate) trait Ends: Send + Sync + 'static {
    /// The caps of eight cylinders.
    type Lanes: LaneCaps;

    /// The cylinder, stated with what is known.
    fn known(cylinder: Cylinder) -> Cylinder;

    /// Eight times those of one cylinder.
    fn of_one(caps: Caps) -> Self::Lanes;
}

/// All are tubes.
pub(crate) struct Open;

/// All have both disks.
pub(crate) struct Capped;

/// Each as it is.
pub(crate) struct Mixed;

impl Ends for Open {
    type Lanes = AllOpen;

    #[inline(always)]
    fn known(cylinder: Cylinder) -> Cylinder {
        cylinder.with_caps(Caps::None)
    }

    #[inline(always)]
    fn of_one(_: Caps) -> AllOpen {
        AllOpen
    }
}

impl Ends for Capped {
    type Lanes = AllCapped;

    #[inline(always)]
    fn known(cylinder: Cylinder) -> Cylinder {
        cylinder.with_caps(Caps::Both)
    }

    #[inline(always)]
    fn of_one(_: Caps) -> AllCapped {
        AllCapped
    }
}

impl Ends for Mixed {
    type Lanes = MixedCaps;

    #[inline(always)]
    fn known(cylinder: Cylinder) -> Cylinder {
        cylinder
    }

    #[inline(always)]
    fn of_one(caps: Caps) -> MixedCaps {
        MixedCaps([caps; LANES])
    }
}

/// The kind of a prototype, told apart once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EndsKind {
    Open,
    Capped,
    Mixed,
}

impl EndsKind {
    /// The kind of all these cylinders together.
    pub fn of(records: &CylinderList) -> Self {
        let all = |caps| {
            records
                .iter()
                .all(|record| record.cylinder().caps() == caps)
        };
        if all(Caps::Both) {
            Self::Capped
        } else if all(Caps::None) {
            Self::Open
        } else {
            Self::Mixed
        }
    }
}
