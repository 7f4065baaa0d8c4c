//! Embree's own instances: which placements use them, and the displacement of the f32 ray in
//! the child.
//!
//! Embree maps its f32 ray into the child in f32, and the child's boxes grow by the
//! displacement of that ray. Let `L` be the matrix from the child's frame to the parent's, G
//! its inverse, P the image of the child's center under L, `g` and `l` the greatest rows of G
//! and L, R the radius of the parent's frame, r that of the child's, v = 2^-24. A point c of
//! the ray in the child's sphere corresponds to q = L c + P, which is within R of the parent's
//! center and within `l r √3` of P. Displacements of c along an axis, of the first order:
//!
//! | source | in units of `v g R` |
//! |---|---|
//! | the parent's ray: origin and direction rounded to f32 | 1 + 2 |
//! | P rounded | 1 |
//! | `G P`: three products and sums | 3 |
//! | the origin: products and sums, 4 for `G s` and 3 for `G P` | 7 |
//! | the direction: 3, over a length of 2 R | 6 |
//! | the slab test in the child, whose rays start up to 2 `g R` away | 14.5 |
//! | packets as a whole: two products and a difference | 4, and r |
//! | **sum** | **38.5** |
//!
//! The filter of a block needs more (`tracer::filter`): the distance between the two rays, √3
//! times the rows above that of the slab test, 35, and 20 v times the distance of the ray's
//! origin, at most 2 √3 g R, 70. So boxes grow by 105 v g R.
//!
//! The computed inverse Ĝ maps origin, direction and P, so its error acts on q - P alone.
//! `adj L / det L` is off by `2 v` of the products in each cofactor and `6 v` of those in the
//! determinant, and rounding L to f32 by `v` of its condition:
//!
//! ```text
//! |ΔG| <= v (2 |adj| / |det| + (6 perm / |det| + 2 + κ) g)
//! ```
//!
//! where |adj| and perm are the cofactors and the determinant with all terms positive.
//!
//! Embree computes an instance's box in the parent from the eight corners of the child's scene,
//! off by `5 v (l r √3 + R)` along an axis, and tests it like any other box, for which the
//! parent needs 22 v R (`docs/derivations.md`, section 4). The image of a child's box that is
//! grown by γ is grown by the sum of a row of |L| times γ, so both are divided by that sum.
//!
//! The roundings of f64 are added: the ray in the child is not quite the image of the parent's
//! (`PlacementMargin`), and P is computed from numbers of the parent's size. Through an opened
//! prototype (`opened`), L comes from the product of two matrices M N, whose terms are off by 3
//! u of |M| |N|. With the product by the center, 3 u, the translation M t + s, 4 u, and two
//! sums, P and the image of the child's sphere are off by less than 12 u of the sizes. A
//! displacement in the opened prototype is multiplied in the parent by at most the norm of M.
//!
//! The sum is of the first order. The second order is below 2^-9 of it if the share is below
//! [`GREATEST_GROWTH`]; a factor of 1 + 2^-4 covers it.

use glam::{DAffine3, DMat3, DVec3};

use super::placement_margin::PlacementMargin;
use crate::math::UNIT_ROUNDOFF;
use crate::scene::Placement;
use crate::tracer::frame::Frame;

/// Half an ulp of f32, relative to 1.
const V: f64 = 1.0 / (1 << 24) as f64;

/// The greatest share of a child's radius by which its boxes may grow for instances of it. At
/// 2^-13 the cost is not measurable; at 2^-11 the trees of a forest take 12 % longer, more than
/// instances save.
const GREATEST_GROWTH: f64 = 1.0 / (1 << 12) as f64;

/// The greatest number of placements of a prototype with instances: Embree takes about 380
/// bytes for each, and 90 for a primitive. Among many placements each is small in its parent,
/// so few could be instances.
pub(crate) const MOST_INSTANCES: usize = 1 << 12;

/// The map from a child's space to its parent's, through one or two placements.
pub(super) struct Image {
    affine: DAffine3,
    /// The matrix with all products positive, and the sum of the sizes of the translation's
    /// terms.
    size: DMat3,
    shift_size: f64,
    /// The displacement of the child's hits by f64 roundings, in the parent.
    displacement: f64,
}

impl Image {
    /// The map of a placement; `placement_margin` is the parent's.
    pub fn new(placement_margin: &PlacementMargin, placement: &Placement) -> Self {
        let affine = placement.parent_from_child;
        Self {
            affine,
            size: affine.matrix3.abs(),
            shift_size: affine.translation.length(),
            displacement: placement_margin.slack(placement),
        }
    }

    /// The map of a placement in the opened prototype that this one places; `inner_margin` is
    /// the opened prototype's.
    pub fn through(self, inner_margin: &PlacementMargin, inner: &Placement) -> Self {
        let inner = Self::new(inner_margin, inner);
        // The Frobenius norm, at least the greatest stretch.
        let terms = self.affine.matrix3.to_cols_array();
        let stretch = terms.iter().map(|x| x * x).sum::<f64>().sqrt();
        Self {
            affine: self.affine * inner.affine,
            size: self.size * inner.size,
            shift_size: self.shift_size + stretch * inner.shift_size,
            displacement: self.displacement + stretch * inner.displacement,
        }
    }
}

