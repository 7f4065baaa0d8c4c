//! Seeded families of hard rays and solids.
//!
//! Case `index` of a family depends on the seed, the family, the index and
//! the [`Inputs`] and on nothing else, so that any thread can draw any case
//! and a case can be named by four words. All numbers are rounded to what
//! [`Inputs`] says *before* the next are drawn from them: the rounded numbers
//! are the case, and a solver is never blamed for a rounding of the family.

mod aiming;
mod any;
mod composed;
mod cuboids;
mod disks;
mod families;
mod problem;
mod shapes;
mod spheres;
mod tapers;
mod unknown_family;

pub use any::{AnyFamily, Case, HardCases};
pub use composed::{ComposedCase, ComposedFamily};
pub use cuboids::CuboidFamily;
pub use disks::DiskFamily;
pub use families::Family;
pub use problem::Problem;
pub use spheres::SphereFamily;
pub use tapers::{TaperCase, TaperFamily, TaperSolid};
pub use unknown_family::{UnknownFamily, family_named};

use any::with_hyphens;
use glam::DVec3;

/// What the numbers of a case are rounded to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Inputs {
    /// Numbers that f32 represents.
    F32,
    /// Full f64 numbers.
    F64,
}

impl Inputs {
    /// Both, in the order of tables.
    pub const ALL: [Self; 2] = [Self::F32, Self::F64];

    /// The name on the command line and in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }

    /// Half an ulp of 1 in these numbers.
    #[must_use]
    pub fn unit_roundoff(self) -> f64 {
        match self {
            Self::F32 => f64::from(f32::EPSILON) / 2.0,
            Self::F64 => f64::EPSILON / 2.0,
        }
    }

    /// The number of this kind that is nearest to `x`.
    #[must_use]
    pub fn number(self, x: f64) -> f64 {
        match self {
            Self::F32 => f64::from(x as f32),
            Self::F64 => x,
        }
    }

    /// The vector of such numbers that is nearest to `v`.
    #[must_use]
    pub fn vector(self, v: DVec3) -> DVec3 {
        v.map(|x| self.number(x))
    }

    /// The number of this kind that is `steps` neighbours above `x`, which is
    /// one itself.
    #[must_use]
    pub fn stepped(self, x: f64, steps: i32) -> f64 {
        let mut x = x;
        for _ in 0..steps.unsigned_abs() {
            x = match (self, steps > 0) {
                (Self::F32, true) => f64::from((x as f32).next_up()),
                (Self::F32, false) => f64::from((x as f32).next_down()),
                (Self::F64, true) => x.next_up(),
                (Self::F64, false) => x.next_down(),
            };
        }
        x
    }
}
