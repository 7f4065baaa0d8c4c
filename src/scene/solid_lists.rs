//! The solids of a prototype, one list for each kind.

use std::borrow::Borrow;
use std::fmt::Debug;

use rayon::prelude::*;

use super::record::{CompositionRecord, CylinderRecord, MaterialIndex, Records, SolidRecord};
use crate::math::Bounds;
use crate::solid::{AnySolid, Composition, ConvexSolid, SolidCounts, SolidKind};
use crate::{for_each_solid, with_solid, with_solid_kind};

/// A list of the solids of one kind, each with its number and material.
pub trait SolidList: Clone + Debug + Default + Send + Sync {
    /// The kind of solid.
    type Solid;

    /// The number of solids.
    fn len(&self) -> usize;

    /// Whether the list is empty.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The solid at a position.
    ///
    /// # Panics
    /// If the position is not below the length.
    fn solid(&self, position: usize) -> impl Borrow<Self::Solid>;

    /// The primitive number at a position.
    ///
    /// # Panics
    /// If the position is not below the length.
    fn primitive(&self, position: usize) -> u32;

    /// The material at a position.
    ///
    /// # Panics
    /// If the position is not below the length.
    fn material(&self, position: usize) -> MaterialIndex;

    /// The position of a primitive number.
    fn position(&self, primitive: u32) -> Option<usize>;

    /// Adds a solid at the end.
    ///
    /// # Errors
    /// If the list stores rounded numbers and the rounded solid is invalid.
    fn push(&mut self, record: SolidRecord<Self::Solid>) -> Result<(), String>;

    /// Sorts the solids by their numbers, if the list is kept in that order.
    fn sort(&mut self);

    /// Frees the memory that no record uses.
    fn trim(&mut self);

    /// The bytes of the records.
    fn records_bytes(&self) -> usize;

    /// The bytes of one record, given the precision of cylinders.
    #[must_use]
    fn record_bytes(_: Records) -> usize {
        size_of::<SolidRecord<Self::Solid>>()
    }
}

impl<S: Clone + Debug + Send + Sync> SolidList for Vec<SolidRecord<S>> {
    type Solid = S;

    fn len(&self) -> usize {
        Vec::len(self)
    }

    #[inline(always)]
    fn solid(&self, position: usize) -> impl Borrow<S> {
        &self[position].solid
    }

    fn primitive(&self, position: usize) -> u32 {
        self[position].primitive
    }

    fn material(&self, position: usize) -> MaterialIndex {
        self[position].material
    }

    fn position(&self, primitive: u32) -> Option<usize> {
        self.binary_search_by_key(&primitive, |record| record.primitive)
            .ok()
    }

    fn push(&mut self, record: SolidRecord<S>) -> Result<(), String> {
        Vec::push(self, record);
        Ok(())
    }

    fn sort(&mut self) {
        self.sort_by_key(|record| record.primitive);
    }

    fn trim(&mut self) {
        self.shrink_to_fit();
    }

    fn records_bytes(&self) -> usize {
        size_of_val(self.as_slice())
    }
}

/// A kind of solid that prototypes contain.
pub trait Stored: Sized + 'static {
    /// The list that stores its solids.
    type List: SolidList<Solid = Self>;
}

/// A kind of solid with a list in [`Solids`].
pub trait Listed: Stored {
    /// The list of a prototype.
    fn list(solids: &Solids) -> &Self::List;

    /// The mutable list of a prototype.
    fn list_mut(solids: &mut Solids) -> &mut Self::List;
}

impl Stored for Composition {
    type List = Vec<CompositionRecord>;
}

macro_rules! listed {
    ($($type:ident $list:ident)*) => {
        $(impl Listed for crate::solid::$type {
            #[inline(always)]
            fn list(solids: &Solids) -> &Self::List {
                &solids.$list
            }

            fn list_mut(solids: &mut Solids) -> &mut Self::List {
                &mut solids.$list
            }
        })*
    };
}

