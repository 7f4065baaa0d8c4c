//! Seeded families of hard rays and solids.

use crate::solid::formulations::Problem;

/// What the numbers of a case are rounded to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Inputs {
    /// Numbers that f32 holds.
    F32,
    /// Full f64 numbers.
    F64,
}

/// A family of cases that are hard in one way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Family {
    /// Ordinary cylinders seen from an ordinary distance.
    Nominal,
}

impl Family {
    /// Case `index` of the family; the same for the same arguments.
    #[must_use]
    pub fn case(self, _seed: u64, _index: u64, _inputs: Inputs) -> Problem {
        unreachable!("the families are written on a branch")
    }
}
