//! How a tracer is built.

use std::num::NonZeroUsize;

use crate::embree::MaxIsa;
use crate::scene::ViewVolume;

/// How a tracer is built. No option changes a result, except as described for
/// [`view`](Self::view) and [`exact`](Self::exact).
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The number of threads that Embree builds with; the number of cores if `None`.
    pub threads: Option<NonZeroUsize>,
    /// The greatest instruction set that Embree may use; the machine's best if `None`.
    pub max_isa: Option<MaxIsa>,
    /// Embree's primitives.
    pub layout: Layout,
    /// When prototypes are built.
    pub build: BuildTime,
    /// Whether hits, misses and parts are decided as by exact arithmetic on the numbers of a
    /// prototype's space for any f64 numbers, and not only for those that f32 represents. Then
    /// open cylinders that share their ends leave no seam between them. Tracing takes longer
    /// (`docs/performance.md`). Set operations always decide from rounded numbers, and so does
    /// the test whether one ball of a rounded cone contains the other.
    pub exact: bool,
    /// The part of space that contains all rays, if known. Placements in the root that are
    /// outside are not built, and other rays then miss them.
    pub view: Option<ViewVolume>,
}

/// Embree's primitives. `docs/performance.md` has the figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Layout {
    /// Chosen per prototype: blocks for kinds with many solids.
    #[default]
    Auto,
    /// One primitive per solid.
    Single,
    /// One primitive per block of eight solids that are near each other. Embree's ray is tested
    /// against small copies of all of them at once, and only the solids that it may hit are
    /// solved. Embree's tree is smaller.
    Block,
}

/// The least number of solids of a kind in a prototype for which [`Layout::Auto`] makes blocks.
/// At this number memory matters: blocks take 0.6 of that of single primitives. Incoherent rays
/// are up to 1.1 times as fast in blocks of cylinders and 1.3 times in those of cones. Packets
/// of coherent rays, the majority in a picture, take 1.1 to 1.7 times as long. So fewer solids
/// are primitives of their own.
const LEAST_FOR_BLOCKS: u64 = 1 << 20;

impl Layout {
    /// Whether `solids` of a kind with a filter form blocks.
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
    /// When a ray first reaches the prototype. A prototype that no ray reaches takes neither
    /// time nor memory.
    ///
    /// If Embree then runs out of memory, the query panics, because it cannot return an error.
    /// Prototypes below the root are reached in a callback of Embree's, where a panic ends the
    /// process with its message.
    #[default]
    WhenReached,
}
