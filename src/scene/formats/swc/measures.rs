//! The columns of a neuron for data colors, computed only if one is shown.
//!
//! - `type` and `radius` are those of a sample.
//! - `path_length` is the distance from the root along the tree: the sum of the distances between
//!   samples and their parents, in scene units. That of a segment is the one at its own sample,
//!   the farther end.
//! - `depth` is the number of branch points between the root and a sample, without the sample
//!   itself: samples with at least two children that are not part of a soma. So it is 0 from the
//!   soma to the first branch point, and 1 on the branches behind that.

use super::Neuron;
use crate::scene::colors::DataColor;

/// A column of a neuron.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Measure {
    Type,
    Radius,
    Depth,
    PathLength,
}

impl Measure {
    /// The names of the columns.
    pub const NAMES: [(&'static str, Self); 4] = [
        ("type", Self::Type),
        ("radius", Self::Radius),
        ("depth", Self::Depth),
        ("path_length", Self::PathLength),
    ];
}

impl Neuron {
    /// The values of all samples.
    pub(super) fn measures(&self, measure: Measure) -> Vec<f32> {
        let samples = self.samples.iter();
        match measure {
            Measure::Type => samples.map(|sample| sample.kind as f32).collect(),
            Measure::Radius => samples
                .map(|sample| DataColor::stored(sample.radius))
                .collect(),
            Measure::Depth => {
                let mut children = vec![0_u8; self.samples.len()];
                for &parent in self.parents.iter().flatten() {
                    children[parent] = children[parent].saturating_add(1);
                }
                self.sums(|_, parent| {
                    let is_branch_point = children[parent] > 1 && !self.samples[parent].is_soma();
                    f64::from(u8::from(is_branch_point))
                })
            }
            Measure::PathLength => self.sums(|sample, parent| {
                let ends = [sample, parent].map(|place| self.samples[place].point);
                ends[0].distance(ends[1])
            }),
        }
    }

    /// The sums of the steps from the root to each sample, 0 for a root. `step` gets a sample
    /// and its parent.
    fn sums(&self, step: impl Fn(usize, usize) -> f64) -> Vec<f32> {
        let mut sums = vec![f64::NAN; self.samples.len()];
        let mut open = Vec::new();
        for place in 0..self.samples.len() {
            // Up to a sample whose sum is known, and back down.
            let mut next = Some(place).filter(|&place| sums[place].is_nan());
            while let Some(place) = next {
                open.push(place);
                next = self.parents[place].filter(|&parent| sums[parent].is_nan());
            }
            while let Some(place) = open.pop() {
                sums[place] = match self.parents[place] {
                    Some(parent) => sums[parent] + step(place, parent),
                    None => 0.0,
                };
            }
        }
        sums.into_iter().map(DataColor::stored).collect()
    }
}
