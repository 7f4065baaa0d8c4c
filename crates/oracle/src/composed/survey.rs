//! The cells and faces that curves from a point find.

use std::cmp::Ordering;

use cyltrace::solid::Composition;

use super::face::{Face, note};
use super::leaf::Leaf;
use super::ring::{Number, Vector};
use super::sheet::Sheet;

/// A sheet through the point, of a leaf that is not decided there.
pub(super) struct Active<'a> {
    pub sheet: &'a Sheet,
    pub leaf: usize,
    /// Which of the leaf's sheets it is.
    pub index: usize,
    pub gradient: Vector,
}

/// A curve from the point.
pub(super) struct Curve {
    pub v: Vector,
    pub a: Option<Vector>,
}

/// What is known of a cell.
pub(super) struct Cell {
    signs: Vec<Ordering>,
    leaves: Vec<bool>,
    is_inside: bool,
}

/// The point, what is active there, and what was found so far.
pub(super) struct Survey<'a> {
    pub composition: &'a Composition,
    /// The signs of all sheets at the point.
    pub signs: Vec<Vec<Ordering>>,
    pub leaves: &'a [Leaf],
    pub active: Vec<Active<'a>>,
    /// Whether cells outside and inside of the set are known.
    pub found: [bool; 2],
    pub faces: Vec<Face>,
}

impl Survey<'_> {
    /// The cell that a curve runs in; `None` if it runs in a sheet.
    pub fn cell(&self, curve: &Curve) -> Option<Cell> {
        let mut all = self.signs.clone();
        let mut signs = Vec::new();
        for active in &self.active {
            let sign = sign_on(active, curve);
            if sign == Ordering::Equal {
                return None;
            }
            all[active.leaf][active.index] = sign;
            signs.push(sign);
        }
        let leaves = self.leaves.iter().zip(&all);
        let leaves: Option<Vec<bool>> = leaves.map(|(leaf, signs)| leaf.decide(signs)).collect();
        let leaves = leaves?;
        Some(Cell {
            is_inside: is_inside(self.composition, &leaves),
            signs,
            leaves,
        })
    }

    /// Notes the cells of two curves on both sides of some of the active sheets,
    /// which are given by their numbers. `false` if they are not.
    pub fn note(&mut self, pair: [&Curve; 2], across: &[usize]) -> bool {
        let [Some(one), Some(other)] = pair.map(|curve| self.cell(curve)) else {
            return false;
        };
        self.note_cells([&one, &other], across)
    }

    pub fn note_cells(&mut self, [one, other]: [&Cell; 2], across: &[usize]) -> bool {
        let differ = |number: usize| one.signs[number] != other.signs[number];
        if (0..self.active.len()).any(|number| differ(number) != across.contains(&number)) {
            return false;
        }
        for cell in [one, other] {
            self.found[usize::from(cell.is_inside)] = true;
        }
        if one.is_inside == other.is_inside {
            return true;
        }
        for &number in across {
            let active = &self.active[number];
            let Some(part) = active.sheet.part else {
                continue;
            };
            if one.leaves[active.leaf] == other.leaves[active.leaf] {
                continue;
            }
            let face = |part| Face {
                leaf: active.leaf as u32,
                part,
                is_outward: one.leaves[active.leaf] == one.is_inside,
                normal: None,
            };
            note(&mut self.faces, face(part), &active.gradient);
            if active.gradient.is_zero() {
                // The disk or ball of no size at an apex is named as well as the wall.
                let same = self.active.iter().filter(|one| one.leaf == active.leaf);
                for part in same.filter_map(|one| one.sheet.part) {
                    note(&mut self.faces, face(part), &active.gradient);
                }
            }
        }
        true
    }
}

/// The first coefficient's sign.
fn sign_on(active: &Active, curve: &Curve) -> Ordering {
    let (g, form) = (&active.gradient, &active.sheet.form);
    let first = g.dot(&curve.v).sign();
    if first != Ordering::Equal {
        return first;
    }
    let bent = form.image_of(&curve.v);
    let second = bent.dot(&curve.v);
    let Some(a) = &curve.a else {
        return second.sign();
    };
    let coefficients: [&dyn Fn() -> Number; 3] = [
        &|| second.plus(&g.dot(a).plus(&g.dot(a))),
        &|| bent.dot(a),
        &|| form.of(a, a),
    ];
    let mut signs = coefficients.iter().map(|one| one().sign());
    signs
        .find(|sign| *sign != Ordering::Equal)
        .unwrap_or(Ordering::Equal)
}

/// What the operations say where each leaf is inside or not.
pub(super) fn is_inside(composition: &Composition, leaves: &[bool]) -> bool {
    fn walk(composition: &Composition, leaves: &mut std::slice::Iter<bool>) -> bool {
        let parts = |parts: &[Composition], leaves: &mut std::slice::Iter<bool>| {
            let parts = parts.iter().map(|part| walk(part, leaves));
            parts.collect::<Vec<bool>>()
        };
        match composition {
            Composition::Solid(_) => leaves.next().copied().unwrap_or(false),
            Composition::Union(all) => parts(all, leaves).contains(&true),
            Composition::Intersection(all) => {
                !all.is_empty() && !parts(all, leaves).contains(&false)
            }
            Composition::Difference(all) => match parts(all, leaves).split_first() {
                Some((first, others)) => *first && !others.contains(&true),
                None => false,
            },
        }
    }
    walk(composition, &mut leaves.iter())
}
