//! The cylinders of a prototype, kept in f64 or rounded to f32.
//!
//! In f64 a record is a cache line, number and all. In f32 it is half of one: the numbers of
//! primitives are kept apart, as runs of consecutive ones, of which there is one
//! unless rows were skipped.
//!
//! **Rounding.** A number is rounded to the nearest f32 once, when it is added.
//! From then on the rounded cylinder *is* the cylinder: widened to f64 it is
//! exact, and the true surface that every error bound speaks of is its surface,
//! whoever asks. Against what was stated a number is off by at most
//!
//! ```text
//! |f32(x) - x| <= 2^-24 |x|     where |x| >= 2^-126,
//!                 2^-150        below, where f32 is denormal
//! ```
//!
//! and [`CylinderList::rounding`] is the greatest difference there was. Ends that
//! become the same point, a radius that becomes zero and a number beyond f32 make
//! no cylinder, and are refused.

mod arrangement;

use std::borrow::Borrow;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use glam::{DVec3, Vec3};

use super::description::{CylinderRecord, MaterialIndex};
use super::solid_lists::{SolidList, SolidRecord};
use crate::solid::{Caps, Cylinder, CylinderError};

/// The numbers in which cylinders are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Records {
    /// As stated, 64 bytes a cylinder.
    #[default]
    F64,
    /// Rounded to f32, 32 bytes a cylinder.
    F32,
}

impl Records {
    /// The name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::F32 => "f32",
        }
    }

    /// The bytes of one record.
    #[must_use]
    pub fn record_bytes(self) -> usize {
        match self {
            Self::F64 => size_of::<CylinderRecord>(),
            Self::F32 => size_of::<CylinderRecord32>(),
        }
    }
}

/// A cylinder of f32 numbers and its material, in half a cache line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct CylinderRecord32 {
    p0: [f32; 3],
    p1: [f32; 3],
    radius: f32,
    material: MaterialIndex,
    caps: Caps,
}

const _: () = assert!(size_of::<CylinderRecord32>() == 32);

impl CylinderRecord32 {
    /// The record of a rounded cylinder.
    fn new(cylinder: &Cylinder, material: MaterialIndex) -> Result<Self, CylinderError> {
        let record = Self {
            p0: cylinder.p0().as_vec3().to_array(),
            p1: cylinder.p1().as_vec3().to_array(),
            radius: cylinder.radius() as f32,
            material,
            caps: cylinder.caps(),
        };
        let rounded = record.cylinder();
        Cylinder::new(rounded.p0(), rounded.p1(), rounded.radius(), rounded.caps())?;
        Ok(record)
    }

    /// The cylinder of these very numbers.
    #[inline]
    #[must_use]
    pub fn cylinder(&self) -> Cylinder {
        let widened = |point: [f32; 3]| Vec3::from_array(point).as_dvec3();
        let radius = f64::from(self.radius);
        Cylinder::from_valid(widened(self.p0), widened(self.p1), radius, self.caps)
    }

    /// The material.
    #[must_use]
    pub fn material(&self) -> MaterialIndex {
        self.material
    }
}

/// The cylinders of a prototype. Each has its primitive number with it, whatever
/// its position.
#[derive(Clone, Debug)]
pub struct CylinderList {
    kept: Kept,
    /// The positions in the order of the primitive numbers, once it was requested.
    by_primitive: OnceLock<Vec<u32>>,
}

#[derive(Clone, Debug)]
enum Kept {
    F64(Arc<Vec<CylinderRecord>>),
    F32(Rounded),
}

/// The records of a list, for those who trace them: they need not come through the list.
#[derive(Clone, Debug)]
pub(crate) enum SharedRecords {
    F64(Arc<Vec<CylinderRecord>>),
    F32(Arc<Vec<CylinderRecord32>>),
}

impl SharedRecords {
    /// The cylinder at a position.
    #[inline(always)]
    pub fn cylinder(&self, position: usize) -> Cylinder {
        match self {
            Self::F64(records) => records[position].cylinder(),
            Self::F32(records) => records[position].cylinder(),
        }
    }
}

/// Cylinders in f32.
#[derive(Clone, Debug, Default)]
struct Rounded {
    records: Arc<Vec<CylinderRecord32>>,
    /// Where consecutive primitive numbers begin: a position and its number.
    runs: Vec<(u32, u32)>,
    /// The greatest difference of a number from what was stated.
    rounding: f64,
}

