//! The solids of a prototype that are no cylinders, one list a kind.

use super::description::MaterialIndex;
use crate::math::Bounds;
use crate::solid::{AnySolid, Composition, Cone, ConvexSolid, Cuboid, Disk, RoundedCone, Sphere};

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

    /// The bytes of the records, with what the compositions are made of.
    #[must_use]
    pub fn records_bytes(&self) -> usize {
        let parts = self.compositions.iter();
        let parts: usize = parts.map(|record| record.solid.heap_bytes()).sum();
        size_of_val(self.spheres.as_slice())
            + size_of_val(self.cuboids.as_slice())
            + size_of_val(self.cones.as_slice())
            + size_of_val(self.rounded_cones.as_slice())
            + size_of_val(self.disks.as_slice())
            + size_of_val(self.compositions.as_slice())
            + parts
    }

    /// Those that are not composed of others, kind by kind, each with its number.
    pub fn singles(&self) -> impl Iterator<Item = (u32, AnySolid)> {
        fn all<S: ConvexSolid + Into<AnySolid>>(
            list: &[SolidRecord<S>],
        ) -> impl Iterator<Item = (u32, AnySolid)> {
            list.iter()
                .map(|record| (record.primitive, record.solid.into()))
        }
        all(&self.spheres)
            .chain(all(&self.cuboids))
            .chain(all(&self.cones))
            .chain(all(&self.rounded_cones))
            .chain(all(&self.disks))
    }

    /// The one of those with a number.
    #[must_use]
    pub fn single(&self, primitive: u32) -> Option<AnySolid> {
        fn of<S: ConvexSolid + Into<AnySolid>>(
            list: &[SolidRecord<S>],
            primitive: u32,
        ) -> Option<AnySolid> {
            let position = list.binary_search_by_key(&primitive, |record| record.primitive);
            position.ok().map(|position| list[position].solid.into())
        }
        of(&self.spheres, primitive)
            .or_else(|| of(&self.cuboids, primitive))
            .or_else(|| of(&self.cones, primitive))
            .or_else(|| of(&self.rounded_cones, primitive))
            .or_else(|| of(&self.disks, primitive))
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
