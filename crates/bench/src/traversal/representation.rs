//! The contenders: representations of a scene, and the interface that is timed.

use std::fmt;
use std::ops::Range;

use super::rays::Rays;
use crate::rivals::Shape;
use cyltrace::tracer::counters::Counts;

/// How this library traces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, strum::Display)]
#[strum(serialize_all = "snake_case")]
pub enum Mode {
    /// One ray at a time, one solid per primitive.
    Single,
    /// Batches of rays: in this library's order, and in packets if they are coherent.
    Packet,
    /// Batches of rays, and blocks of solids per primitive.
    Block,
}

/// How solids are represented, and rays traced through them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Representation {
    /// This library.
    Ours(Mode),
    /// What Embree intersects by itself.
    Embree {
        /// The geometry.
        shape: Shape,
        /// Whether Embree gets packets of rays of its widest kind, not single rays.
        in_packets: bool,
    },
}

impl Representation {
    /// All, in the order of tables.
    pub const ALL: [Self; 16] = [
        Self::Ours(Mode::Single),
        Self::Ours(Mode::Packet),
        Self::Ours(Mode::Block),
        Self::single(Shape::Cone),
        Self::packets(Shape::Cone),
        Self::single(Shape::Round),
        Self::packets(Shape::Round),
        Self::single(Shape::Sphere),
        Self::packets(Shape::Sphere),
        Self::single(Shape::Disk),
        Self::packets(Shape::Disk),
        Self::single(Shape::Mesh(8)),
        Self::single(Shape::Mesh(16)),
        Self::single(Shape::Mesh(32)),
        Self::single(Shape::Mesh(64)),
        Self::single(Shape::Faces),
    ];

    /// Embree's geometry, a ray at a time.
    #[must_use]
    pub const fn single(shape: Shape) -> Self {
        Self::Embree {
            shape,
            in_packets: false,
        }
    }

    /// Embree's geometry, a packet of rays at a time.
    #[must_use]
    pub const fn packets(shape: Shape) -> Self {
        Self::Embree {
            shape,
            in_packets: true,
        }
    }

    /// The rivals of a name: one representation, or all of Embree's [own](Self::is_own)
    /// geometry for `own`. Empty for an unknown name.
    #[must_use]
    pub fn rivals(name: &str) -> Vec<Self> {
        let is_named = |one: &Self| match name {
            "own" => one.is_own(),
            _ => !one.is_ours() && one.to_string() == name,
        };
        Self::ALL.into_iter().filter(is_named).collect()
    }

    /// The geometry that Embree intersects by itself, if it does.
    #[must_use]
    pub fn shape(self) -> Option<Shape> {
        match self {
            Self::Ours(_) => None,
            Self::Embree { shape, .. } => Some(shape),
        }
    }

    /// Whether it is this library.
    #[must_use]
    pub fn is_ours(self) -> bool {
        matches!(self, Self::Ours(_))
    }

    /// Whether it is Embree's own geometry for a kind of solid: curves, points, and the
    /// triangles of cuboids. A scene of one kind has one of these shapes.
    #[must_use]
    pub fn is_own(self) -> bool {
        !self.is_ours() && !matches!(self.shape(), Some(Shape::Mesh(_)))
    }

    /// Whether solids are triangle meshes.
    #[must_use]
    pub fn is_mesh(self) -> bool {
        matches!(self.shape(), Some(Shape::Mesh(_) | Shape::Faces))
    }
}

/// The name in tables, in the JSON and on the command line.
impl fmt::Display for Representation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (shape, in_packets) = match *self {
            Self::Ours(mode) => return write!(f, "analytic_{mode}"),
            Self::Embree { shape, in_packets } => (shape, in_packets),
        };
        match shape {
            Shape::Cone => write!(f, "embree_cone")?,
            Shape::Round => write!(f, "embree_round")?,
            Shape::Sphere => write!(f, "embree_sphere")?,
            // After Embree's `ORIENTED_DISC_POINT`.
            Shape::Disk => write!(f, "embree_disc")?,
            Shape::Mesh(sides) => write!(f, "mesh_{sides}")?,
            Shape::Faces => write!(f, "mesh_faces")?,
        }
        f.write_str(if in_packets { "_packet" } else { "" })
    }
}

/// A solid of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SolidId {
    /// The placement of its prototype: the position in
    /// [`Flat::placed`](super::Flat::placed).
    pub placed: u32,
    /// Its number within the prototype.
    pub primitive: u32,
}

/// The first hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// The ray's parameter.
    pub t: f64,
    /// The solid that is hit.
    pub solid: SolidId,
}

/// A scene in one representation, ready to answer.
pub trait Representative: Send + Sync {
    /// The first hits of some of the rays, in their order. The range starts at
    /// a multiple of [`TILE`](super::rays::TILE).
    fn closest(&self, rays: &Rays, range: Range<usize>) -> Vec<Option<Met>>;

    /// Whether those rays hit anything.
    fn blocked(&self, rays: &Rays, range: Range<usize>) -> Vec<bool>;

    /// Traces the rays by the query of their kind and returns a number that depends on
    /// every answer. This is timed.
    fn run(&self, rays: &Rays, range: Range<usize>) -> u64;

    /// The bytes that the scene takes: records of solids and placements, and Embree's
    /// memory.
    fn bytes(&self) -> usize;

    /// The callbacks and solves of all rays, if they are counted.
    fn counts(&self, _rays: &Rays) -> Option<Counts> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_choose_their_representation_and_own_all_of_embree_s() {
        for one in Representation::ALL {
            let expected = if one.is_ours() { vec![] } else { vec![one] };
            assert_eq!(Representation::rivals(&one.to_string()), expected);
        }
        let names = Representation::ALL.map(|one| one.to_string());
        assert_eq!(names[2], "analytic_block");
        assert_eq!(names[10..12], ["embree_disc_packet", "mesh_8"]);
        let own = Representation::rivals("own");
        assert_eq!(own.len(), 9);
        assert!(!own.contains(&Representation::single(Shape::Mesh(8))));
    }
}
