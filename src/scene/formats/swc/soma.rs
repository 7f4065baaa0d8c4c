//! Cell bodies.
//!
//! Connected samples of type 1 form a soma. Its shape depends on their number, as
//! <http://neuromorpho.org/SomaFormat.html> defines and other readers implement:
//!
//! - One sample is a ball.
//! - Three samples, a center `(x, y, z)` with the radius `r` and two children of it at
//!   `(x, y - r, z)` and `(x, y + r, z)` with the same radius, are a cylinder from one
//!   child to the other. Its length is `2 r`, so its side has the area of a ball.
//! - Other somata consist of their segments.

use std::collections::HashMap;

use glam::DVec3;

use super::samples::Sample;

/// The error of the samples of a cylinder that is allowed, relative to the radius. It
/// accepts rounded numbers, such as two decimals at a radius of a tenth. In return, a soma
/// that is not such a cylinder may be displaced by as much.
const TOLERANCE: f64 = 1.0 / 16.0;

/// The somata of a file that do not consist of their segments.
#[derive(Default)]
pub(super) struct Somata {
    /// The samples that are balls.
    pub balls: Vec<usize>,
    /// The cylinders, by each of their two end samples.
    cylinders: HashMap<usize, SomaCylinder>,
}

/// Three samples that form a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SomaCylinder {
    pub center: usize,
    /// The end samples, in the order of the file.
    pub ends: [usize; 2],
}

impl Somata {
    /// Finds the somata among samples with their parents.
    pub fn of(samples: &[Sample], parents: &[Option<usize>]) -> Self {
        // The number of children within the soma of each sample, up to three.
        let mut children = vec![0_u8; samples.len()];
        let parent_in_soma = |place: usize| {
            let parent = parents[place]?;
            (samples[place].is_soma() && samples[parent].is_soma()).then_some(parent)
        };
        for parent in (0..samples.len()).filter_map(parent_in_soma) {
            children[parent] = (children[parent] + 1).min(3);
        }
        let is_top = |place: usize| samples[place].is_soma() && parent_in_soma(place).is_none();
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

    /// The cylinder with an end at this sample.
    pub fn cylinder_at(&self, place: usize) -> Option<&SomaCylinder> {
        self.cylinders.get(&place)
    }
}

/// Whether the samples are the ends of the cylinder about a center.
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
        // Also in the middle of a tree, and once for each neuron.
        assert_eq!(
            somata("1 3 0 0 0 2 -1\n2 1 9 0 0 1 1\n3 1 0 0 0 1 -1\n").0,
            [1, 2]
        );
        assert_eq!(somata("1 3 0 0 0 2 -1\n2 3 9 0 0 1 1\n").0, [0; 0]);
        assert_eq!(somata("1 1 0 0 0 2 -1\n2 1 9 0 0 1 1\n").0, [0; 0]);
    }

    #[test]
    fn soma_of_three_samples_is_a_cylinder_if_they_follow_neuromorpho() {
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
