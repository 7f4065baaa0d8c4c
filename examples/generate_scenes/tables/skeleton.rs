//! The skeleton of a tree and its wood.
//!
//! A skeleton is a list of nodes, parents before children. Radii follow
//! Leonardo's rule, the pipe model: the cross-section of a limb is the sum of
//! the cross-sections it carries, down to tips of one fixed radius.

use glam::DVec3;

use super::Table;

/// A point of the skeleton.
pub struct Node {
    pub position: DVec3,
    pub parent: Option<usize>,
}

/// A growing tree; the first node is its foot, at the origin.
pub struct Skeleton {
    nodes: Vec<Node>,
}

impl Skeleton {
    pub fn new() -> Self {
        Self {
            nodes: vec![Node {
                position: DVec3::ZERO,
                parent: None,
            }],
        }
    }

    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Adds a node and returns its number.
    pub fn grow(&mut self, parent: usize, position: DVec3) -> usize {
        self.nodes.push(Node {
            position,
            parent: Some(parent),
        });
        self.nodes.len() - 1
    }

    /// Pulls every inner node halfway to the middle of its neighbours, which
    /// takes the zigzag out of limbs that grew step by step.
    pub fn smooth(&mut self) {
        let mut sum = vec![DVec3::ZERO; self.nodes.len()];
        let mut count = vec![0.0; self.nodes.len()];
        for node in &self.nodes {
            if let Some(parent) = node.parent {
                sum[parent] += node.position;
                count[parent] += 1.0;
            }
        }
        let before: Vec<DVec3> = self.nodes.iter().map(|node| node.position).collect();
        for (index, node) in self.nodes.iter_mut().enumerate() {
            if let Some(parent) = node.parent
                && count[index] > 0.0
            {
                let children = sum[index] / count[index];
                node.position = 0.5 * node.position + 0.25 * (before[parent] + children);
            }
        }
    }

    /// The radius of the limb that ends at each node, for tips of `tip`.
    pub fn radii(&self, tip: f64) -> Vec<f64> {
        let mut tips = vec![0.0; self.nodes.len()];
        for index in (0..self.nodes.len()).rev() {
            if tips[index] == 0.0 {
                tips[index] = 1.0;
            }
            if let Some(parent) = self.nodes[index].parent {
                tips[parent] += tips[index];
            }
        }
        tips.iter().map(|count: &f64| tip * count.sqrt()).collect()
    }

    /// One cylinder from each node's parent to the node.
    ///
    /// Where a limb bends, both cylinders are lengthened to the mitre of their
    /// outer walls, so that no wedge opens between them. The foot flares.
    pub fn wood(&self, file: &'static str, radii: &[f64]) -> Table {
        let mut table = Table::new(file, "x0,y0,z0,x1,y1,z1,radius");
        let mut thickest = vec![None; self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate() {
            if let Some(parent) = node.parent {
                let best: &mut Option<usize> = &mut thickest[parent];
                if best.is_none_or(|other| radii[index] > radii[other]) {
                    *best = Some(index);
                }
            }
        }
        for index in 1..self.nodes.len() {
            let direction = self.direction(index);
            let mitre = |other: usize| {
                let cosine = direction.dot(self.direction(other)).clamp(0.0, 1.0);
                radii[index] * ((1.0 - cosine) / (1.0 + cosine)).sqrt()
            };
            let parent = self.nodes[index].parent.unwrap_or(0);
            let foot = self.nodes[parent].position;
            let before = if parent == 0 { 0.0 } else { mitre(parent) };
            let after = thickest[index].map_or(0.0, mitre);
            let p0 = foot - direction * before;
            let p1 = self.nodes[index].position + direction * after;
            let flare = 1.0 + 0.6 * libm::exp(-foot.z / 0.35);
            let radius = radii[index] * flare;
            table.push(&[
                (p0.x, 3),
                (p0.y, 3),
                (p0.z, 3),
                (p1.x, 3),
                (p1.y, 3),
                (p1.z, 3),
                (radius, 4),
            ]);
        }
        table
    }

    /// The unit vector from a node's parent to the node; up at the foot.
    pub fn direction(&self, index: usize) -> DVec3 {
        self.nodes[index].parent.map_or(DVec3::Z, |parent| {
            (self.nodes[index].position - self.nodes[parent].position).normalize()
        })
    }
}
