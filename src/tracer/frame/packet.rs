//! Packets of rays in prototypes: the steps of single rays, in rows of lanes.
//!
//! The loops call functions without a branch, and the compiler vectorizes them for the
//! instruction set for which they are [run](crate::embree::Instructions::run).

use super::{Entry, Frame, Level, LocalRay, Window};
use crate::embree::{GREATEST_PACKET, Kernel, Ray32, RaySet, Rays32};
use crate::math::{ChildFromParent, LANES, LaneVectors, Lanes};

/// The number of rows of lanes in a packet.
pub(crate) const ROWS: usize = GREATEST_PACKET / LANES;

/// Values for every ray of a packet, in rows of lanes.
pub(crate) type Rows<T> = [T; ROWS];

/// The rays of a packet in a prototype's own space; see [`LocalRay`].
#[derive(Clone)]
pub(crate) struct PacketRays {
    pub origin: Rows<LaneVectors>,
    pub direction: Rows<LaneVectors>,
    pub base: Rows<LaneVectors>,
    pub shift: Rows<Lanes>,
}

/// The windows of the rays of a packet; see [`Window`].
struct Windows {
    shift: Rows<Lanes>,
    nearest: Rows<Lanes>,
    start: Rows<Lanes>,
    rate: Rows<Lanes>,
}

/// A packet in one prototype.
pub(crate) struct PacketLevel {
    /// The rays for the prototype's solvers.
    pub rays: PacketRays,
    windows: Windows,
}

/// A packet that has entered a prototype.
pub(crate) struct PacketEntry {
    /// The rays for its Embree scene.
    pub rays32: Rays32,
    /// The rays that are inside.
    pub entered: RaySet,
}

const ZEROS: Rows<Lanes> = [Lanes([0.0; LANES]); ROWS];
const ORIGINS: Rows<LaneVectors> = [LaneVectors {
    x: Lanes([0.0; LANES]),
    y: Lanes([0.0; LANES]),
    z: Lanes([0.0; LANES]),
}; ROWS];

impl PacketRays {
    /// No rays.
    pub const NOWHERE: Self = Self {
        origin: ORIGINS,
        direction: ORIGINS,
        base: ORIGINS,
        shift: ZEROS,
    };

    /// One of the rays.
    #[inline(always)]
    pub fn ray(&self, row: usize, lane: usize) -> LocalRay {
        LocalRay {
            origin: self.origin[row].lane(lane),
            direction: self.direction[row].lane(lane),
            base: self.base[row].lane(lane),
            shift: self.shift[row].0[lane],
        }
    }

    #[inline(always)]
    pub fn set(&mut self, row: usize, lane: usize, ray: &LocalRay) {
        self.origin[row].set(lane, ray.origin);
        self.direction[row].set(lane, ray.direction);
        self.base[row].set(lane, ray.base);
        self.shift[row].0[lane] = ray.shift;
    }
}

/// [`LocalRay::in_child`] of a packet.
pub(crate) struct IntoChild<'a> {
    pub rays: &'a PacketRays,
    pub child_from_parent: &'a ChildFromParent,
    /// The rays in the child.
    pub in_child: &'a mut PacketRays,
}

impl Kernel for IntoChild<'_> {
    type Answer = ();

    #[inline(always)]
    fn run(self) {
        for row in 0..ROWS {
            for lane in 0..LANES {
                let ray = self.rays.ray(row, lane).in_child(self.child_from_parent);
                self.in_child.set(row, lane, &ray);
            }
        }
    }
}

/// Maps the rays of a packet into the child of an instance, for its solvers, and moves far rays
/// nearer.
pub(crate) struct IntoInstance<'a> {
    pub rays: &'a PacketRays,
    pub child_from_parent: &'a ChildFromParent,
    pub frame: &'a Frame,
    /// The rays in the child.
    pub in_child: &'a mut PacketRays,
}