impl Rounded {
    fn push(&mut self, record: &CylinderRecord) -> Result<(), CylinderError> {
        let cylinder = record.cylinder();
        let rounded = CylinderRecord32::new(&cylinder, record.material())?;
        let kept = rounded.cylinder();
        let off = |kept: DVec3, stated: DVec3| (kept - stated).abs().max_element();
        self.rounding = self
            .rounding
            .max(off(kept.p0(), cylinder.p0()))
            .max(off(kept.p1(), cylinder.p1()))
            .max((kept.radius() - cylinder.radius()).abs());
        let position = self.records.len() as u32;
        let follows = self.runs.last().is_some_and(|&(first, number)| {
            number.checked_add(position - first) == Some(record.primitive())
        });
        if !follows {
            self.runs.push((position, record.primitive()));
        }
        Arc::make_mut(&mut self.records).push(rounded);
        Ok(())
    }

    fn primitive(&self, position: usize) -> u32 {
        let after = self
            .runs
            .partition_point(|&(first, _)| first as usize <= position);
        let (first, number) = self.runs[after - 1];
        number + (position as u32 - first)
    }
}

impl CylinderList {
    /// An empty list that keeps cylinders so.
    #[must_use]
    pub fn new(records: Records) -> Self {
        let kept = match records {
            Records::F64 => Kept::F64(Arc::default()),
            Records::F32 => Kept::F32(Rounded::default()),
        };
        Self::of(kept)
    }

    fn of(kept: Kept) -> Self {
        Self {
            kept,
            by_primitive: OnceLock::new(),
        }
    }

    /// Adds a cylinder at the end.
    ///
    /// # Errors
    /// When the list is of f32 and the rounded cylinder is none.
    pub fn push(&mut self, record: CylinderRecord) -> Result<(), CylinderError> {
        match &mut self.kept {
            Kept::F64(records) => Arc::make_mut(records).push(record),
            Kept::F32(rounded) => rounded.push(&record)?,
        }
        self.by_primitive.take();
        Ok(())
    }

    /// Makes room for exactly this many more, where memory allows it.
    pub(super) fn reserve(&mut self, more: usize) {
        // What cannot be had now is requested again by `push`.
        let _ = match &mut self.kept {
            Kept::F64(records) => Arc::make_mut(records).try_reserve_exact(more),
            Kept::F32(rounded) => Arc::make_mut(&mut rounded.records).try_reserve_exact(more),
        };
    }

    /// How many there are.
    #[inline]
    #[must_use]
    pub fn len(&self) -> usize {
        match &self.kept {
            Kept::F64(records) => records.len(),
            Kept::F32(rounded) => rounded.records.len(),
        }
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cylinder at a position.
    ///
    /// # Panics
    /// When there is none.
    #[inline]
    #[must_use]
    pub fn get(&self, position: usize) -> CylinderRecord {
        match &self.kept {
            Kept::F64(records) => records[position],
            Kept::F32(rounded) => {
                let record = &rounded.records[position];
                let number = rounded.primitive(position);
                CylinderRecord::new(&record.cylinder(), number, record.material)
            }
        }
    }

    /// The primitive number at a position.
    ///
    /// # Panics
    /// When there is no cylinder.
    #[must_use]
    pub fn primitive(&self, position: usize) -> u32 {
        match &self.kept {
            Kept::F64(records) => records[position].primitive(),
            Kept::F32(rounded) => {
                assert!(
                    position < rounded.records.len(),
                    "no cylinder at {position}"
                );
                rounded.primitive(position)
            }
        }
    }

    /// All of them in order.
    #[must_use]
    pub fn iter(&self) -> Iter<'_> {
        Iter {
            list: self,
            positions: 0..self.len(),
        }
    }

    /// The records, where they are of f64.
    #[inline]
    #[must_use]
    pub fn as_f64(&self) -> Option<&[CylinderRecord]> {
        match &self.kept {
            Kept::F64(records) => Some(records),
            Kept::F32(_) => None,
        }
    }

    /// The records, to be kept.
    pub(crate) fn shared(&self) -> SharedRecords {
        match &self.kept {
            Kept::F64(records) => SharedRecords::F64(Arc::clone(records)),
            Kept::F32(rounded) => SharedRecords::F32(Arc::clone(&rounded.records)),
        }
    }

    /// The records, where they are of f32.
    #[inline]
    #[must_use]
    pub fn as_f32(&self) -> Option<&[CylinderRecord32]> {
        match &self.kept {
            Kept::F64(_) => None,
            Kept::F32(rounded) => Some(&rounded.records),
        }
    }