/// The relation of a child's frame to its parent's.
struct Relation {
    /// L.
    matrix: DMat3,
    /// P.
    center: DVec3,
    /// The error bound of P, and of L times the points of the child's sphere.
    center_error: f64,
}

impl Relation {
    fn new(parent: &Frame, image: &Image, child: &Frame) -> Self {
        let (matrix, translation) = (image.affine.matrix3, image.affine.translation);
        let turned = matrix * child.center();
        let radius = child.radius() / child.scale();
        let sizes = (image.size * (child.center().abs() + radius)).length()
            + image.shift_size
            + parent.center().length();
        Self {
            matrix: matrix * (parent.scale() / child.scale()),
            center: (turned + translation - parent.center()) * parent.scale(),
            center_error: 12.0 * UNIT_ROUNDOFF * sizes * parent.scale(),
        }
    }
}

/// The map from the child's frame to its parent's, for Embree.
pub(super) fn instance_map(parent: &Frame, image: &Image, child: &Frame) -> [[f32; 4]; 3] {
    let Relation { matrix, center, .. } = Relation::new(parent, image, child);
    std::array::from_fn(|axis| {
        let row = matrix.row(axis);
        [row.x, row.y, row.z, center[axis]].map(|x| x as f32)
    })
}

/// The share of the child's radius by which its boxes have to grow for an instance of it here.
/// `None` if that is too much.
pub(super) fn needed_growth(parent: &Frame, image: &Image, child: &Frame) -> Option<f64> {
    let share = displacement(parent, image, child);
    // Written so that NaN is too much.
    (share <= GREATEST_GROWTH).then_some(share)
}

/// The bound derived at the head of this file, as a share of the child's radius.
fn displacement(parent: &Frame, image: &Image, child: &Frame) -> f64 {
    let relation = Relation::new(parent, image, child);
    let (matrix, inverse) = (relation.matrix, relation.matrix.inverse());
    let (g, l) = (greatest_row(&inverse), greatest_row(&matrix));
    let (radius, own) = (parent.radius(), child.radius());
    // The displacement by f64, in the parent's frame.
    let wide = image.displacement * parent.scale() + relation.center_error;

    let size = matrix.abs();
    let (x, y, z) = (size.x_axis, size.y_axis, size.z_axis);
    let cofactors = DMat3::from_cols(across(y, z), across(z, x), across(x, y));
    let determinant = matrix.determinant().abs();
    let permanent = x.dot(cofactors.x_axis);
    // The cofactors of columns are the rows of the inverse.
    let cofactors = (cofactors.x_axis.length())
        .max(cofactors.y_axis.length())
        .max(cofactors.z_axis.length());
    let condition = 3.0 * l * g;
    let inverse_error =
        V * (2.0 * cofactors / determinant + (6.0 * permanent / determinant + 2.0 + condition) * g);

    let image = 3_f64.sqrt() * l * own;
    // Distances, √3 times the displacement along an axis.
    let rest = 3_f64.sqrt() * inverse_error * image + 3.0 * g * wide;
    let in_child = V * (105.0 * g * radius + own) + rest;
    let thinnest = (size * DVec3::ONE).min_element();
    let in_parent = (V * (27.0 * radius + 5.0 * image) + wide) / thinnest;

    in_child.max(in_parent) * (1.0 + 1.0 / 16.0) / own
}

/// The length of the longest row.
fn greatest_row(matrix: &DMat3) -> f64 {
    (0..3).fold(0.0, |most, axis| matrix.row(axis).length().max(most))
}

