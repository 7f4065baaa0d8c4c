//! A query of one ray.

use std::collections::BinaryHeap;

use glam::DVec3;

use super::found::{Found, InstancePath, Nearest, Next, QueryMode, SolidRef, SolidSlot};
use super::position::Position;
use crate::embree::{GeometryId, Ray32};
use crate::math::{ChildFromParent, Ray};
use crate::scene::PrototypeIndex;
use crate::tracer::counters;
use crate::tracer::decisions::Decisions;
use crate::tracer::frame::{Frame, Level, LocalRay};
use crate::tracer::prototype::PrototypeRef;
use crate::tracer::traced::{SurfaceHit, TracedSolid};

/// The state of a query.
#[derive(Debug)]
pub(crate) struct Query {
    t_min: f64,
    t_max: f64,
    decisions: Decisions,
    /// The ray in the prototype that is being traced.
    level: Option<Level>,
    /// The ray in the instance of the last callback.
    in_instance: LocalRay,
    pub position: Position,
    pub mode: QueryMode,
    /// The number of callbacks, the measure of its cost.
    pub callbacks: u32,
}

impl Query {
    /// A query for the first hit, or for occlusion.
    pub fn first(ray: &Ray, decisions: Decisions) -> Self {
        Self::new([ray.t_min, ray.t_max], decisions, InstancePath::new(), None)
    }

    /// A query for the first hit in a range, in the prototype at the end of `path`, with the
    /// nearest known hit.
    pub fn new(
        [t_min, t_max]: [f64; 2],
        decisions: Decisions,
        path: InstancePath,
        nearest: Option<Nearest>,
    ) -> Self {
        Self {
            t_min,
            t_max,
            decisions,
            level: None,
            in_instance: LocalRay::default(),
            position: Position::new(path),
            mode: QueryMode::First(nearest),
            callbacks: 0,
        }
    }

    /// A query for the next hits after a known one, at most `most`.
    pub fn next(ray: &Ray, decisions: Decisions, after: Option<Found>, most: usize) -> Self {
        let hits = BinaryHeap::new();
        Self {
            mode: QueryMode::Next(Next { after, most, hits }),
            ..Self::first(ray, decisions)
        }
    }

    /// A query for the solids that contain the origin of a ray, whose range is that point.
    pub fn containing(ray: &Ray) -> Self {
        Self {
            mode: QueryMode::Containing(Vec::new()),
            ..Self::first(ray, Decisions::default())
        }
    }

    /// The greatest `t` that can still be part of the result.
    #[inline(always)]
    pub fn bound(&self) -> f64 {
        self.mode.bound(self.t_max)
    }

    /// The least `t` that can be part of the result. The range of the ray begins earlier, and
    /// is the one in which solids are intersected: a ray within a disk hits it at the start of
    /// that range.
    #[inline]
    fn start(&self) -> f64 {
        match &self.mode {
            QueryMode::Next(Next {
                after: Some(after), ..
            }) => after.hit.intersection.t,
            QueryMode::First(_) | QueryMode::Next(_) | QueryMode::Containing(_) => self.t_min,
        }
    }

    /// The ray in a prototype, if anything there could be part of the result.
    #[inline]
    pub fn enter(&self, frame: &Frame, ray: &LocalRay) -> Option<(Level, Ray32)> {
        frame.enter(ray, self.start(), self.bound())
    }

    /// Runs `trace` with the ray in another prototype.
    #[inline]
    pub fn within<T>(
        &mut self,
        prototype: PrototypeIndex,
        level: Level,
        trace: impl FnOnce(&mut Self) -> T,
    ) -> T {
        let outer = (self.level.replace(level), self.position.enter(prototype));
        let answer = trace(self);
        self.level = outer.0;
        self.position.return_to(outer.1);
        answer
    }

    /// Sets the instance of a callback, and the prototype of its solids, before the callback
    /// uses the ray or the path.
    #[inline(always)]
    pub fn reach(&mut self, instance: Option<GeometryId>, prototype_ref: &PrototypeRef) {
        if instance != self.position.instance() {
            self.change_instance(instance, prototype_ref);
        }
    }

    /// The ray in the child is computed when a callback needs it, not for a ray that intersects
    /// only boxes of an instance.
    #[inline(never)]
    fn change_instance(&mut self, instance: Option<GeometryId>, prototype_ref: &PrototypeRef) {
        self.in_instance = self.level().ray;
        let step = |child_from_parent: &ChildFromParent, frame: &Frame| {
            self.in_instance = frame.approach(&self.in_instance.in_child(child_from_parent));
        };
        self.position.change_instance(instance, prototype_ref, step);
    }

