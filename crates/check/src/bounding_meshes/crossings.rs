//! Where a ray crosses the surfaces of meshes.

/// A parameter beyond the part of the ray that was traced.
pub(crate) const LATER: f64 = f64::MAX;

/// Where a ray crosses the surface of a mesh, at or after its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossings {
    /// The first entry; infinite without one.
    pub enter: f64,
    /// The first exit; infinite without one.
    pub leave: f64,
    /// The last exit; minus infinity without one.
    pub last_leave: f64,
}

impl Crossings {
    /// The ray misses the mesh.
    pub const NONE: Self = Self {
        enter: f64::INFINITY,
        leave: f64::INFINITY,
        last_leave: f64::NEG_INFINITY,
    };

    /// Adds a crossing.
    pub fn add(&mut self, t: f64, enters: bool) {
        if enters {
            self.enter = self.enter.min(t);
        } else {
            self.leave = self.leave.min(t);
            self.last_leave = self.last_leave.max(t);
        }
    }

    /// After a part of the ray was traced: a mesh that it enters is left later.
    pub fn leave_later(&mut self) {
        if self.enter < f64::INFINITY && self.leave == f64::INFINITY {
            self.leave = LATER;
            self.last_leave = LATER;
        }
    }

    pub fn is_none(&self) -> bool {
        self.enter == f64::INFINITY && self.leave == f64::INFINITY
    }

    /// Whether the ray certainly starts inside: an exit comes first.
    pub fn starts_inside(&self) -> bool {
        self.leave < self.enter
    }

    /// Whether it may start inside: entry and exit coincide where two faces join, for a ray
    /// that grazes the edge from outside or, if the edge is a fold inward, from inside.
    pub fn may_start_inside(&self) -> bool {
        self.leave <= self.enter && self.leave < f64::INFINITY
    }
}

/// The crossings of both meshes of a leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeafCrossings {
    /// Of the mesh around it.
    pub outer: Crossings,
    /// Of the mesh inside it. For a disk, entries are crossings of the sheet above it, exits
    /// are crossings of the sheet below it.
    pub inner: Crossings,
}

impl LeafCrossings {
    /// The ray misses both.
    pub const NONE: Self = Self {
        outer: Crossings::NONE,
        inner: Crossings::NONE,
    };
}