macro_rules! solids {
    ($({ $type:ident $name:ident $list:ident $($rest:tt)* })*) => {
        /// The solids of a prototype. The lists of all kinds but the cylinders are in the order
        /// of the primitive numbers.
        #[derive(Clone, Debug, Default)]
        pub struct Solids {
            $(
                #[doc = concat!("Each a `", stringify!($name), "`.")]
                pub $list: <crate::solid::$type as Stored>::List,
            )*
            /// The solids that are composed of others.
            pub compositions: Vec<CompositionRecord>,
        }

        listed!($($type $list)* Composition compositions);

        impl Solids {
            /// The solids that are not composed of others, kind by kind, each with its
            /// number.
            pub fn simple(&self) -> impl Iterator<Item = (u32, AnySolid)> {
                std::iter::empty()$(.chain(numbered(&self.$list)))*
            }

            /// The solid with this number, if it is not composed of others.
            #[must_use]
            pub fn find_simple(&self, primitive: u32) -> Option<AnySolid> {
                None$(.or_else(|| find(&self.$list, primitive)))*
            }

            /// The solid at a position in the order of [`simple`](Self::simple).
            #[must_use]
            pub fn nth_simple(&self, position: usize) -> Option<(u32, AnySolid)> {
                let mut position = position;
                None$(.or_else(|| nth(&self.$list, &mut position)))*
            }
        }
    };
}

for_each_solid!(solids);

impl Solids {
    /// A prototype's solids, cylinders only.
    #[must_use]
    pub fn of_cylinders(cylinders: impl IntoIterator<Item = CylinderRecord>) -> Self {
        Self {
            cylinders: cylinders.into_iter().collect(),
            ..Self::default()
        }
    }

    /// Adds a solid at the end of the list of its kind. Numbers ascend within a list.
    ///
    /// # Errors
    /// If the list stores rounded numbers and the rounded solid is invalid.
    pub fn push(&mut self, record: SolidRecord<AnySolid>) -> Result<(), String> {
        fn add<S: Listed>(solids: &mut Solids, record: SolidRecord<S>) -> Result<(), String> {
            S::list_mut(solids).push(record)
        }
        let SolidRecord {
            solid,
            primitive,
            material,
        } = record;
        with_solid!(solid, solid => add(self, SolidRecord::new(solid, primitive, material)))
    }

    /// The number of solids.
    #[must_use]
    pub fn len(&self) -> usize {
        let lists = SolidKind::LISTS.iter();
        lists.map(|&kind| self.len_of(kind)).sum()
    }

    /// Whether the prototype has no solids.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The length of the list of a kind. All set operations share one list.
    #[must_use]
    pub fn len_of(&self, kind: SolidKind) -> usize {
        with_solid_kind!(kind, S => S::list(self).len())
    }

    /// The number of solids of each kind.
    #[must_use]
    pub fn counts(&self) -> SolidCounts {
        let mut counts = SolidCounts::default();
        for &kind in SolidKind::SIMPLE {
            counts.add(kind, self.len_of(kind) as u128);
        }
        for record in &self.compositions {
            counts.add(record.solid.kind(), 1);
        }
        counts
    }

    /// The number of the solid at a position in the list of its kind.
    ///
    /// # Panics
    /// If the position is not below the length of the list.
    #[must_use]
    pub fn primitive(&self, kind: SolidKind, position: usize) -> u32 {
        with_solid_kind!(kind, S => S::list(self).primitive(position))
    }

    /// The bytes of the records, including the operands of compositions.
    #[must_use]
    pub fn records_bytes(&self) -> usize {
        let lists = SolidKind::LISTS.iter();
        let lists = lists.map(|&kind| with_solid_kind!(kind, S => S::list(self).records_bytes()));
        let compositions = self.compositions.iter();
        let operands = compositions.map(|record| record.solid.heap_bytes());
        lists.chain(operands).sum()
    }