    /// Counts a callback.
    #[inline(always)]
    pub fn called_back(&mut self) {
        counters::called_back();
        self.callbacks += 1;
    }

    /// The level of the current callbacks.
    #[inline(always)]
    fn level(&self) -> &Level {
        self.level
            .as_ref()
            .expect("callbacks run within a prototype")
    }

    /// The ray in the space of the current callback.
    #[inline(always)]
    pub fn ray(&self) -> &LocalRay {
        match self.position.instance() {
            None => &self.level().ray,
            Some(_) => &self.in_instance,
        }
    }

    /// The first hit of the ray, up to `t_max`, with a solid of the current prototype.
    #[inline(always)]
    fn first_intersection(&self, solid: &impl TracedSolid, t_max: f64) -> Option<SurfaceHit> {
        counters::solved(1);
        solid.first(self.ray(), self.decisions, self.t_min, t_max)
    }

    /// Whether the ray hits a solid of the current prototype.
    #[inline(always)]
    pub fn intersects<S: TracedSolid>(&self, solid: &S) -> bool {
        self.first_intersection(solid, self.t_max).is_some()
    }

    /// Keeps the hits of the ray with a solid of the current prototype that the query is for.
    /// `solid` is that of the record.
    #[inline(always)]
    pub fn visit<S: TracedSolid>(&mut self, solid: &S, prototype_ref: &PrototypeRef, record: u32) {
        if let QueryMode::First(_) = self.mode {
            if let Some(hit) = self.first_intersection(solid, self.bound()) {
                let member = SolidSlot::new(solid.kind(), record);
                self.offer(hit.intersection.t, prototype_ref, member);
            }
        } else {
            self.visit_all(solid, prototype_ref, record);
        }
    }

    /// As [`Query::visit`], for all hits, or for the solids that contain the origin.
    #[cold]
    fn visit_all<S: TracedSolid>(&mut self, solid: &S, prototype_ref: &PrototypeRef, record: u32) {
        counters::solved(1);
        let member = SolidSlot::new(solid.kind(), record);
        if let QueryMode::Containing(_) = self.mode {
            return self.keep_if_containing(prototype_ref, member, |point| solid.contains(point));
        }
        let (ray, decisions) = (*self.ray(), self.decisions);
        let (bound, t_min) = (self.bound(), self.t_min);
        let offer = self.next_of(prototype_ref, member);
        solid.for_each_hit(&ray, decisions, t_min, bound, offer);
    }

    /// Keeps a solid if it `contains` the origin of the ray.
    fn keep_if_containing(
        &mut self,
        prototype_ref: &PrototypeRef,
        member: SolidSlot,
        contains: impl FnOnce(DVec3) -> bool,
    ) {
        let ray = self.ray();
        // The origin of a ray that was moved is far away from all solids here.
        let is_moved = ray.shift != 0.0 || ray.base != DVec3::ZERO;
        if is_moved || !contains(ray.origin) {
            return;
        }
        if let QueryMode::Containing(places) = &mut self.mode {
            places.push(SolidRef::new(
                prototype_ref.index(),
                member,
                &self.position.path,
            ));
        }
    }

    /// A function that keeps the next hits with a solid, in a query for all hits.
    fn next_of(
        &mut self,
        prototype_ref: &PrototypeRef,
        member: SolidSlot,
    ) -> impl FnMut(SurfaceHit) {
        let (prototype, primitive) = (prototype_ref.index(), prototype_ref.primitive(member));
        let (mode, path) = (&mut self.mode, &self.position.path);
        move |hit| {
            if let QueryMode::Next(next) = mode {
                let place = || SolidRef::new(prototype, member, path);
                next.offer(hit, path, primitive, place);
            }
        }
    }

    /// Keeps a first hit if it is before the known one.
    #[inline(always)]
    fn offer(&mut self, t: f64, prototype_ref: &PrototypeRef, member: SolidSlot) {
        if let QueryMode::First(nearest) = &mut self.mode {
            self.position.offer(nearest, t, (prototype_ref, member));
        }
    }

    /// The `t_far` up to which hits would be kept.
    #[inline(always)]
    pub fn t_far(&self) -> f32 {
        self.level().window.t_far(self.bound())
    }
}
