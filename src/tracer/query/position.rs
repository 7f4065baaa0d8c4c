//! Where a query is in the scene: the prototype and the instance of its callbacks, and the
//! placements from the root.

use std::mem;

use super::found::{InstancePath, Nearest, SolidRef, SolidSlot};
use crate::embree::GeometryId;
use crate::math::ChildFromParent;
use crate::scene::PrototypeIndex;
use crate::tracer::counters;
use crate::tracer::frame::Frame;
use crate::tracer::prototype::PrototypeRef;

/// The position of a query. The owner has the rays there.
#[derive(Debug)]
pub(crate) struct Position {
    /// The prototype that is being traced.
    prototype: PrototypeIndex,
    /// The placements from the root, with those of the instance.
    pub path: InstancePath,
    /// The instance of the last callback, and the length of the path outside of it.
    instance: Option<GeometryId>,
    outside: usize,
}

impl Position {
    /// The end of a path, outside of instances.
    pub fn new(path: InstancePath) -> Self {
        Self {
            prototype: PrototypeIndex::ROOT,
            path,
            instance: None,
            outside: 0,
        }
    }

    /// The instance of the last callback.
    #[inline(always)]
    pub fn instance(&self) -> Option<GeometryId> {
        self.instance
    }

    /// Changes the instance. For the placements between the current prototype and the
    /// `prototype_ref` in it, `step` maps the rays into the child and its frame.
    #[inline(always)]
    pub fn change_instance(
        &mut self,
        instance: Option<GeometryId>,
        prototype_ref: &PrototypeRef,
        mut step: impl FnMut(&ChildFromParent, &Frame),
    ) {
        self.leave_instance();
        let Some(GeometryId(number)) = instance else {
            return;
        };
        counters::passed_on(1);
        self.outside = self.path.len();
        prototype_ref.along_instance(
            self.prototype,
            number,
            |placement, child_from_parent, frame| {
                step(child_from_parent, frame);
                self.path.push(placement);
            },
        );
        self.instance = instance;
    }

    /// Returns from the instance to the prototype that is being traced.
    #[inline(always)]
    pub fn leave_instance(&mut self) {
        if self.instance.take().is_some() {
            self.path.truncate(self.outside);
        }
    }

    /// Enters a prototype, and returns the one before.
    #[inline(always)]
    pub fn enter(&mut self, prototype: PrototypeIndex) -> PrototypeIndex {
        debug_assert_eq!(self.instance, None, "instances contain solids alone");
        mem::replace(&mut self.prototype, prototype)
    }

    /// Returns to the prototype `outer`.
    #[inline(always)]
    pub fn return_to(&mut self, outer: PrototypeIndex) {
        self.leave_instance();
        self.prototype = outer;
    }

    /// Replaces the known first hit of a ray by one of a member at `t`, if that is before it.
    /// Returns whether it is.
    #[inline(always)]
    pub fn offer(
        &self,
        known: &mut Option<Nearest>,
        t: f64,
        (prototype_ref, member): (&PrototypeRef, SolidSlot),
    ) -> bool {
        let is_first = known.as_ref().is_none_or(|known| {
            known.is_after(t, &self.path, member, |member| {
                prototype_ref.primitive(member)
            })
        });
        if is_first {
            *known = Some(Nearest {
                t,
                place: SolidRef::new(prototype_ref.index(), member, &self.path),
            });
        }
        is_first
    }
}
