//! How a tracer is built.

use std::num::NonZeroUsize;

use crate::embree::MaxIsa;
use crate::scene::ViewVolume;

/// How a tracer is built. No choice changes an answer, but for what [`view`](Self::view)
/// and [`exact`](Self::exact) say.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Threads that Embree builds with; as many as there are cores if `None`.
    pub threads: Option<NonZeroUsize>,
    /// The widest instruction set that is used; the machine's best if `None`.
    pub max_isa: Option<MaxIsa>,
    /// What is a primitive to Embree.
    pub layout: Layout,
    /// When prototypes are built.
    pub build: BuildTime,
    /// Whether hits, misses and parts are decided as exact arithmetic on the numbers of a
    /// prototype's space does, for any f64 numbers, and not only where f32 represents them.
    /// Then open cylinders that share their ends leave no seam between them. Tracing takes longer
    /// (`docs/performance.md`). Set operations decide by rounded numbers always, and
    /// so does whether one ball of a rounded cone contains the other.
    pub exact: bool,
    /// The part of space that all rays will be in, if it is known: placements in
    /// the root that are outside are not built. Other rays then miss them.
    pub view: Option<ViewVolume>,
}

/// What is a primitive to Embree. `docs/performance.md` has the figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Layout {
    /// As suits what a prototype contains: blocks where there are many solids of a kind.
    #[default]
    Auto,
    /// A primitive for each solid, the plainest form.
    Single,
    /// A primitive for each block of eight solids that are near each other. Embree's ray is
    /// put to small copies of all of them at once, and only what it may meet is
    /// solved. Embree's tree is smaller.
    Block,
}

/// The least number of solids of a kind in a prototype for which [`Layout::Auto`] makes
/// blocks. There memory counts: blocks take 0.6 of what single primitives take. Rays that
/// scatter are up to 1.1 times as fast in blocks of cylinders and 1.3 times in those of cones,
/// and packets of coherent rays, which are most of a picture's, take 1.1 to 1.7 times as
/// long; so fewer solids are primitives of their own.
const LEAST_FOR_BLOCKS: u64 = 1 << 20;

impl Layout {
    /// Whether `solids` of a kind that has a filter are put into blocks.
    pub(super) fn has_blocks(self, solids: u64) -> bool {
        match self {
            Self::Auto => solids >= LEAST_FOR_BLOCKS,
            Self::Single => false,
            Self::Block => true,
        }
    }
}

/// When the Embree scene of a prototype is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BuildTime {
    /// Before anything is traced.
    AtOnce,
    /// When a ray first reaches the prototype. What no ray reaches takes neither
    /// time nor memory.
    ///
    /// Should Embree refuse then, which is for lack of memory, the query panics: it
    /// has no way to answer with an error. Prototypes below the root are reached
    /// in a callback of Embree's, where a panic ends the process with its message.
    #[default]
    WhenReached,
}
