//! The parents of samples. Every id must be unique, and no sample may descend from
//! itself.

use std::collections::HashMap;

use super::samples::{Sample, SwcFile};
use crate::scene::error::SceneError;

/// The parent number of a sample without a parent.
const NO_PARENT: i64 = -1;

impl SwcFile<'_> {
    /// The position of each sample's parent in the list of samples.
    pub fn parents(&self, samples: &[Sample]) -> Result<Vec<Option<usize>>, SceneError> {
        let index = self.index(samples)?;
        let parents = self.places(samples, &index)?;
        self.check_cycles(samples, &parents)?;
        Ok(parents)
    }

    /// The position of each id in the list of samples.
    fn index(&self, samples: &[Sample]) -> Result<HashMap<i64, usize>, SceneError> {
        let mut index = HashMap::with_capacity(samples.len());
        for (place, sample) in samples.iter().enumerate() {
            if let Some(first) = index.insert(sample.id, place) {
                let (id, line) = (sample.id, samples[first].line);
                let message = format!("the id {id} is already on line {line}: ids must be unique");
                return Err(self.error(sample.line, Some("id"), message, None));
            }
        }
        Ok(index)
    }

    /// The position of each parent, without a check for cycles.
    fn places(
        &self,
        samples: &[Sample],
        index: &HashMap<i64, usize>,
    ) -> Result<Vec<Option<usize>>, SceneError> {
        let parent = |sample: &Sample| {
            let message = match index.get(&sample.parent) {
                _ if sample.parent == NO_PARENT => return Ok(None),
                Some(_) if sample.parent == sample.id => "the sample is its own parent".to_owned(),
                Some(&place) => return Ok(Some(place)),
                None => format!(
                    "no sample has the id {}: the parent must be the id of a sample, or -1 for none",
                    sample.parent
                ),
            };
            Err(self.error(sample.line, Some("parent"), message, None))
        };
        samples.iter().map(parent).collect()
    }

    /// Checks that no sample descends from itself.
    fn check_cycles(
        &self,
        samples: &[Sample],
        parents: &[Option<usize>],
    ) -> Result<(), SceneError> {
        // For each sample, the start of the first walk that reached it.
        let mut seen = vec![usize::MAX; samples.len()];
        for start in 0..samples.len() {
            let mut place = start;
            while seen[place] == usize::MAX {
                seen[place] = start;
                match parents[place] {
                    Some(parent) => place = parent,
                    None => break,
                }
            }
            // The walk returned to its own path, not to an end or an earlier path.
            if seen[place] == start && parents[place].is_some() {
                return Err(self.cycle(samples, parents, place));
            }
        }
        Ok(())
    }

    /// The error that the sample at `place` descends from itself. It names the first
    /// sample of the cycle in the file.
    fn cycle(&self, samples: &[Sample], parents: &[Option<usize>], place: usize) -> SceneError {
        const MOST_SHOWN: usize = 12;
        let mut round = vec![place];
        round.extend(
            std::iter::successors(parents[place], |&at| parents[at]).take_while(|&at| at != place),
        );
        let first = (0..round.len()).min_by_key(|&at| round[at]).unwrap_or(0);
        round.rotate_left(first);
        let id = |at: usize| samples[at].id.to_string();
        let mut ids: Vec<String> = round.iter().take(MOST_SHOWN).map(|&at| id(at)).collect();
        if round.len() > MOST_SHOWN {
            ids.push(format!("({} more)", round.len() - MOST_SHOWN));
        }
        ids.push(id(round[0]));
        let message = format!(
            "the parents form a cycle: {}; a sample must not descend from itself",
            ids.join(" -> ")
        );
        self.error(samples[round[0]].line, Some("parent"), message, None)
    }
}
