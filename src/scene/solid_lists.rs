//! The solids of a prototype that are no cylinders, one list a kind.

use super::description::MaterialIndex;
use crate::math::Bounds;
use crate::solid::{AnySolid, Cone, ConvexSolid, Cuboid, Disk, RoundedCone, Sphere};

/// The solids of a prototype that are no cylinders, each list in the order of
/// the primitive numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solids {
    /// The spheres.
    pub spheres: Vec<SolidRecord<Sphere>>,
    /// The cuboids.
    pub cuboids: Vec<SolidRecord<Cuboid>>,
    /// The cones.
    pub cones: Vec<SolidRecord<Cone>>,
    /// The rounded cones.
    pub rounded_cones: Vec<SolidRecord<RoundedCone>>,
    /// The disks.
    pub disks: Vec<SolidRecord<Disk>>,
    /// The solids that are composed of others.
    pub compositions: Vec<CompositionRecord>,
}

/// A solid with its number and material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidRecord<S> {
    /// The solid.
    pub solid: S,
    /// The number within the prototype, as `trace` reports it.
    pub primitive: u32,
    /// The material.
    pub material: MaterialIndex,
}

impl<S> SolidRecord<S> {
    /// The record of a solid. `primitive` is its number within its prototype.
    #[must_use]
    pub fn new(solid: S, primitive: u32, material: MaterialIndex) -> Self {
        Self {
            solid,
            primitive,
            material,
        }
    }
}

/// What a list of [`Solids`] is of.
pub trait Listed: Sized + 'static {
    /// The list of its kind.
    fn list(solids: &Solids) -> &[SolidRecord<Self>];
}

macro_rules! listed {
    ($($kind:ident in $list:ident)*) => {$(
        impl Listed for $kind {
            #[inline(always)]
            fn list(solids: &Solids) -> &[SolidRecord<Self>] {
                &solids.$list
            }
        }
    )*};
}

listed! {
    Sphere in spheres
    Cuboid in cuboids
    Cone in cones
    RoundedCone in rounded_cones
    Disk in disks
    Composition in compositions
}

/// A composed solid with its number and material.
pub type CompositionRecord = SolidRecord<Composition>;

/// A solid that is composed of others by set operations. Its points are those
/// that the operations say, its surface their boundary.
///
/// What a scene file states has no open ends, no disks and no operation without
/// an operand.
#[derive(Clone, Debug, PartialEq)]
pub enum Composition {
    /// A solid as it is.
    Solid(AnySolid),
    /// What is in any of them.
    Union(Vec<Composition>),
    /// What is in all of them.
    Intersection(Vec<Composition>),
    /// What is in the first and in none of the others.
    Difference(Vec<Composition>),
}

impl Solids {
    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.spheres.len()
            + self.cuboids.len()
            + self.cones.len()
            + self.rounded_cones.len()
            + self.disks.len()
            + self.compositions.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The bytes of the records. What a composition holds of its own is left out.
    #[must_use]
    pub fn records_bytes(&self) -> usize {
        size_of_val(self.spheres.as_slice())
            + size_of_val(self.cuboids.as_slice())
            + size_of_val(self.cones.as_slice())
            + size_of_val(self.rounded_cones.as_slice())
            + size_of_val(self.disks.as_slice())
            + size_of_val(self.compositions.as_slice())
    }

    /// A box around all of them.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        fn all<S: ConvexSolid>(list: &[SolidRecord<S>]) -> Bounds {
            let boxes = list.iter().map(|record| record.solid.bounds());
            boxes.fold(Bounds::EMPTY, |sum, bounds| sum.union(&bounds))
        }
        let compositions = self.compositions.iter();
        let compositions = compositions.map(|record| record.solid.bounds());
        let singles = [
            all(&self.spheres),
            all(&self.cuboids),
            all(&self.cones),
            all(&self.rounded_cones),
            all(&self.disks),
        ];
        let boxes = singles.into_iter().chain(compositions);
        boxes.fold(Bounds::EMPTY, |sum, bounds| sum.union(&bounds))
    }

    /// Gives back the memory beyond what the lists hold.
    pub(super) fn trim(&mut self) {
        self.spheres.shrink_to_fit();
        self.cuboids.shrink_to_fit();
        self.cones.shrink_to_fit();
        self.rounded_cones.shrink_to_fit();
        self.disks.shrink_to_fit();
        self.compositions.shrink_to_fit();
    }
}

impl Composition {
    /// The solids that it is composed of, from the first to the last.
    #[must_use]
    pub fn solids(&self) -> Vec<AnySolid> {
        let mut solids = Vec::new();
        let mut open = vec![self];
        while let Some(next) = open.pop() {
            match next {
                Self::Solid(solid) => solids.push(*solid),
                Self::Union(parts) | Self::Intersection(parts) | Self::Difference(parts) => {
                    open.extend(parts.iter().rev());
                }
            }
        }
        solids
    }

    /// A box that holds it: of a union the box of all boxes, of an intersection what
    /// is in all of them, of a difference the first. [`Bounds::EMPTY`] where that
    /// shows that nothing is left.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let boxes = |parts: &[Self]| parts.iter().map(Self::bounds).collect::<Vec<_>>();
        match self {
            Self::Solid(solid) => solid.bounds(),
            Self::Union(parts) => {
                let boxes = boxes(parts).into_iter();
                boxes.fold(Bounds::EMPTY, |sum, bounds| sum.union(&bounds))
            }
            Self::Intersection(parts) => {
                let common = boxes(parts).into_iter().reduce(|one, other| Bounds {
                    lower: one.lower.max(other.lower),
                    upper: one.upper.min(other.upper),
                });
                common
                    .filter(|bounds| bounds.lower.cmple(bounds.upper).all())
                    .unwrap_or(Bounds::EMPTY)
            }
            Self::Difference(parts) => parts.first().map_or(Bounds::EMPTY, Self::bounds),
        }
    }
}
