//! A row of a packet's rays against a solid.
//!
//! The rays are solved side by side where the solver has lanes. What a lane leaves open, and
//! solids without lanes, are solved ray by ray.

use crate::embree::{Instructions, Kernel};
use crate::math::{LANES, LaneMask, Lanes};
use crate::solid::quick::QuickLanes;
use crate::tracer::decisions::Decisions;
use crate::tracer::frame::LocalRay;
use crate::tracer::traced::{RowOfPacket, TracedSolid};

/// Where the `active` rays first meet a solid.
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

/// The same decided exactly. A call, which gets nothing that the caller would otherwise have
/// in registers.
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

/// The answers with those that are left open, ray by ray.
#[inline(always)]
fn with_open(
    solid: &impl TracedSolid,
    row: &RowOfPacket,
    QuickLanes { open, met, t }: QuickLanes,
    decisions: Decisions,
) -> (LaneMask, Lanes) {
    if !open.any() {
        return (met, t);
    }
    one_by_one(row, open, (met, t), |ray, t_min, t_max| {
        Some(solid.first(ray, decisions, t_min, t_max)?.intersection.t)
    })
}

/// The answers with those of `first`, which returns where a ray first meets a solid, where
/// `open` is set. A call, for a solver with its branches gains nothing from being compiled for
/// each instruction set.
#[inline(never)]
fn one_by_one(
    row: &RowOfPacket,
    open: LaneMask,
    (mut met, mut t): (LaneMask, Lanes),
    first: impl Fn(&LocalRay, f64, f64) -> Option<f64>,
) -> (LaneMask, Lanes) {
    for lane in (0..LANES).filter(|&lane| open.0[lane]) {
        let ray = row.rays.ray(row.row, lane);
        if let Some(first) = first(&ray, row.t_min.0[lane], row.t_max.0[lane]) {
            met.0[lane] = true;
            t.0[lane] = first;
        }
    }
    (met, t)
}
