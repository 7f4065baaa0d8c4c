//! A row of a packet's rays against a solid.
//!
//! The rays are solved side by side where the solver has lanes. What a lane leaves open, and
//! solids without lanes, are solved ray by ray.

use crate::embree::{Instructions, Kernel};
use crate::math::{LANES, LaneMask, LaneVectors, Lanes};
use crate::solid::lanes::{self, CylinderLanes, LaneCaps, RayLanes};
use crate::solid::quick::QuickLanes;
use crate::solid::{Cylinder, settled};
use crate::tracer::decisions::{Decisions, exact_first};
use crate::tracer::frame::LocalRay;
use crate::tracer::prototype::Ends;
use crate::tracer::traced::{RowOfPacket, TracedSolid};

/// Where the `active` rays first meet a solid.
#[inline(always)]
pub(super) fn first_of_solid(
    solid: &impl TracedSolid,
    row: &RowOfPacket,
    active: LaneMask,
    decisions: Decisions,
) -> (LaneMask, Lanes) {
    let QuickLanes { open, met, t } = solid.quick_first(row, active, decisions);
    if open.any() {
        return one_by_one(row, open, (met, t), |ray, t_min, t_max| {
            Some(solid.first(ray, decisions, t_min, t_max)?.meeting.t)
        });
    }
    (met, t)
}

/// Where the `active` rays first meet a cylinder.
#[inline(always)]
pub(super) fn first_of_cylinder<E: Ends>(
    cylinder: &Cylinder,
    row: &RowOfPacket,
    active: LaneMask,
    (decisions, instructions): (Decisions, Instructions),
) -> (LaneMask, Lanes) {
    if decisions == Decisions::Exact {
        return exactly::<E>(cylinder, row, active, instructions);
    }
    lanes::first(
        &lanes_of::<E>(cylinder),
        &row.seen_from(cylinder.p0()),
        &active,
    )
}

/// A cylinder eight times.
#[inline(always)]
fn lanes_of<E: Ends>(cylinder: &Cylinder) -> CylinderLanes<E::Lanes> {
    CylinderLanes {
        axis: LaneVectors::splat(cylinder.p1() - cylinder.p0()),
        radius: Lanes::splat(cylinder.radius()),
        caps: E::of_one(cylinder.caps()),
    }
}

/// [`settled::first_in_lanes`] with the instructions of the packet.
struct SettledRow<'a, C> {
    cylinders: &'a CylinderLanes<C>,
    rays: &'a RayLanes,
    active: LaneMask,
}

impl<C: LaneCaps> Kernel for SettledRow<'_, C> {
    type Answer = QuickLanes;

    #[inline(always)]
    fn run(self) -> QuickLanes {
        settled::first_in_lanes(self.cylinders, self.rays, &self.active)
    }
}

/// The same decided exactly: what is settled in lanes, and the rest ray by ray. A call, as
/// [`exact_first`] is, which gets nothing that the caller would otherwise have in registers.
#[cold]
#[inline(never)]
fn exactly<E: Ends>(
    cylinder: &Cylinder,
    row: &RowOfPacket,
    active: LaneMask,
    instructions: Instructions,
) -> (LaneMask, Lanes) {
    let QuickLanes { open, met, t } = if row.is_plain() {
        instructions.run(SettledRow {
            cylinders: &lanes_of::<E>(cylinder),
            rays: &row.seen_from(cylinder.p0()),
            active,
        })
    } else {
        QuickLanes::all_open(active)
    };
    if !open.any() {
        return (met, t);
    }
    one_by_one(row, open, (met, t), |ray, t_min, t_max| {
        Some(exact_first(cylinder, ray, t_min, t_max)?.t)
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
