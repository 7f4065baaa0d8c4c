//! The values that data colors show, by the number of a solid or placement.
//!
//! Values are f32, in runs of consecutive numbers: the rows of a table are one run, so a value
//! takes 4 bytes. Whole numbers up to 2^24 are exact.

/// Values of some of a prototype's solids or placements.
#[derive(Clone, Debug, Default)]
pub struct ValueList {
    /// In ascending order of their first numbers, once the list is sorted.
    runs: Vec<Run>,
    /// NaN where there is no value.
    values: Vec<f32>,
}

#[derive(Clone, Copy, Debug)]
struct Run {
    /// The first number.
    number: u32,
    /// The position of its value.
    start: u32,
}

/// The values of a prototype's placements for one column.
#[derive(Clone, Debug)]
pub struct PlacementValues {
    /// The column.
    pub column: String,
    /// The values by instance number.
    pub values: ValueList,
}

impl ValueList {
    /// The bytes of a value in a run of many.
    pub const VALUE_BYTES: u64 = size_of::<f32>() as u64;

    /// The bytes of a run besides its values.
    pub const RUN_BYTES: u64 = size_of::<Run>() as u64;

    /// Adds the value of a number that has none yet; NaN is no value. After values whose numbers
    /// do not ascend, the list must be sorted with [`finish`](Self::finish).
    ///
    /// # Panics
    /// If the list has 2^32 values.
    pub fn push(&mut self, number: u32, value: f32) {
        let position = u32::try_from(self.values.len()).expect("fewer than 2^32 values");
        let follows = self
            .runs
            .last()
            .is_some_and(|run| run.number.checked_add(position - run.start) == Some(number));
        if !follows {
            let start = position;
            self.runs.push(Run { number, start });
        }
        self.values.push(value);
    }

    /// Reserves memory for this many more values, if possible.
    pub(in crate::scene) fn reserve(&mut self, more: usize) {
        // If the reservation fails, `push` allocates again.
        let _ = self.values.try_reserve_exact(more);
    }

    /// Sorts the values by their numbers and frees unused memory.
    pub fn finish(&mut self) {
        if !self.runs.is_sorted_by_key(|run| run.number) {
            let mut numbered: Vec<(u32, f32)> = self.iter().collect();
            numbered.sort_by_key(|&(number, _)| number);
            *self = Self::default();
            for (number, value) in numbered {
                self.push(number, value);
            }
        }
        self.runs.shrink_to_fit();
        self.values.shrink_to_fit();
    }

    /// The value of a number, if it has one.
    #[must_use]
    pub fn get(&self, number: u32) -> Option<f32> {
        let after = self.runs.partition_point(|run| run.number <= number);
        let run = self.runs[..after].last()?;
        let end = self
            .runs
            .get(after)
            .map_or(self.values.len(), |next| next.start as usize);
        let position = run.start as usize + (number - run.number) as usize;
        let value = self.values[..end].get(position)?;
        Some(*value).filter(|value| !value.is_nan())
    }

    /// The numbers and their values, in the order of the list; NaN where there is no value.
    pub fn iter(&self) -> impl Iterator<Item = (u32, f32)> {
        let ends = self.runs[1.min(self.runs.len())..].iter();
        let ends = ends
            .map(|run| run.start as usize)
            .chain([self.values.len()]);
        self.runs.iter().zip(ends).flat_map(|(run, end)| {
            let values = &self.values[run.start as usize..end];
            (run.number..).zip(values.iter().copied())
        })
    }

    /// Whether no number has a value.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.iter().all(|value| value.is_nan())
    }

    /// The bytes of the values and runs.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.values.as_slice()) + size_of_val(self.runs.as_slice())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(numbered: &[(u32, f32)]) -> ValueList {
        let mut list = ValueList::default();
        for &(number, value) in numbered {
            list.push(number, value);
        }
        list.finish();
        list
    }

    #[test]
    fn values_are_found_by_their_numbers_in_any_order() {
        let of_table = list(&[(5, 0.5), (6, f32::NAN), (7, 0.7), (9, 0.9)]);
        let found = |list: &ValueList| [4, 5, 6, 7, 8, 9, 10].map(|number| list.get(number));
        let expected = [None, Some(0.5), None, Some(0.7), None, Some(0.9), None];
        assert_eq!(found(&of_table), expected);
        let backwards = list(&[(9, 0.9), (7, 0.7), (6, f32::NAN), (5, 0.5)]);
        assert_eq!(found(&backwards), expected);
        assert_eq!(backwards.bytes(), 4 * 4 + 2 * 8);
        assert_eq!(list(&[]).get(0), None);
        let last = list(&[(u32::MAX - 1, 1.0)]);
        assert_eq!(last.get(u32::MAX - 1), Some(1.0));
        assert!(list(&[(0, f32::NAN)]).is_empty() && !last.is_empty());
    }
}
