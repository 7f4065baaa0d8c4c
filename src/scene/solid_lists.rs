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

/// A composed solid with its number and material.
pub type CompositionRecord = SolidRecord<Composition>;

/// What is the same of every list; those of `singles` hold solids that are not composed
/// of others.
macro_rules! listed {
    (singles: $($single:ident)*; all: $($kind:ident in $list:ident)*) => {
        $(impl Listed for $kind {
            #[inline(always)]
            fn list(solids: &Solids) -> &[SolidRecord<Self>] {
                &solids.$list
            }
        })*

        impl Solids {
            /// How many there are.
            #[must_use]
            pub fn len(&self) -> usize {
                [$(self.$list.len()),*].iter().sum()
            }

            /// How many of each kind are not composed of others.
            pub(super) fn single_counts(&self) -> [u64; 5] {
                [$(self.$single.len() as u64),*]
            }

            /// The bytes of the records, with what the compositions are made of.
            #[must_use]
            pub fn records_bytes(&self) -> usize {
                let lists: usize = [$(size_of_val(self.$list.as_slice())),*].iter().sum();
                let compositions = self.compositions.iter();
                let parts: usize = compositions.map(|record| record.solid.heap_bytes()).sum();
                lists + parts
            }

            /// Those that are not composed of others, kind by kind, each with its number.
            pub fn singles(&self) -> impl Iterator<Item = (u32, AnySolid)> {
                std::iter::empty()$(.chain(numbered(&self.$single)))*
            }

            /// The one of those with a number.
            #[must_use]
            pub fn single(&self, primitive: u32) -> Option<AnySolid> {
                None$(.or_else(|| find(&self.$single, primitive)))*
            }

            /// A box around all of them.
            #[must_use]
            pub fn bounds(&self) -> Bounds {
                let boxes = std::iter::empty()
                    $(.chain(self.$list.iter().map(|record| record.solid.bounds())))*;
                boxes.fold(Bounds::EMPTY, |sum, bounds| sum.union(&bounds))
            }

            /// Gives back the memory beyond what the lists hold.
            pub(super) fn trim(&mut self) {
                $(self.$list.shrink_to_fit();)*
            }
        }
    };
}

listed! {
    singles: spheres cuboids cones rounded_cones disks;
    all:
        Sphere in spheres
        Cuboid in cuboids
        Cone in cones
        RoundedCone in rounded_cones
        Disk in disks
        Composition in compositions
}

impl Solids {
    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The solids of a list with their numbers.
fn numbered<S: ConvexSolid + Into<AnySolid>>(
    list: &[SolidRecord<S>],
) -> impl Iterator<Item = (u32, AnySolid)> {
    list.iter()
        .map(|record| (record.primitive, record.solid.into()))
}

/// The solid of a list with a number.
fn find<S: ConvexSolid + Into<AnySolid>>(
    list: &[SolidRecord<S>],
    primitive: u32,
) -> Option<AnySolid> {
    let position = list.binary_search_by_key(&primitive, |record| record.primitive);
    position.ok().map(|position| list[position].solid.into())
}
