//! What the library promises about its own solvers, in one table.

use std::fmt;

use crate::formulations::Precision;
use cyltrace_oracle::cases::Inputs;

use super::cell::Cell;

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Promise {
    /// The names of the contenders; their precision is f64.
    pub formulations: &'static [&'static str],
    /// For which inputs.
    pub inputs: Inputs,
    /// What is promised, in every family.
    pub claim: Claim,
    /// What it rests on.
    pub why: &'static str,
}

/// A claim about a cell, true or false.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Claim {
    /// Every hit, miss and part is the true one.
    Right,
    /// The same of cases that are promised, see [`super::Witness::new`].
    RightWhereDecided,
    /// The same where [`Witness::gap`](super::Witness::gap) is above 4 u.
    RightBeyondRounding,
    /// The share of 0.999 of `t` rounded to f32 is within this number of f32 ulps.
    ThousandthF32Ulps(f64),
    /// Every crossing of every ray is the true one.
    EveryCrossing,
    /// Every point is located where it is.
    PointsLocated,
    /// Every `t` is within this number of f64 ulps.
    EveryF64Ulps(f64),
    /// Every promised `t` is within the bound of `docs/derivations.md`.
    WithinBound,
    /// Every answer is finite.
    Finite,
    /// No spawned ray hits the surface at its own origin.
    NoSelfHit,
}

/// The solver and its form with products kept.
const TRIPLE_PRODUCT: &[&str] = &["triple-product", "triple-product-prepared"];
const EXACT: &[&str] = &["exact", "exact-rounded"];
/// The same with every `t` rounded, as the library does for a final hit.
const EXACT_ROUNDED: &[&str] = &["exact-rounded"];

/// The solvers of the solids that are no cylinders, by their kinds.
const SOLVERS: &[&str] = &["cone", "rounded_cone", "sphere", "cuboid", "disk"];

/// The solvers of all kinds with exact decisions.
const EXACT_SOLVERS: &[&str] = &[
    "exact_cylinder",
    "exact_cone",
    "exact_rounded_cone",
    "exact_sphere",
    "exact_cuboid",
    "exact_disk",
];

/// The solver of set operations.
const SET_OPERATIONS: &[&str] = &["set_operations"];

/// (3) to (6) are those of `docs/derivations.md`, section 2.
const DERIVED: &str = "derived, (3) to (6)";
const MEASURED: &str = "measured, 20 families of 10^6";
const CERTIFIED: &str = "certified by construction";
const EXACT_SIGNS: &str = "signs decided exactly, section 8";
const STATED: &str = "signs decided exactly from the stated numbers, section 8";
const NEIGHBOURHOOD: &str = "neighborhoods classified exactly";
const SPAWN: &str = "derived, section 5";

const fn promise(
    formulations: &'static [&'static str],
    inputs: Inputs,
    claim: Claim,
    why: &'static str,
) -> Promise {
    Promise {
        formulations,
        inputs,
        claim,
        why,
    }
}

/// Rounding to f32 alone gives 0.5; a tie after the rounding to f64 may go
/// the wrong way and add the error of `t` in f64, 2^-29 f32 ulps for each.
const ROUNDED_TO_F32: Claim = Claim::ThousandthF32Ulps(0.501);