/// A cross product with all terms positive.
fn across(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(
        a.y * b.z + a.z * b.y,
        a.z * b.x + a.x * b.z,
        a.x * b.y + a.y * b.x,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Bounds, Random, power_of_two_below};
    use crate::scene::PrototypeIndex;

    /// `a b + c` as Embree computes it: with one rounding, or with two.
    fn multiply_add(fused: bool, a: f32, b: f32, c: f32) -> f32 {
        if fused {
            // The product is exact in f64.
            (f64::from(a) * f64::from(b) + f64::from(c)) as f32
        } else {
            a * b + c
        }
    }

    /// Embree's inverse of a map: columns of the matrix, and the shift.
    fn inverse_of(fused: bool, map: &[[f32; 4]; 3]) -> [[f32; 3]; 4] {
        let column = |i: usize| [map[0][i], map[1][i], map[2][i]];
        let [x, y, z, shift] = [0, 1, 2, 3].map(column);
        let cross = |a: [f32; 3], b: [f32; 3]| {
            [(1, 2), (2, 0), (0, 1)].map(|(i, j)| multiply_add(fused, a[i], b[j], -(a[j] * b[i])))
        };
        let rows = [cross(y, z), cross(z, x), cross(x, y)];
        let determinant = x[0] * rows[0][0] + x[1] * rows[0][1] + x[2] * rows[0][2];
        let columns = [0, 1, 2].map(|i| [0, 1, 2].map(|j: usize| rows[j][i] / determinant));
        let [x, y, z] = columns;
        let shifted = mapped(fused, &[x, y, z, [0.0; 3]], shift);
        [x, y, z, shifted.map(|x| -x)]
    }

    fn mapped(fused: bool, [x, y, z, shift]: &[[f32; 3]; 4], p: [f32; 3]) -> [f32; 3] {
        [0, 1, 2].map(|i| {
            let last = multiply_add(fused, p[2], z[i], shift[i]);
            multiply_add(fused, p[0], x[i], multiply_add(fused, p[1], y[i], last))
        })
    }

    fn random_box(random: &mut Random, size: f64) -> Bounds {
        let mut side = || random.log_uniform(0.01, 1.0) * size;
        let half = DVec3::new(side(), side(), side());
        let center = random.direction() * random.uniform(0.0, 10.0) * size;
        Bounds {
            lower: center - half,
            upper: center + half,
        }
    }

    /// No ray is off by more than the bound, which is not twenty times too large. Two thirds of
    /// the bound are for the roundings of filters, which are not computed here.
    #[test]
    fn rays_mapped_in_f32_are_off_by_less_than_the_bound() {
        let most = most_used(false);
        assert!(most > 0.05, "{most}");
        // Two placements displace less than the sum of the bounds of each.
        let most = most_used(true);
        assert!(most > 0.03, "{most} through two placements");
    }

    /// The greatest share of the bound by which a ray is off, in instances through one
    /// placement or two.
    fn most_used(is_opened: bool) -> f64 {
        let mut random = Random::new(97, u64::from(is_opened));
        let (mut cases, mut most) = (0, 0.0_f64);
        while cases < 20_000 {
            let in_child = random_box(&mut random, 1.0);
            let placement = random_placement(&mut random, 0.03);
            let (mut placement_margin, mut reach) = placed(&mut random, &placement, &in_child);
            let mut image = Image::new(&placement_margin, &placement);
            let mut map = placement.parent_from_child;
            if is_opened {
                let outer = random_placement(&mut random, 0.3);
                let inner_margin = placement_margin;
                (placement_margin, reach) = placed(&mut random, &outer, &reach);
                image = Image::new(&placement_margin, &outer).through(&inner_margin, &placement);
                map = outer.parent_from_child * map;
            }
            let (parent, child) = (Frame::new(&reach), Frame::new(&in_child));
            let share = displacement(&parent, &image, &child);
            if !(share <= GREATEST_GROWTH) {
                continue;
            }
            cases += 1;
            let c = random.direction() * (child.radius() * random.unit());
            let q = parent.place(map.transform_point3(child.center() + c / child.scale()));
            let map = instance_map(&parent, &image, &child);
            let heading = random.direction();
            let heading = heading / power_of_two_below(heading.abs().max_element());
            // Moves back to the sphere.
            let (along, square) = (q.dot(heading), heading.length_squared());
            let inside = parent.radius() * parent.radius() - q.length_squared();
            let length = (along + (along * along + square * inside.max(0.0)).sqrt()) / square;
            let start = (q - heading * length).to_array().map(|x| x as f32);
            let heading = heading.to_array().map(|x| x as f32);
            for fused in [false, true] {
                let inverse = inverse_of(fused, &map);
                let [x, y, z, _] = inverse;
                let from = mapped(fused, &inverse, start);
                let along = mapped(fused, &[x, y, z, [0.0; 3]], heading);
                let vector = |a: [f32; 3]| DVec3::from_array(a.map(f64::from));
                let off = vector(from) + vector(along) * length - c;
                let used = off.abs().max_element() / (share * child.radius());
                assert!(used < 1.0, "case {cases}, fused {fused}: {used}");
                most = most.max(used);
            }
        }
        most
    }

    fn random_placement(random: &mut Random, least: f64) -> Placement {
        let mut stretch = || random.log_uniform(least, 1.0);
        let stretch = DVec3::new(stretch(), stretch(), stretch());
        let (turn, back) = (turned(random), turned(random));
        Placement {
            of: PrototypeIndex(1),
            parent_from_child: DAffine3::from_mat3_translation(
                turn * DMat3::from_diagonal(stretch) * back,
                random.direction() * 10.0,
            ),
        }
    }

    /// The margin and the reach of a prototype with a placement and something else.
    fn placed(
        random: &mut Random,
        placement: &Placement,
        child: &Bounds,
    ) -> (PlacementMargin, Bounds) {
        let image = child.transformed(&placement.parent_from_child);
        let size = random.log_uniform(0.1, 1e3);
        let bounds = image.union(&random_box(random, size));
        let placement_margin = PlacementMargin::new(&bounds, rayon::iter::once(placement));
        (
            placement_margin,
            bounds.union(&placement_margin.placement_reach(placement, child)),
        )
    }

    fn turned(random: &mut Random) -> DMat3 {
        let x = random.direction();
        let y = x.cross(random.direction()).normalize();
        DMat3::from_cols(x, y, x.cross(y))
    }
}
