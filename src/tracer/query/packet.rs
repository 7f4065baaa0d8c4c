//! A query of up to sixteen rays that Embree traverses together.
//!
//! The rays of one level are stored in rows of eight lanes for the solver, in the order of the
//! caller, and are read one by one for other computations. The results are those of sixteen
//! single queries, bit for bit: the arithmetic is the same in every lane, and no ray's result
//! depends on another's.

use super::found::{InstancePath, Nearest, QueryMode, SolidSlot};
use super::levels::Levels;
use super::position::Position;
use super::row;
use super::single::Query;
use crate::embree::{self, GREATEST_PACKET, GeometryId, Instructions, RaySet};
use crate::math::{ChildFromParent, LANES, LaneMask, Lanes};
use crate::scene::PrototypeIndex;
use crate::tracer::counters;
use crate::tracer::decisions::Decisions;
use crate::tracer::frame::{
    Enter, Frame, IntoChild, IntoInstance, PacketEntry, PacketRays, ROWS, Rows,
};
use crate::tracer::prototype::PrototypeRef;
use crate::tracer::traced::{RowOfPacket, TracedSolid};

/// The state of a packet.
pub(crate) struct Packet {
    t_min: Rows<Lanes>,
    t_max: Rows<Lanes>,
    decisions: Decisions,
    /// The greatest `t` that can still be a first hit.
    bound: Rows<Lanes>,
    nearest: [Option<Nearest>; GREATEST_PACKET],
    /// Whether Embree traverses the rays as a packet, or one by one.
    pub is_together: bool,
    pub position: Position,
    levels: Levels,
    /// The rays in the instance of the last callback.
    in_instance: PacketRays,
    /// The rays in an opened prototype.
    between: PacketRays,
    instructions: Instructions,
    /// The number of callbacks, the measure of its cost.
    pub callbacks: u32,
}

impl embree::Query for Query {
    type Packet = Packet;
}

impl Packet {
    /// An empty packet, to be computed with these instructions.
    pub fn new(instructions: Instructions, decisions: Decisions) -> Self {
        let nowhere = [Lanes::splat(0.0); ROWS];
        Self {
            t_min: nowhere,
            t_max: nowhere,
            decisions,
            bound: nowhere,
            nearest: [const { None }; GREATEST_PACKET],
            is_together: true,
            position: Position::new(InstancePath::new()),
            levels: Levels::new(),
            in_instance: PacketRays::NOWHERE,
            between: PacketRays::NOWHERE,
            instructions,
            callbacks: 0,
        }
    }

    /// Begins a query of rays in these ranges, for their first hits or for occlusion. Embree
    /// traverses them as a packet if `is_together`, otherwise one by one.
    pub fn begin(&mut self, t_min: Rows<Lanes>, t_max: Rows<Lanes>, is_together: bool) {
        (self.t_min, self.t_max, self.bound) = (t_min, t_max, t_max);
        self.is_together = is_together;
        self.nearest.fill(None);
        self.callbacks = 0;
    }

    /// Removes and returns the first hit of a ray.
    pub fn take_nearest(&mut self, ray: usize) -> Option<Nearest> {
        self.nearest[ray].take()
    }

    /// Brings rays to the root.
    pub fn arrive(&mut self, rays: &PacketRays) {
        self.levels.next().rays.clone_from(rays);
    }

    /// Maps the rays into a child, through a placement in the current prototype.
    pub fn arrive_through(&mut self, child_from_parent: &ChildFromParent) {
        self.position.leave_instance();
        let (level, next) = self.levels.current_and_next();
        self.instructions.run(IntoChild {
            rays: &level.rays,
            child_from_parent,
            in_child: &mut next.rays,
        });
    }

    /// Enters the prototype that the rays were brought to, with the `wanted` rays.
    pub fn enter(&mut self, frame: &Frame, wanted: RaySet) -> PacketEntry {
        self.instructions.run(Enter {
            frame,
            level: self.levels.next(),
            wanted,
            t_min: &self.t_min,
            t_max: &self.bound,
        })
    }

    /// Runs `trace` with the rays in the prototype that they have entered.
    pub fn within<T>(
        &mut self,
        prototype: PrototypeIndex,
        trace: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let outer = self.position.enter(prototype);
        self.levels.descend();
        let answer = trace(self);
        self.levels.ascend();
        self.position.return_to(outer);
        answer
    }

    /// As [`Query::reach`].
    #[inline(always)]
    pub fn reach(&mut self, instance: Option<GeometryId>, prototype_ref: &PrototypeRef) {
        if instance != self.position.instance() {
            self.change_instance(instance, prototype_ref);
        }
    }

    #[inline(never)]
    fn change_instance(&mut self, instance: Option<GeometryId>, prototype_ref: &PrototypeRef) {
        let mut is_first = true;
        let step = |child_from_parent: &ChildFromParent, frame: &Frame| {
            if !is_first {
                self.between.clone_from(&self.in_instance);
            }
            self.instructions.run(IntoInstance {
                rays: if is_first {
                    &self.levels.current().rays
                } else {
                    &self.between
                },
                child_from_parent,
                frame,
                in_child: &mut self.in_instance,
            });
            is_first = false;
        };
        self.position.change_instance(instance, prototype_ref, step);
    }

    /// Counts a callback.
    #[inline(always)]
    pub fn called_back(&mut self) {
        counters::called_back();
        self.callbacks += 1;
    }