/// All promises.
pub const PROMISES: &[Promise] = &[
    promise(TRIPLE_PRODUCT, Inputs::F32, Claim::Right, MEASURED),
    promise(TRIPLE_PRODUCT, Inputs::F32, ROUNDED_TO_F32, MEASURED),
    promise(TRIPLE_PRODUCT, Inputs::F32, Claim::WithinBound, DERIVED),
    promise(TRIPLE_PRODUCT, Inputs::F32, Claim::Finite, DERIVED),
    promise(TRIPLE_PRODUCT, Inputs::F32, Claim::NoSelfHit, SPAWN),
    promise(
        TRIPLE_PRODUCT,
        Inputs::F64,
        Claim::RightWhereDecided,
        DERIVED,
    ),
    promise(TRIPLE_PRODUCT, Inputs::F64, Claim::WithinBound, DERIVED),
    promise(TRIPLE_PRODUCT, Inputs::F64, Claim::Finite, DERIVED),
    promise(TRIPLE_PRODUCT, Inputs::F64, Claim::NoSelfHit, SPAWN),
    promise(EXACT, Inputs::F32, Claim::Right, CERTIFIED),
    promise(
        EXACT_ROUNDED,
        Inputs::F32,
        Claim::EveryF64Ulps(0.5),
        CERTIFIED,
    ),
    promise(EXACT, Inputs::F32, Claim::NoSelfHit, SPAWN),
    promise(EXACT, Inputs::F64, Claim::Right, CERTIFIED),
    promise(
        EXACT_ROUNDED,
        Inputs::F64,
        Claim::EveryF64Ulps(0.5),
        CERTIFIED,
    ),
    promise(EXACT, Inputs::F64, Claim::NoSelfHit, SPAWN),
    promise(SOLVERS, Inputs::F32, Claim::Right, EXACT_SIGNS),
    promise(SOLVERS, Inputs::F32, ROUNDED_TO_F32, EXACT_SIGNS),
    promise(SOLVERS, Inputs::F32, Claim::Finite, EXACT_SIGNS),
    promise(SOLVERS, Inputs::F32, Claim::NoSelfHit, SPAWN),
    promise(
        SOLVERS,
        Inputs::F64,
        Claim::RightBeyondRounding,
        EXACT_SIGNS,
    ),
    promise(SOLVERS, Inputs::F64, Claim::Finite, EXACT_SIGNS),
    promise(SOLVERS, Inputs::F64, Claim::NoSelfHit, SPAWN),
    promise(EXACT_SOLVERS, Inputs::F32, Claim::Right, STATED),
    promise(EXACT_SOLVERS, Inputs::F32, ROUNDED_TO_F32, STATED),
    promise(EXACT_SOLVERS, Inputs::F32, Claim::Finite, STATED),
    promise(EXACT_SOLVERS, Inputs::F32, Claim::NoSelfHit, SPAWN),
    promise(EXACT_SOLVERS, Inputs::F64, Claim::Right, STATED),
    promise(EXACT_SOLVERS, Inputs::F64, Claim::Finite, STATED),
    promise(EXACT_SOLVERS, Inputs::F64, Claim::NoSelfHit, SPAWN),
    promise(SET_OPERATIONS, Inputs::F32, Claim::Right, NEIGHBOURHOOD),
    promise(
        SET_OPERATIONS,
        Inputs::F32,
        Claim::EveryCrossing,
        NEIGHBOURHOOD,
    ),
    promise(
        SET_OPERATIONS,
        Inputs::F32,
        Claim::PointsLocated,
        NEIGHBOURHOOD,
    ),
    promise(SET_OPERATIONS, Inputs::F32, ROUNDED_TO_F32, EXACT_SIGNS),
    promise(SET_OPERATIONS, Inputs::F32, Claim::Finite, EXACT_SIGNS),
    promise(
        SET_OPERATIONS,
        Inputs::F64,
        Claim::PointsLocated,
        NEIGHBOURHOOD,
    ),
    promise(SET_OPERATIONS, Inputs::F64, Claim::Finite, EXACT_SIGNS),
];

impl Promise {
    /// The promises about a cell.
    pub fn about(cell: &Cell) -> impl Iterator<Item = &'static Self> + use<> {
        let Cell {
            formulation,
            inputs,
            precision,
            ..
        } = *cell;
        PROMISES.iter().filter(move |promise| {
            precision == Precision::F64
                && promise.formulations.contains(&formulation)
                && promise.inputs == inputs
        })
    }

    /// Whether it is kept in the cell.
    #[must_use]
    pub fn is_kept(&self, cell: &Cell) -> bool {
        let figures = &cell.figures;
        match self.claim {
            Claim::Right => figures.wrong_hit == 0 && figures.wrong_part == 0,
            Claim::RightWhereDecided | Claim::RightBeyondRounding => figures.wrong_decided == 0,
            Claim::ThousandthF32Ulps(most) => figures.t_f32_ulps.at(0.999) <= most,
            Claim::EveryCrossing => figures.wrong_crossing == 0,
            Claim::PointsLocated => figures.wrong_point == 0,
            Claim::EveryF64Ulps(most) => figures.t_f64_ulps.greatest() <= most,
            Claim::WithinBound => figures.t_bound_used <= 1.0,
            Claim::Finite => figures.non_finite == 0,
            Claim::NoSelfHit => figures.self_hits == 0,
        }
    }
}

impl fmt::Display for Claim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Right => f.write_str("no wrong hit, miss or part"),
            Self::EveryCrossing => f.write_str("no wrong crossing"),
            Self::PointsLocated => f.write_str("no wrong point"),
            Self::RightWhereDecided => f.write_str(
                "no wrong hit, miss or part where wall gap > 20 u (1 + |x|/r + k) and gap > 64 u",
            ),
            Self::RightBeyondRounding => f.write_str("no wrong hit, miss or part where gap > 4 u"),
            Self::ThousandthF32Ulps(most) => {
                write!(f, "99.9 % of t within {most} f32 ulps")
            }
            Self::EveryF64Ulps(most) => write!(f, "every t within {most} f64 ulps"),
            Self::WithinBound => f.write_str("t within (4) to (6) where hit and part are promised"),
            Self::Finite => f.write_str("every answer finite"),
            Self::NoSelfHit => f.write_str("no spawned ray hits the surface at its start"),
        }
    }
}