impl Kernel for IntoInstance<'_> {
    type Answer = ();

    #[inline(always)]
    fn run(self) {
        let Self {
            rays,
            child_from_parent,
            ..
        } = self;
        let in_child = self.in_child;
        IntoChild {
            rays,
            child_from_parent,
            in_child,
        }
        .run();
        let mut far = [false; GREATEST_PACKET];
        for row in 0..ROWS {
            for lane in 0..LANES {
                far[row * LANES + lane] = self.frame.is_far(&in_child.ray(row, lane));
            }
        }
        for number in RaySet::of(&far) {
            let (row, lane) = (number / LANES, number % LANES);
            let nearer = self.frame.approach(&in_child.ray(row, lane));
            in_child.set(row, lane, &nearer);
        }
    }
}

/// [`Frame::enter`] of a packet.
pub(crate) struct Enter<'a> {
    pub frame: &'a Frame,
    /// The rays in the prototype's own space. Far rays are moved nearer.
    pub level: &'a mut PacketLevel,
    /// The rays that are to enter.
    pub wanted: RaySet,
    pub t_min: &'a Rows<Lanes>,
    pub t_max: &'a Rows<Lanes>,
}

impl Kernel for Enter<'_> {
    type Answer = PacketEntry;

    #[inline(always)]
    fn run(mut self) -> PacketEntry {
        let mut entry = PacketEntry {
            rays32: Rays32 {
                origin: [[0.0; GREATEST_PACKET]; 3],
                direction: [[0.0; GREATEST_PACKET]; 3],
                t_far: [0.0; GREATEST_PACKET],
            },
            entered: RaySet::EMPTY,
        };
        let (mut inside, mut far) = ([false; GREATEST_PACKET], [false; GREATEST_PACKET]);
        for row in 0..ROWS {
            // A copy of the row: the loop reads nothing that it writes.
            let rays = &self.level.rays;
            let rays = RowOfRays {
                origin: rays.origin[row],
                direction: rays.direction[row],
                base: rays.base[row],
                shift: rays.shift[row],
                t_min: self.t_min[row],
                t_max: self.t_max[row],
            };
            let mut entries = RowOfEntries::NOWHERE;
            for lane in 0..LANES {
                let ray = rays.ray(lane);
                let passing = self.frame.passing(&ray);
                let one = self
                    .frame
                    .entry(&ray, &passing, rays.t_min.0[lane], rays.t_max.0[lane]);
                entries.set(lane, &one, passing.is_far);
            }
            self.level.windows.set_row(row, rays.shift, &entries);
            entry.set_row(row, &entries);
            inside[row * LANES..][..LANES].copy_from_slice(&entries.is_inside);
            far[row * LANES..][..LANES].copy_from_slice(&entries.is_far);
        }
        let far = RaySet::of(&far) & self.wanted;
        entry.entered = (RaySet::of(&inside) & self.wanted) - far;
        if !far.is_empty() {
            self.enter_from_afar(far, &mut entry);
        }
        entry
    }
}

/// Eight rays with their ranges.
struct RowOfRays {
    origin: LaneVectors,
    direction: LaneVectors,
    base: LaneVectors,
    shift: Lanes,
    t_min: Lanes,
    t_max: Lanes,
}

impl RowOfRays {
    #[inline(always)]
    fn ray(&self, lane: usize) -> LocalRay {
        LocalRay {
            origin: self.origin.lane(lane),
            direction: self.direction.lane(lane),
            base: self.base.lane(lane),
            shift: self.shift.0[lane],
        }
    }
}

/// The entries of eight rays.
struct RowOfEntries {
    nearest: Lanes,
    start: Lanes,
    rate: Lanes,
    origin: [[f32; LANES]; 3],
    direction: [[f32; LANES]; 3],
    t_far: [f32; LANES],
    is_inside: [bool; LANES],
    is_far: [bool; LANES],
}

impl RowOfEntries {
    const NOWHERE: Self = Self {
        nearest: Lanes([0.0; LANES]),
        start: Lanes([0.0; LANES]),
        rate: Lanes([0.0; LANES]),
        origin: [[0.0; LANES]; 3],
        direction: [[0.0; LANES]; 3],
        t_far: [0.0; LANES],
        is_inside: [false; LANES],
        is_far: [false; LANES],
    };

