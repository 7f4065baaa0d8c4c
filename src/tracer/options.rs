//! How a tracer is built.

use std::num::NonZeroUsize;

use crate::embree::MaxIsa;
use crate::scene::ViewVolume;

/// How a tracer is built. No choice changes an answer, but for what [`view`](Self::view)
/// says.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Threads that Embree builds with; as many as there are cores if `None`.
    pub threads: Option<NonZeroUsize>,
    /// The widest instruction set that is used; the machine's best if `None`.
    pub max_isa: Option<MaxIsa>,
    /// How cylinders lie in memory.
    pub layout: Layout,
    /// When prototypes are built.
    pub build: BuildTime,
    /// The part of space that all rays will be in, if it is known: placements in
    /// the root that are outside are not built. Other rays then miss them.
    pub view: Option<ViewVolume>,
}

/// How the cylinders of a prototype lie in memory, and what is a primitive to
/// Embree. `docs/performance.md` has the figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Layout {
    /// A primitive each, which suits packets: rays that go the same way share
    /// all work on a cylinder.
    #[default]
    Single,
    /// Eight near ones a primitive, side by side, which suits single rays: they
    /// are put to all eight at once. Less memory in Embree, more beside it.
    Block,
}

/// When the Embree scene of a prototype is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BuildTime {
    /// Before anything is traced.
    AtOnce,
    /// When a ray first reaches the prototype. What no ray reaches takes neither
    /// time nor memory.
    ///
    /// Should Embree refuse then, which is for want of memory, the query panics: it
    /// has no way to answer with an error. Prototypes below the root are reached
    /// in a callback of Embree's, where a panic ends the process with its message.
    #[default]
    WhenReached,
}
