//! Who takes part: the names of representations, and what is asked of each.

use std::ops::Range;

use super::rays::Rays;
use crate::rivals::Shape;
use cyltrace::tracer::counters::Counts;

/// How solids are represented and rays traced through them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Representation {
    /// This library, a ray at a time, a cylinder a primitive.
    AnalyticSingle,
    /// This library, batches of rays: in an order of its own, in packets where
    /// they are coherent.
    AnalyticPacket,
    /// The same with blocks of cylinders a primitive.
    AnalyticBlock,
    /// Embree's cone curve, a ray at a time.
    EmbreeCone,
    /// Embree's cone curve, 16 rays at a time.
    EmbreeConePacket,
    /// Embree's round linear curve, a ray at a time.
    EmbreeRound,
    /// The same, 16 rays at a time.
    EmbreeRoundPacket,
    /// Embree's sphere point, a ray at a time.
    EmbreeSphere,
    /// The same, 16 rays at a time.
    EmbreeSpherePacket,
    /// Embree's oriented disk point, a ray at a time.
    EmbreeDisk,
    /// The same, 16 rays at a time.
    EmbreeDiskPacket,
    /// Inscribed meshes of 8 sides.
    Mesh8,
    /// Inscribed meshes of 16 sides.
    Mesh16,
    /// Inscribed meshes of 32 sides.
    Mesh32,
    /// Inscribed meshes of 64 sides.
    Mesh64,
    /// Cuboids as the triangles of their faces.
    MeshFaces,
}

impl Representation {
    /// All, in the order of tables; this library's own come first.
    pub const ALL: [Self; 16] = [
        Self::AnalyticSingle,
        Self::AnalyticPacket,
        Self::AnalyticBlock,
        Self::EmbreeCone,
        Self::EmbreeConePacket,
        Self::EmbreeRound,
        Self::EmbreeRoundPacket,
        Self::EmbreeSphere,
        Self::EmbreeSpherePacket,
        Self::EmbreeDisk,
        Self::EmbreeDiskPacket,
        Self::Mesh8,
        Self::Mesh16,
        Self::Mesh32,
        Self::Mesh64,
        Self::MeshFaces,
    ];

    /// The modes of this library.
    pub const OURS: [Self; 3] = [
        Self::AnalyticSingle,
        Self::AnalyticPacket,
        Self::AnalyticBlock,
    ];

    /// Embree's own geometry for solids of any kind: its curves and points, and the
    /// triangles of cuboids. A scene of one kind has one of these shapes.
    #[must_use]
    pub fn own() -> Vec<Self> {
        let is_own = |one: &Self| {
            let shape = one.shape();
            shape.is_some_and(|shape| !matches!(shape, Shape::Mesh(_)))
        };
        Self::ALL.into_iter().filter(is_own).collect()
    }

    /// The rivals of this name: `own` is [`own`](Self::own), others are one
    /// representation each. `None` for a name that is none of theirs.
    #[must_use]
    pub fn rivals(name: &str) -> Option<Vec<Self>> {
        if name == "own" {
            return Some(Self::own());
        }
        let mut all = Self::ALL.into_iter();
        let named = all.find(|one| !one.is_ours() && one.name() == name);
        named.map(|one| vec![one])
    }

    /// The name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::AnalyticSingle => "analytic_single",
            Self::AnalyticPacket => "analytic_packet",
            Self::AnalyticBlock => "analytic_block",
            Self::EmbreeCone => "embree_cone",
            Self::EmbreeConePacket => "embree_cone_packet",
            Self::EmbreeRound => "embree_round",
            Self::EmbreeRoundPacket => "embree_round_packet",
            Self::EmbreeSphere => "embree_sphere",
            Self::EmbreeSpherePacket => "embree_sphere_packet",
            Self::EmbreeDisk => "embree_disk",
            Self::EmbreeDiskPacket => "embree_disk_packet",
            Self::Mesh8 => "mesh_8",
            Self::Mesh16 => "mesh_16",
            Self::Mesh32 => "mesh_32",
            Self::Mesh64 => "mesh_64",
            Self::MeshFaces => "mesh_faces",
        }
    }

    /// What Embree intersects by itself, if it does.
    #[must_use]
    pub fn shape(self) -> Option<Shape> {
        match self {
            Self::EmbreeCone | Self::EmbreeConePacket => Some(Shape::Cone),
            Self::EmbreeRound | Self::EmbreeRoundPacket => Some(Shape::Round),
            Self::EmbreeSphere | Self::EmbreeSpherePacket => Some(Shape::Sphere),
            Self::EmbreeDisk | Self::EmbreeDiskPacket => Some(Shape::Disk),
            Self::Mesh8 => Some(Shape::Mesh(8)),
            Self::Mesh16 => Some(Shape::Mesh(16)),
            Self::Mesh32 => Some(Shape::Mesh(32)),
            Self::Mesh64 => Some(Shape::Mesh(64)),
            Self::MeshFaces => Some(Shape::Faces),
            _ => None,
        }
    }

    /// Whether Embree is handed packets of rays.
    #[must_use]
    pub fn is_by_packets(self) -> bool {
        matches!(
            self,
            Self::EmbreeConePacket
                | Self::EmbreeRoundPacket
                | Self::EmbreeSpherePacket
                | Self::EmbreeDiskPacket
        )
    }

    /// Whether it is this library.
    #[must_use]
    pub fn is_ours(self) -> bool {
        Self::OURS.contains(&self)
    }
}

/// A solid of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SolidId {
    /// Where its prototype stands: the position in
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
    /// What is hit.
    pub solid: SolidId,
}

/// A scene in one representation, ready to answer.
pub trait Representative: Send + Sync {
    /// The first hits of some of the rays, in their order. The range starts at
    /// a multiple of [`TILE`](super::rays::TILE).
    fn closest(&self, rays: &Rays, range: Range<usize>) -> Vec<Option<Met>>;

    /// Whether those rays hit anything.
    fn blocked(&self, rays: &Rays, range: Range<usize>) -> Vec<bool>;

    /// Asks the rays' own question of each, and answers with a number that
    /// depends on every answer. It is what is timed.
    fn run(&self, rays: &Rays, range: Range<usize>) -> u64;

    /// What is kept for the scene, in bytes: records of solids and
    /// placements, and what Embree holds.
    fn bytes(&self) -> usize;

    /// What all rays cost, where it is counted.
    fn counts(&self, _rays: &Rays) -> Option<Counts> {
        None
    }
}
