//! The cylinders of a prototype, stored in f64 or rounded to f32.
//!
//! In f32 the primitive numbers are stored beside the records, as runs of consecutive numbers,
//! which is a single run unless rows were skipped. [`CylinderList::rounding`] is the greatest
//! difference of a number from the stated one.

mod arrangement;

use std::borrow::Borrow;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::record::{CylinderRecord, CylinderRecord32, MaterialIndex, Records, SolidRecord};
use super::solid_lists::SolidList;
use crate::solid::{Cylinder, CylinderError};

/// The cylinders of a prototype, each with its primitive number, in any order.
#[derive(Clone, Debug)]
pub struct CylinderList {
    storage: Storage,
    /// The positions in the order of the primitive numbers, computed when first needed.
    by_primitive: OnceLock<Vec<u32>>,
}

#[derive(Clone, Debug)]
enum Storage {
    F64(Arc<Vec<CylinderRecord>>),
    F32(Rounded),
}

/// Shared access to the records of a list, so that the tracer does not go through the list.
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
    /// The first position and primitive number of each run of consecutive numbers.
    runs: Vec<(u32, u32)>,
    /// The greatest difference of a number from the stated one.
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
    /// An empty list that stores cylinders in the given precision.
    #[must_use]
    pub fn new(records: Records) -> Self {
        let storage = match records {
            Records::F64 => Storage::F64(Arc::default()),
            Records::F32 => Storage::F32(Rounded::default()),
        };
        Self::of(storage)
    }

    fn of(storage: Storage) -> Self {
        Self {
            storage,
            by_primitive: OnceLock::new(),
        }
    }

    /// Adds a cylinder at the end.
    ///
    /// # Errors
    /// If the list is of f32 and the rounded cylinder is invalid.
    pub fn push(&mut self, record: CylinderRecord) -> Result<(), CylinderError> {
        match &mut self.storage {
            Storage::F64(records) => Arc::make_mut(records).push(record),
            Storage::F32(rounded) => rounded.push(&record)?,
        }
        self.by_primitive.take();
        Ok(())
    }

    /// Reserves memory for exactly this many more cylinders, if possible.
    pub(super) fn reserve(&mut self, more: usize) {
        // If the reservation fails, `push` allocates again.
        let _ = match &mut self.storage {
            Storage::F64(records) => Arc::make_mut(records).try_reserve_exact(more),
            Storage::F32(rounded) => Arc::make_mut(&mut rounded.records).try_reserve_exact(more),
        };
    }

    /// The number of cylinders.
    #[inline]
    #[must_use]
    pub fn len(&self) -> usize {
        match &self.storage {
            Storage::F64(records) => records.len(),
            Storage::F32(rounded) => rounded.records.len(),
        }
    }

    /// Whether the list is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cylinder at a position.
    ///
    /// # Panics
    /// If the position is not below [`CylinderList::len`].
    #[inline]
    #[must_use]
    pub fn get(&self, position: usize) -> CylinderRecord {
        match &self.storage {
            Storage::F64(records) => records[position],
            Storage::F32(rounded) => {
                let record = &rounded.records[position];
                let number = rounded.primitive(position);
                CylinderRecord::new(&record.cylinder(), number, record.material())
            }
        }
    }

    /// The primitive number at a position.
    ///
    /// # Panics
    /// If the position is not below [`CylinderList::len`].
    #[must_use]
    pub fn primitive(&self, position: usize) -> u32 {
        match &self.storage {
            Storage::F64(records) => records[position].primitive(),
            Storage::F32(rounded) => {
                assert!(
                    position < rounded.records.len(),
                    "position {position} is beyond the end of the list"
                );
                rounded.primitive(position)
            }
        }
    }

    /// All cylinders in order.
    #[must_use]
    pub fn iter(&self) -> Iter<'_> {
        Iter {
            list: self,
            positions: 0..self.len(),
        }
    }

    /// The records, if they are of f64.
    #[inline]
    #[must_use]
    pub fn as_f64(&self) -> Option<&[CylinderRecord]> {
        match &self.storage {
            Storage::F64(records) => Some(records),
            Storage::F32(_) => None,
        }
    }

    /// Shares the records.
    pub(crate) fn shared(&self) -> SharedRecords {
        match &self.storage {
            Storage::F64(records) => SharedRecords::F64(Arc::clone(records)),
            Storage::F32(rounded) => SharedRecords::F32(Arc::clone(&rounded.records)),
        }
    }

    /// The records, if they are of f32.
    #[inline]
    #[must_use]
    pub fn as_f32(&self) -> Option<&[CylinderRecord32]> {
        match &self.storage {
            Storage::F64(_) => None,
            Storage::F32(rounded) => Some(&rounded.records),
        }
    }

    /// The precision in which the cylinders are stored.
    #[must_use]
    pub fn records(&self) -> Records {
        match &self.storage {
            Storage::F64(_) => Records::F64,
            Storage::F32(_) => Records::F32,
        }
    }

    /// The greatest difference of a coordinate or radius from the stated one; 0 in f64.
    #[must_use]
    pub fn rounding(&self) -> f64 {
        match &self.storage {
            Storage::F64(_) => 0.0,
            Storage::F32(rounded) => rounded.rounding,
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
        match &self.storage {
            Storage::F64(records) => records[position].cylinder(),
            Storage::F32(rounded) => rounded.records[position].cylinder(),
        }
    }

    fn primitive(&self, position: usize) -> u32 {
        self.primitive(position)
    }

    fn material(&self, position: usize) -> MaterialIndex {
        match &self.storage {
            Storage::F64(records) => records[position].material(),
            Storage::F32(rounded) => rounded.records[position].material(),
        }
    }

    /// The position of a primitive number. The first call sorts all numbers and keeps
    /// the order, which takes 4 bytes a cylinder.
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

    /// Frees the unused memory if it is more than an eighth. The records are aligned, so
    /// this copies them, and both copies exist for a while.
    fn trim(&mut self) {
        let is_loose = |capacity: usize, len: usize| capacity - len > capacity / 8;
        match &mut self.storage {
            Storage::F64(records) if is_loose(records.capacity(), records.len()) => {
                Arc::make_mut(records).shrink_to_fit();
            }
            Storage::F32(rounded)
                if is_loose(rounded.records.capacity(), rounded.records.len()) =>
            {
                Arc::make_mut(&mut rounded.records).shrink_to_fit();
            }
            _ => {}
        }
    }

    /// The bytes of the records and of the numbers stored separately.
    fn records_bytes(&self) -> usize {
        let apart = match &self.storage {
            Storage::F64(_) => 0,
            Storage::F32(rounded) => size_of_val(rounded.runs.as_slice()),
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
        Self::of(Storage::F64(Arc::new(records)))
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