    #[inline(always)]
    fn set(&mut self, lane: usize, entry: &Entry, is_far: bool) {
        self.nearest.0[lane] = entry.window.nearest;
        self.start.0[lane] = entry.window.start;
        self.rate.0[lane] = entry.window.rate;
        for axis in 0..3 {
            self.origin[axis][lane] = entry.ray32.origin[axis];
            self.direction[axis][lane] = entry.ray32.direction[axis];
        }
        self.t_far[lane] = entry.ray32.t_far;
        self.is_inside[lane] = entry.is_inside;
        self.is_far[lane] = is_far;
    }
}

impl Enter<'_> {
    /// Enters with rays that have to be moved nearer first.
    #[cold]
    #[inline(never)]
    fn enter_from_afar(&mut self, far: RaySet, entry: &mut PacketEntry) {
        for number in far {
            let (row, lane) = (number / LANES, number % LANES);
            let ray = self.level.rays.ray(row, lane);
            let passing = self.frame.passing(&ray);
            if self.frame.is_missed_from_afar(&passing) {
                continue;
            }
            let (ray, passing) = self.frame.approach_from_afar(&ray, passing.nearest);
            let (t_min, t_max) = (self.t_min[row].0[lane], self.t_max[row].0[lane]);
            let one = self.frame.entry(&ray, &passing, t_min, t_max);
            self.level.rays.set(row, lane, &ray);
            self.level.windows.set(row, lane, &one.window);
            entry.set(number, &one.ray32);
            if one.is_inside {
                entry.entered.insert(number);
            }
        }
    }
}

impl PacketEntry {
    #[inline(always)]
    fn set_row(&mut self, row: usize, entries: &RowOfEntries) {
        let lanes = row * LANES..(row + 1) * LANES;
        for axis in 0..3 {
            self.rays32.origin[axis][lanes.clone()].copy_from_slice(&entries.origin[axis]);
            self.rays32.direction[axis][lanes.clone()].copy_from_slice(&entries.direction[axis]);
        }
        self.rays32.t_far[lanes].copy_from_slice(&entries.t_far);
    }

    #[inline(always)]
    fn set(&mut self, number: usize, ray: &Ray32) {
        for axis in 0..3 {
            self.rays32.origin[axis][number] = ray.origin[axis];
            self.rays32.direction[axis][number] = ray.direction[axis];
        }
        self.rays32.t_far[number] = ray.t_far;
    }
}

impl Windows {
    #[inline(always)]
    fn set_row(&mut self, row: usize, shift: Lanes, entries: &RowOfEntries) {
        self.shift[row] = shift;
        self.nearest[row] = entries.nearest;
        self.start[row] = entries.start;
        self.rate[row] = entries.rate;
    }

    #[inline(always)]
    fn set(&mut self, row: usize, lane: usize, window: &Window) {
        self.shift[row].0[lane] = window.shift;
        self.nearest[row].0[lane] = window.nearest;
        self.start[row].0[lane] = window.start;
        self.rate[row].0[lane] = window.rate;
    }
}

impl PacketLevel {
    /// No rays.
    pub const NOWHERE: Self = Self {
        rays: PacketRays::NOWHERE,
        windows: Windows {
            shift: ZEROS,
            nearest: ZEROS,
            start: ZEROS,
            rate: ZEROS,
        },
    };

    /// The window of a ray.
    #[inline(always)]
    pub fn window(&self, ray: usize) -> Window {
        let (row, lane) = (ray / LANES, ray % LANES);
        Window {
            shift: self.windows.shift[row].0[lane],
            nearest: self.windows.nearest[row].0[lane],
            start: self.windows.start[row].0[lane],
            rate: self.windows.rate[row].0[lane],
        }
    }

    /// A single ray of the packet.
    pub fn of_ray(&self, ray: usize) -> Level {
        Level {
            ray: self.rays.ray(ray / LANES, ray % LANES),
            window: self.window(ray),
        }
    }
}
