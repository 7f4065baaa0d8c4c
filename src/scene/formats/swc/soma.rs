//! Cell bodies.
//!
//! The samples of type 1 that are joined are a soma. What it is depends on how many
//! they are, as <http://neuromorpho.org/SomaFormat.html> has it and other readers do:
//!
//! - One sample is a ball.
//! - Three samples, a center `(x, y, z)` with the radius `r` and two children of it at
//!   `(x, y - r, z)` and `(x, y + r, z)` with the same radius, are a cylinder from the
//!   one child to the other: of length `2 r`, so that its wall has the area of a ball.
//! - Others are what their segments are.

use std::collections::HashMap;

use glam::DVec3;

use super::samples::Sample;

/// The share of the radius that the samples of a cylinder may be off. It trades files
/// whose numbers are rounded, to two decimals at a radius of a tenth, for somata that
/// are no such cylinder and would be moved by as much.
const TOLERANCE: f64 = 1.0 / 16.0;

/// The somata of a file that are more than their segments.
#[derive(Default)]
pub(super) struct Somata {
    /// The samples that are balls.
    pub balls: Vec<usize>,
    /// By both of their ends.
    cylinders: HashMap<usize, SomaCylinder>,
}

/// Three samples that are a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SomaCylinder {
    pub center: usize,
    /// In the order of the file.
    pub ends: [usize; 2],
}

impl Somata {
    /// Those of some samples with their parents.
    pub fn of(samples: &[Sample], parents: &[Option<usize>]) -> Self {
        // How many samples of a soma descend from each of one, up to three.
        let mut children = vec![0_u8; samples.len()];
        let parent_in_soma = |place: usize| {
            let parent = parents[place]?;
            (samples[place].is_soma && samples[parent].is_soma).then_some(parent)
        };
        for parent in (0..samples.len()).filter_map(parent_in_soma) {
            children[parent] = (children[parent] + 1).min(3);
        }
        let is_top = |place: usize| samples[place].is_soma && parent_in_soma(place).is_none();
        let balls = (0..samples.len()).filter(|&place| is_top(place) && children[place] == 0);
        let mut somata = Self {
            balls: balls.collect(),
            cylinders: HashMap::new(),
        };
        // The first child of a center waits for the second.
        let mut waiting = HashMap::new();
        for place in 0..samples.len() {
            let Some(center) = parent_in_soma(place) else {
                continue;
            };
            if children[place] > 0 || children[center] != 2 || !is_top(center) {
                continue;
            }
            let Some(first) = waiting.insert(center, place) else {
                continue;
            };
            let ends = [first, place];
            if is_cylinder(&samples[center], ends.map(|end| &samples[end])) {
                let cylinder = SomaCylinder { center, ends };
                somata.cylinders.extend(ends.map(|end| (end, cylinder)));
            }
        }
        somata
    }

    /// The cylinder that a sample is an end of.
    pub fn cylinder_at(&self, place: usize) -> Option<&SomaCylinder> {
        self.cylinders.get(&place)
    }
}

/// Whether the ends are where those of the cylinder of a center are.
fn is_cylinder(center: &Sample, ends: [&Sample; 2]) -> bool {
    let (radius, allowed) = (center.radius, center.radius * TOLERANCE);
    let is_end = |end: &Sample, y: f64| {
        let off = end.point - center.point - DVec3::new(0.0, y, 0.0);
        off.abs().max_element() <= allowed && (end.radius - radius).abs() <= allowed
    };
    let [one, other] = ends;
    radius > 0.0
        && ((is_end(one, -radius) && is_end(other, radius))
            || (is_end(one, radius) && is_end(other, -radius)))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::samples::SwcFile;
    use super::*;

    fn somata(text: &str) -> (Vec<usize>, Vec<SomaCylinder>) {
        let file = SwcFile {
            path: Path::new("n.swc"),
        };
        let (samples, _) = file.samples(text.as_bytes(), |_| Ok(())).expect("samples");
        let parents = file.parents(&samples).expect("parents");
        let somata = Somata::of(&samples, &parents);
        let firsts = (0..samples.len()).filter_map(|place| {
            let cylinder = *somata.cylinder_at(place)?;
            (cylinder.ends[0] == place).then_some(cylinder)
        });
        let cylinders = firsts.collect();
        (somata.balls, cylinders)
    }

    #[test]
    fn soma_of_one_sample_is_a_ball() {
        assert_eq!(somata("1 1 0 0 0 2 -1\n2 3 9 0 0 1 1\n").0, [0]);
        // In the middle of the tree, too, and one a neuron.
        assert_eq!(
            somata("1 3 0 0 0 2 -1\n2 1 9 0 0 1 1\n3 1 0 0 0 1 -1\n").0,
            [1, 2]
        );
        assert_eq!(somata("1 3 0 0 0 2 -1\n2 3 9 0 0 1 1\n").0, [0; 0]);
        assert_eq!(somata("1 1 0 0 0 2 -1\n2 1 9 0 0 1 1\n").0, [0; 0]);
    }

    #[test]
    fn soma_of_three_samples_is_a_cylinder_where_they_are_as_neuromorpho_has_them() {
        let cylinder = [SomaCylinder {
            center: 0,
            ends: [1, 3],
        }];
        let rest = "4 3 0 9 0 1 1\n";
        let standard = |ends: [&str; 2]| {
            let [one, other] = ends;
            somata(&format!(
                "1 1 7 5 3 2 -1\n2 1 {one} 1\n{rest}3 1 {other} 1\n"
            ))
            .1
        };
        assert_eq!(standard(["7 3 3 2", "7 7 3 2"]), cylinder);
        assert_eq!(standard(["7 7 3 2", "7 3 3 2"]), cylinder);
        // Rounded, by less than an eighth of a unit.
        assert_eq!(standard(["7 3.1 3 2", "7 6.9 3 1.9"]), cylinder);
        for ends in [
            ["7 2.8 3 2", "7 7 3 2"],
            ["7 3 3 2", "7 3 3 2"],
            ["5 5 3 2", "9 5 3 2"],
            ["7 3 3 1", "7 7 3 2"],
        ] {
            assert_eq!(standard(ends), [], "{ends:?}");
        }
        // A chain, and more than three.
        assert_eq!(
            somata("1 1 0 0 0 2 -1\n2 1 0 -2 0 2 1\n3 1 0 2 0 2 2\n").1,
            []
        );
        assert_eq!(
            somata("1 1 0 0 0 2 -1\n2 1 0 -2 0 2 1\n3 1 0 2 0 2 1\n4 1 0 4 0 2 3\n").1,
            []
        );
    }
}
