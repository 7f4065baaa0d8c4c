//! The hits that a query keeps, and their order.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use smallvec::SmallVec;

use crate::scene::PrototypeIndex;
use crate::solid::SolidKind;
use crate::tracer::traced::SurfaceHit;

/// The placements from the root to a prototype, outermost first. Scenes are rarely nested
/// deeper than what is stored without the heap.
pub(crate) type InstancePath = SmallVec<[u32; 4]>;

/// A solid of a prototype.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SolidSlot {
    /// The kind, which selects a list of the prototype.
    pub kind: SolidKind,
    /// The position in the list.
    pub record: u32,
}

impl SolidSlot {
    #[inline(always)]
    pub fn new(kind: SolidKind, record: u32) -> Self {
        Self { kind, record }
    }
}

/// A solid of the scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SolidRef {
    pub prototype: PrototypeIndex,
    pub member: SolidSlot,
    pub path: InstancePath,
}

impl SolidRef {
    /// A solid of the prototype that is reached along a path.
    #[inline(always)]
    pub fn new(prototype: PrototypeIndex, member: SolidSlot, path: &InstancePath) -> Self {
        Self {
            prototype,
            member,
            // Copied as bytes; `clone` would copy number by number.
            path: InstancePath::from_slice(path),
        }
    }
}

/// The first hit of a ray, as a query stores it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Nearest {
    pub t: f64,
    pub place: SolidRef,
}

impl Nearest {
    /// Whether a hit of a solid at `t` comes before this one: by `t`, then by the instance
    /// path, then by the primitive's number. `primitive` returns the number of a member of the
    /// solid's prototype, which for equal paths is also the prototype of this one.
    #[inline]
    pub fn is_after(
        &self,
        t: f64,
        path: &InstancePath,
        member: SolidSlot,
        primitive: impl Fn(SolidSlot) -> u32,
    ) -> bool {
        if t != self.t {
            return t < self.t;
        }
        let by_path = path.cmp(&self.place.path);
        let order = by_path.then_with(|| primitive(member).cmp(&primitive(self.place.member)));
        order.is_lt()
    }
}

/// One of all hits, as a query stores it: the input for computing it afterwards.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    pub hit: SurfaceHit,
    /// The number of the solid for the user.
    pub primitive: u32,
    pub place: SolidRef,
}

impl Found {
    /// Compares a new hit with this one: by `t`, then by the instance path, the primitive, the
    /// number of the crossing, entry before exit, and the part. No two hits of a ray are equal.
    #[inline]
    fn order(&self, hit: &SurfaceHit, path: &InstancePath, primitive: u32) -> Ordering {
        let by_t = hit.intersection.t.partial_cmp(&self.hit.intersection.t);
        let surface =
            |hit: &SurfaceHit| (hit.rank, hit.intersection.crossing, hit.intersection.part);
        by_t.expect("a hit's t is a number").then_with(|| {
            (path, primitive, surface(hit)).cmp(&(
                &self.place.path,
                self.primitive,
                surface(&self.hit),
            ))
        })
    }
}

impl Ord for Found {
    fn cmp(&self, other: &Self) -> Ordering {
        other.order(&self.hit, &self.place.path, self.primitive)
    }
}

impl PartialOrd for Found {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Found {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Found {}

/// What a query searches for.
#[derive(Debug)]
pub(crate) enum QueryMode {
    /// The first hit.
    First(Option<Nearest>),
    /// The next hits after a known one.
    Next(Next),
    /// The solids that contain the ray's origin, for any range.
    Containing(Vec<SolidRef>),
}

/// The first `most` hits after a known one.
#[derive(Debug)]
pub(crate) struct Next {
    pub after: Option<Found>,
    pub most: usize,
    /// The last of them on top: it is replaced by an earlier hit, in time logarithmic in
    /// `most`.
    pub hits: BinaryHeap<Found>,
}

impl QueryMode {
    /// The greatest `t` of a hit that would be kept.
    #[inline]
    pub fn bound(&self, t_max: f64) -> f64 {
        match self {
            Self::First(first) => first.as_ref().map_or(t_max, |first| first.t),
            Self::Next(next) if next.hits.len() == next.most => next
                .hits
                .peek()
                .map_or(t_max, |last| last.hit.intersection.t),
            Self::Next(_) | Self::Containing(_) => t_max,
        }
    }
}

impl Next {
    /// Keeps a hit if it is among the next ones.
    #[inline]
    pub fn offer(
        &mut self,
        hit: SurfaceHit,
        path: &InstancePath,
        primitive: u32,
        place: impl FnOnce() -> SolidRef,
    ) {
        let order = |kept: &Found| kept.order(&hit, path, primitive);
        if self
            .after
            .as_ref()
            .is_some_and(|after| order(after).is_le())
        {
            return;
        }
        if self.hits.len() == self.most {
            match self.hits.peek() {
                Some(last) if order(last).is_lt() => self.hits.pop(),
                _ => return,
            };
        }
        self.hits.push(Found {
            hit,
            primitive,
            place: place(),
        });
    }
}
