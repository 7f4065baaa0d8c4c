//! The hits that a query keeps, and their order.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use smallvec::SmallVec;

use crate::scene::PrototypeIndex;
use crate::solid::SolidKind;
use crate::tracer::traced::SurfaceHit;

/// The placements on the way from the root to a prototype, outermost first.
/// Scenes are rarely nested deeper than what is kept without the heap.
pub(crate) type InstancePath = SmallVec<[u32; 4]>;

/// Which solid of a prototype.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SolidSlot {
    /// Its kind, of which the prototype has a list.
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

/// Which solid of the scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SolidRef {
    pub prototype: PrototypeIndex,
    pub member: SolidSlot,
    pub path: InstancePath,
}

impl SolidRef {
    /// The place of a solid in the prototype that is reached along a path.
    #[inline(always)]
    pub fn new(prototype: PrototypeIndex, member: SolidSlot, path: &InstancePath) -> Self {
        Self {
            prototype,
            member,
            // Copied as bytes; `clone` would go number by number.
            path: InstancePath::from_slice(path),
        }
    }
}

/// The first hit of a ray, as far as a query works it out.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Nearest {
    pub t: f64,
    pub place: SolidRef,
}

impl Nearest {
    /// Whether a solid that is met at `t` comes before this one: by `t`, then by
    /// the instance path, then by the primitive's number. `primitive` answers with
    /// the number of a member of the solid's prototype, which for equal paths
    /// is this one's too.
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

/// One of all hits, as a query keeps it: what is needed to work it out
/// afterwards.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    pub met: SurfaceHit,
    /// The number that the user knows the solid by.
    pub primitive: u32,
    pub place: SolidRef,
}

impl Found {
    /// Compares a hit that is not kept yet with this one: by `t`, then by
    /// the instance path, the primitive, the number of the crossing, entry before exit,
    /// and the part.
    /// No two hits of a ray are equal.
    #[inline]
    fn order(&self, met: &SurfaceHit, path: &InstancePath, primitive: u32) -> Ordering {
        let by_t = met.intersection.t.partial_cmp(&self.met.intersection.t);
        let surface =
            |met: &SurfaceHit| (met.rank, met.intersection.crossing, met.intersection.part);
        by_t.expect("a hit's t is a number").then_with(|| {
            (path, primitive, surface(met)).cmp(&(
                &self.place.path,
                self.primitive,
                surface(&self.met),
            ))
        })
    }
}

impl Ord for Found {
    fn cmp(&self, other: &Self) -> Ordering {
        other.order(&self.met, &self.place.path, self.primitive)
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

/// What a query is after.
#[derive(Debug)]
pub(crate) enum QueryMode {
    /// The first hit.
    First(Option<Nearest>),
    /// The next hits after one that is known.
    Next(Next),
    /// The solids that hold the ray's origin, whatever its range.
    Containing(Vec<SolidRef>),
}

/// The first `most` hits after one that is known.
#[derive(Debug)]
pub(crate) struct Next {
    pub after: Option<Found>,
    pub most: usize,
    /// The last of them on top: the one that an earlier hit replaces, in time
    /// logarithmic in `most`.
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
                .map_or(t_max, |last| last.met.intersection.t),
            Self::Next(_) | Self::Containing(_) => t_max,
        }
    }
}

impl Next {
    /// Keeps a hit if it is wanted.
    #[inline]
    pub fn offer(
        &mut self,
        met: SurfaceHit,
        path: &InstancePath,
        primitive: u32,
        place: impl FnOnce() -> SolidRef,
    ) {
        let order = |kept: &Found| kept.order(&met, path, primitive);
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
            met,
            primitive,
            place: place(),
        });
    }
}