    /// How they are kept.
    #[must_use]
    pub fn records(&self) -> Records {
        match &self.kept {
            Kept::F64(_) => Records::F64,
            Kept::F32(_) => Records::F32,
        }
    }

    /// The greatest difference of a coordinate or radius from what was stated:
    /// 0 in f64.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        match &self.kept {
            Kept::F64(_) => 0.0,
            Kept::F32(rounded) => rounded.rounding,
        }
    }
}

impl SolidList for CylinderList {
    type Solid = Cylinder;

    #[inline]
    fn len(&self) -> usize {
        self.len()
    }

    #[inline]
    fn solid(&self, position: usize) -> impl Borrow<Cylinder> {
        match &self.kept {
            Kept::F64(records) => records[position].cylinder(),
            Kept::F32(rounded) => rounded.records[position].cylinder(),
        }
    }

    fn primitive(&self, position: usize) -> u32 {
        self.primitive(position)
    }

    fn material(&self, position: usize) -> MaterialIndex {
        match &self.kept {
            Kept::F64(records) => records[position].material(),
            Kept::F32(rounded) => rounded.records[position].material(),
        }
    }

    /// The position of a primitive number. The first time all are sorted, which
    /// takes 4 bytes a cylinder from then on.
    fn position(&self, primitive: u32) -> Option<usize> {
        let by_primitive = self.by_primitive.get_or_init(|| {
            let mut positions: Vec<u32> = (0..self.len() as u32).collect();
            positions.sort_by_key(|&position| self.primitive(position as usize));
            positions
        });
        let number = |&position: &u32| self.primitive(position as usize);
        let place = by_primitive.binary_search_by_key(&primitive, number).ok()?;
        Some(by_primitive[place] as usize)
    }

    fn push(&mut self, record: SolidRecord<Cylinder>) -> Result<(), String> {
        let record = CylinderRecord::new(&record.solid, record.primitive, record.material);
        self.push(record).map_err(|error| error.to_string())
    }

    /// Cylinders may have any order.
    fn sort(&mut self) {}

    /// Gives back the memory that no cylinder uses, if it is more than an
    /// eighth: records are aligned, so that giving back is to copy them, with
    /// both there for a while.
    fn trim(&mut self) {
        let is_loose = |capacity: usize, len: usize| capacity - len > capacity / 8;
        match &mut self.kept {
            Kept::F64(records) if is_loose(records.capacity(), records.len()) => {
                Arc::make_mut(records).shrink_to_fit();
            }
            Kept::F32(rounded) if is_loose(rounded.records.capacity(), rounded.records.len()) => {
                Arc::make_mut(&mut rounded.records).shrink_to_fit();
            }
            _ => {}
        }
    }

    /// The bytes of the records, and of the numbers that are kept apart.
    fn records_bytes(&self) -> usize {
        let apart = match &self.kept {
            Kept::F64(_) => 0,
            Kept::F32(rounded) => size_of_val(rounded.runs.as_slice()),
        };
        self.len() * self.records().record_bytes() + apart
    }

    fn record_bytes(records: Records) -> usize {
        records.record_bytes()
    }
}

impl Default for CylinderList {
    fn default() -> Self {
        Self::new(Records::default())
    }
}

impl From<Vec<CylinderRecord>> for CylinderList {
    fn from(records: Vec<CylinderRecord>) -> Self {
        Self::of(Kept::F64(Arc::new(records)))
    }
}

impl FromIterator<CylinderRecord> for CylinderList {
    fn from_iter<I: IntoIterator<Item = CylinderRecord>>(records: I) -> Self {
        Self::from(Vec::from_iter(records))
    }
}

impl<'a> IntoIterator for &'a CylinderList {
    type Item = CylinderRecord;
    type IntoIter = Iter<'a>;

    fn into_iter(self) -> Iter<'a> {
        self.iter()
    }
}

/// The cylinders of a list in order.
#[derive(Clone, Debug)]
pub struct Iter<'a> {
    list: &'a CylinderList,
    positions: Range<usize>,
}

impl Iterator for Iter<'_> {
    type Item = CylinderRecord;

    #[inline]
    fn next(&mut self) -> Option<CylinderRecord> {
        self.positions
            .next()
            .map(|position| self.list.get(position))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.positions.size_hint()
    }
}

impl ExactSizeIterator for Iter<'_> {}

#[cfg(test)]
mod tests;