    /// Runs `trace` with a query of one ray of the packet in the prototype that it has entered,
    /// and keeps its result.
    pub fn alone<T>(
        &mut self,
        prototype: PrototypeIndex,
        ray: usize,
        trace: impl FnOnce(&mut Query) -> T,
    ) -> T {
        let (t_min, t_max) = (lane(&self.t_min, ray), lane(&self.t_max, ray));
        let level = self.levels.next().of_ray(ray);
        let path = std::mem::take(&mut self.position.path);
        let mut query = Query::new(
            [t_min, t_max],
            self.decisions,
            path,
            self.nearest[ray].take(),
        );
        let answer = query.within(prototype, level, trace);
        self.callbacks += query.callbacks;
        if let QueryMode::First(nearest) = query.mode {
            if let Some(nearest) = &nearest {
                set_lane(&mut self.bound, ray, nearest.t);
            }
            self.nearest[ray] = nearest;
        }
        self.position.path = query.position.path;
        answer
    }

    /// The rays in the space of the current callback.
    #[inline(always)]
    fn rays(&self) -> &PacketRays {
        match self.position.instance() {
            None => &self.levels.current().rays,
            Some(_) => &self.in_instance,
        }
    }

    /// The greatest `t` that can still be part of a ray's result.
    #[inline(always)]
    pub fn bound(&self, ray: usize) -> f64 {
        lane(&self.bound, ray)
    }

    /// The `t_far` up to which a ray would keep hits.
    #[inline(always)]
    pub fn t_far(&self, ray: usize) -> f32 {
        self.levels.current().window(ray).t_far(self.bound(ray))
    }

    /// Keeps the first hits of rays with a solid of the current prototype, if they are before
    /// the known ones. Returns the rays that now end earlier, and sets their `t_far`. `solid`
    /// is that of the record.
    #[inline(always)]
    pub fn visit<S: TracedSolid>(
        &mut self,
        solid: &S,
        (prototype_ref, record): (&PrototypeRef, u32),
        rays: RaySet,
        t_far: &mut [f32; GREATEST_PACKET],
    ) -> RaySet {
        let member = SolidSlot::new(solid.kind(), record);
        let mut shorter = RaySet::EMPTY;
        for row in 0..ROWS {
            let wanted = (rays.bits() >> (row * LANES)) as u8;
            if wanted == 0 {
                continue;
            }
            let (hit, t) = self.first(solid, row, wanted, &self.bound[row]);
            self.offer_row((row, hit, t), (prototype_ref, member), |packet, ray| {
                t_far[ray] = packet.t_far(ray);
                shorter.insert(ray);
            });
        }
        shorter
    }

    /// The rays that hit a solid of the current prototype.
    #[inline(always)]
    pub fn intersects<S: TracedSolid>(&self, solid: &S, rays: RaySet) -> RaySet {
        let mut blocked = 0;
        for row in 0..ROWS {
            let wanted = (rays.bits() >> (row * LANES)) as u8;
            if wanted != 0 {
                let (hit, _) = self.first(solid, row, wanted, &self.t_max[row]);
                blocked |= u16::from(hit.bits()) << (row * LANES);
            }
        }
        RaySet::from_bits(blocked)
    }

    /// A row of the rays, with their ranges up to `t_max`.
    #[inline(always)]
    fn row<'a>(&'a self, row: usize, t_max: &'a Lanes) -> RowOfPacket<'a> {
        RowOfPacket {
            rays: self.rays(),
            row,
            t_min: &self.t_min[row],
            t_max,
        }
    }

    /// The first hits of the `wanted` rays of a row with a solid.
    #[inline(always)]
    fn first(
        &self,
        solid: &impl TracedSolid,
        row: usize,
        wanted: u8,
        t_max: &Lanes,
    ) -> (LaneMask, Lanes) {
        counters::solved(wanted.count_ones());
        let active = LaneMask::from_bits(wanted);
        let how = (self.decisions, self.instructions);
        row::first(solid, &self.row(row, t_max), active, how)
    }

    /// Keeps the first hits of the rays of a row that `hit` a solid, if they are before the
    /// known ones, and passes such rays to `is_shorter`.
    #[inline(always)]
    fn offer_row(
        &mut self,
        (row, hit, t): (usize, LaneMask, Lanes),
        (prototype_ref, member): (&PrototypeRef, SolidSlot),
        mut is_shorter: impl FnMut(&Self, usize),
    ) {
        let mut hit = hit.bits();
        while hit != 0 {
            let in_row = hit.trailing_zeros() as usize;
            hit &= hit - 1;
            let ray = row * LANES + in_row;
            if self.offer(ray, t.0[in_row], prototype_ref, member) {
                is_shorter(self, ray);
            }
        }
    }

    /// Keeps a ray's first hit if it is before the known one.
    #[inline(always)]
    fn offer(
        &mut self,
        ray: usize,
        t: f64,
        prototype_ref: &PrototypeRef,
        member: SolidSlot,
    ) -> bool {
        let nearest = &mut self.nearest[ray];
        let is_first = self.position.offer(nearest, t, (prototype_ref, member));
        if is_first {
            set_lane(&mut self.bound, ray, t);
        }
        is_first
    }
}

#[inline(always)]
fn lane(rows: &Rows<Lanes>, ray: usize) -> f64 {
    rows[ray / LANES].0[ray % LANES]
}

#[inline(always)]
fn set_lane(rows: &mut Rows<Lanes>, ray: usize, value: f64) {
    rows[ray / LANES].0[ray % LANES] = value;
}
