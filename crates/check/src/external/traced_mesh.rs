//! A mesh from a file, traced in f64.
//!
//! The triangles are in a bounding volume hierarchy of our own, because Embree stores f32: there
//! a single far vertex would make every hit uncertain. In f64 a hit is off by some 2^-50 of the
//! distances from the ray's origin to the triangle, whatever else is in the file. So a correct
//! mesh is off by its deviation and by the rounding of coordinates in its format.
//!
//! A box is split at the median of the centers of its triangles, along the longest side of
//! the box of those centers, so the depth of the tree is the logarithm of the number of triangles.

use glam::DVec3;
use rayon::join;
use rayon::prelude::*;

use super::triangle::ShearedRay;
use cyltrace::math::{Bounds, Ray};
use cyltrace::solid::tessellation::Mesh;

/// Most triangles of a leaf.
const LEAF: usize = 4;
/// The fewest triangles that are worth a task.
const WORTH_A_THREAD: usize = 4096;
/// The relative error of a box's planes along a ray: three roundings.
const BOX_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A mesh for tracing rays.
pub struct TracedMesh {
    vertices: Vec<DVec3>,
    /// In the order of the leaves, with their numbers in the file.
    triangles: Vec<([u32; 3], u32)>,
    root: Node,
}

/// A box of the tree, with its content.
struct Node {
    bounds: Bounds,
    content: Content,
}

enum Content {
    /// Those triangles from the first number up to the second.
    Leaf(usize, usize),
    Inner(Box<[Node; 2]>),
}

/// A hit of a ray with a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// The ray's parameter.
    pub t: f64,
    /// The triangle's unit normal, on the side of its winding; zero for a
    /// triangle without area.
    pub normal: DVec3,
    /// The triangle's number.
    pub triangle: u32,
}

impl TracedMesh {
    /// The tree of a mesh, built in the rayon pool that this is called in.
    ///
    /// # Panics
    /// If a triangle names a vertex that does not exist.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        let corners = mesh.triangles.par_iter().copied().enumerate();
        let items = corners.map(|(number, corners)| Item {
            middle: bounds_of(&mesh.vertices, corners).center(),
            number: number as u32,
        });
        let mut items: Vec<Item> = items.collect();
        let root = node(mesh, &mut items, 0);
        let ordered = items.par_iter().map(|item| item.number);
        let ordered = ordered.map(|number| (mesh.triangles[number as usize], number));
        Self {
            vertices: mesh.vertices.clone(),
            triangles: ordered.collect(),
            root,
        }
    }

    /// The first hit of a ray; at the same `t`, that of the first triangle.
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<TriangleHit> {
        let ray = ShearedRay::new(ray)?;
        let mut best: Option<(f64, u32, [u32; 3])> = None;
        let mut waiting = vec![&self.root];
        while let Some(node) = waiting.pop() {
            let end = best.map_or(ray.range.1, |(t, _, _)| t);
            let Some(_) = entry(&node.bounds, &ray, end) else {
                continue;
            };
            match &node.content {
                Content::Leaf(from, to) => {
                    for &(corners, number) in &self.triangles[*from..*to] {
                        let points = corners.map(|corner| self.vertices[corner as usize]);
                        let Some(t) = ray.hit(points) else {
                            continue;
                        };
                        let is_in_range = ray.range.0 <= t && t <= ray.range.1;
                        let is_first = best.is_none_or(|(least, first, _)| {
                            t < least || (t == least && number < first)
                        });
                        if is_in_range && is_first {
                            best = Some((t, number, corners));
                        }
                    }
                }
                Content::Inner(children) => {
                    let [one, other] = &**children;
                    let entries = [one, other].map(|child| entry(&child.bounds, &ray, end));
                    // The nearer one is popped first.
                    match entries[0] <= entries[1] {
                        true => waiting.extend([other, one]),
                        false => waiting.extend([one, other]),
                    }
                }
            }
        }
        let (t, triangle, corners) = best?;
        let [a, b, c] = corners.map(|corner| self.vertices[corner as usize]);
        Some(TriangleHit {
            t: ray.t(t),
            normal: (b - a).cross(c - a).normalize_or_zero(),
            triangle,
        })
    }
}

/// The parameter at which a ray enters a box before `end`.
fn entry(bounds: &Bounds, ray: &ShearedRay, end: f64) -> Option<f64> {
    let (mut near, mut far) = (ray.range.0, end);
    for axis in 0..3 {
        let (lower, upper) = (bounds.lower[axis], bounds.upper[axis]);
        let inverse = 1.0 / ray.direction[axis];
        if inverse.is_infinite() {
            // Along the planes.
            if !(lower..=upper).contains(&ray.origin[axis]) {
                return None;
            }
            continue;
        }
        let one = (lower - ray.origin[axis]) * inverse;
        let other = (upper - ray.origin[axis]) * inverse;
        let (enters, leaves) = (one.min(other), one.max(other));
        near = near.max(enters - BOX_ROUNDING * enters.abs());
        far = far.min(leaves + BOX_ROUNDING * leaves.abs());
    }
    (near <= far).then_some(near)
}

/// A triangle while the tree is built.
struct Item {
    /// The center of its box.
    middle: DVec3,
    number: u32,
}

/// The box of a triangle.
fn bounds_of(vertices: &[DVec3], corners: [u32; 3]) -> Bounds {
    let [a, b, c] = corners.map(|corner| Bounds::at(vertices[corner as usize]));
    a.union(&b).union(&c)
}

/// The tree of some triangles of a mesh, which are sorted into its order. `first` is the
/// position of their first one in the whole mesh.
fn node(mesh: &Mesh, items: &mut [Item], first: usize) -> Node {
    let count = items.len();
    if count <= LEAF {
        let corners = items
            .iter()
            .map(|item| mesh.triangles[item.number as usize]);
        let bounds = corners.fold(Bounds::EMPTY, |all, corners| {
            all.union(&bounds_of(&mesh.vertices, corners))
        });
        let content = Content::Leaf(first, first + count);
        return Node { bounds, content };
    }
    let middles = items.iter().fold(Bounds::EMPTY, |all, item| {
        all.union(&Bounds::at(item.middle))
    });
    let axis = middles.extent().max_position();
    items.select_nth_unstable_by(count / 2, |one, other| {
        let order = one.middle[axis].total_cmp(&other.middle[axis]);
        order.then(one.number.cmp(&other.number))
    });
    let (left, right) = items.split_at_mut(count / 2);
    let right_first = first + left.len();
    let mut build_left = || node(mesh, left, first);
    let mut build_right = || node(mesh, right, right_first);
    let (one, other) = match count >= WORTH_A_THREAD {
        true => join(build_left, build_right),
        false => (build_left(), build_right()),
    };
    let bounds = one.bounds.union(&other.bounds);
    let content = Content::Inner(Box::new([one, other]));
    Node { bounds, content }
}