    /// A box around all solids. Runs on the caller's rayon pool.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        /// The least number of solids that is worth a thread.
        const SHARE: usize = 1 << 12;
        let of_list = |&kind| {
            with_solid_kind!(kind, S => {
                let list = S::list(self);
                let positions = (0..list.len()).into_par_iter().with_min_len(SHARE);
                let boxes = positions.map(|position| S::bounds(list.solid(position).borrow()));
                boxes.reduce(|| Bounds::EMPTY, |sum, bounds| sum.union(&bounds))
            })
        };
        let lists = SolidKind::LISTS.iter().map(of_list);
        lists.fold(Bounds::EMPTY, |sum, bounds| sum.union(&bounds))
    }

    /// The material of the solid of a kind with this number.
    #[must_use]
    pub fn material(&self, kind: SolidKind, primitive: u32) -> Option<MaterialIndex> {
        with_solid_kind!(kind, S => {
            let list = S::list(self);
            let position = list.position(primitive)?;
            Some(list.material(position))
        })
    }

    /// The solids of some materials: the number, the material and a box around each.
    #[must_use]
    pub fn of_materials(
        &self,
        is_of_them: impl Fn(MaterialIndex) -> bool,
    ) -> Vec<(u32, MaterialIndex, Bounds)> {
        let mut found = Vec::new();
        for &kind in SolidKind::LISTS {
            with_solid_kind!(kind, S => {
                let list = S::list(self);
                for position in 0..list.len() {
                    let material = list.material(position);
                    if is_of_them(material) {
                        let bounds = S::bounds(list.solid(position).borrow());
                        found.push((list.primitive(position), material, bounds));
                    }
                }
            });
        }
        found
    }

    /// Puts the lists in order after solids were added in another.
    ///
    /// # Errors
    /// When two solids have the same number: the number.
    pub(super) fn sort(&mut self) -> Result<(), u32> {
        let mut numbers = Vec::with_capacity(self.len());
        for &kind in SolidKind::LISTS {
            with_solid_kind!(kind, S => {
                let list = S::list_mut(self);
                list.sort();
                numbers.extend((0..list.len()).map(|position| list.primitive(position)));
            });
        }
        numbers.par_sort_unstable();
        let twice = numbers.windows(2).find(|pair| pair[0] == pair[1]);
        twice.map_or(Ok(()), |pair| Err(pair[0]))
    }

    /// Frees the memory that no record uses.
    pub(super) fn trim(&mut self) {
        for &kind in SolidKind::LISTS {
            with_solid_kind!(kind, S => S::list_mut(self).trim());
        }
    }
}

/// The solids of a list with their numbers.
fn numbered<L: SolidList<Solid: ConvexSolid + Into<AnySolid>>>(
    list: &L,
) -> impl Iterator<Item = (u32, AnySolid)> {
    let positions = 0..list.len();
    positions.map(|position| (list.primitive(position), any(list, position)))
}

/// The solid with this number in a list.
fn find<L: SolidList<Solid: ConvexSolid + Into<AnySolid>>>(
    list: &L,
    primitive: u32,
) -> Option<AnySolid> {
    let position = list.position(primitive)?;
    Some(any(list, position))
}

/// The solid at a position of a list, with its number. If the position is beyond the list,
/// the length of the list is subtracted from it.
fn nth<L: SolidList<Solid: ConvexSolid + Into<AnySolid>>>(
    list: &L,
    position: &mut usize,
) -> Option<(u32, AnySolid)> {
    if *position < list.len() {
        return Some((list.primitive(*position), any(list, *position)));
    }
    *position -= list.len();
    None
}

fn any<L: SolidList<Solid: ConvexSolid + Into<AnySolid>>>(list: &L, position: usize) -> AnySolid {
    let solid: L::Solid = *list.solid(position).borrow();
    solid.into()
}
