//! A row of a packet's rays against a solid.
//!
//! The rays are solved in lanes if the solver has lanes. Open lanes, and solids without lanes,
//! are solved ray by ray.

use crate::embree::{Instructions, Kernel};
use crate::math::{LANES, LaneMask, Lanes};
use crate::solid::quick::QuickLanes;
use crate::tracer::decisions::Decisions;
use crate::tracer::frame::LocalRay;
use crate::tracer::traced::{RowOfPacket, TracedSolid};

/// The first hits of the `active` rays with a solid.
#[inline(always)]
pub(super) fn first(
    solid: &impl TracedSolid,
    row: &RowOfPacket,
    active: LaneMask,
    (decisions, instructions): (Decisions, Instructions),
) -> (LaneMask, Lanes) {
    if decisions == Decisions::Exact {
        return exactly(solid, row, active, instructions);
    }
    let quick = solid.first_in_row(row, active);
    with_open(solid, row, quick, decisions)
}

/// [`TracedSolid::exact_first_in_row`] with the instructions of the packet.
struct ExactRow<'a, 'r, S> {
    solid: &'a S,
    row: &'a RowOfPacket<'r>,
    active: LaneMask,
}

impl<S: TracedSolid> Kernel for ExactRow<'_, '_, S> {
    type Answer = QuickLanes;

    #[inline(always)]
    fn run(self) -> QuickLanes {
        self.solid.exact_first_in_row(self.row, self.active)
    }
}

/// The first hits, decided exactly. Not inlined, and without arguments that would occupy the
/// caller's registers.
#[cold]
#[inline(never)]
fn exactly<S: TracedSolid>(
    solid: &S,
    row: &RowOfPacket,
    active: LaneMask,
    instructions: Instructions,
) -> (LaneMask, Lanes) {
    let quick = instructions.run(ExactRow { solid, row, active });
    with_open(solid, row, quick, Decisions::Exact)
}

/// The results, with open ones solved ray by ray.
#[inline(always)]
fn with_open(
    solid: &impl TracedSolid,
    row: &RowOfPacket,
    QuickLanes { open, hit, t }: QuickLanes,
    decisions: Decisions,
) -> (LaneMask, Lanes) {
    if !open.any() {
        return (hit, t);
    }
    one_by_one(row, open, (hit, t), |ray, t_min, t_max| {
        Some(solid.first(ray, decisions, t_min, t_max)?.intersection.t)
    })
}

/// The results, with those of `first` where `open` is set; `first` returns the `t` of a ray's
/// first hit. Not inlined: a solver with branches gains nothing from being compiled for each
/// instruction set.
#[inline(never)]
fn one_by_one(
    row: &RowOfPacket,
    open: LaneMask,
    (mut hit, mut t): (LaneMask, Lanes),
    first: impl Fn(&LocalRay, f64, f64) -> Option<f64>,
) -> (LaneMask, Lanes) {
    for lane in (0..LANES).filter(|&lane| open.0[lane]) {
        let ray = row.rays.ray(row.row, lane);
        if let Some(first) = first(&ray, row.t_min.0[lane], row.t_max.0[lane]) {
            hit.0[lane] = true;
            t.0[lane] = first;
        }
    }
    (hit, t)
}
