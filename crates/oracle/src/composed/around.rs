//! The neighbourhood of a point: which open cells are around it, and which pieces of
//! surface have the set on one side only.
//!
//! Where no sheet of a leaf decides at the point, the leaf contains all of a small
//! ball around it or nothing. The other leaves have *active* sheets, through the
//! point. A cell is found by a *witness*: a curve `p + s v + s² a` for small positive
//! `s`, on which the sign of a sheet is that of the first coefficient that is not zero,
//!
//! ```text
//! 2 g·v,   2 g·a + v·M v,   2 v·M a,   a·M a
//! ```
//!
//! in exact numbers. Witnesses come in pairs on the two sides of one sheet, or of
//! several that coincide there; `smooth.rs`, `edge.rs` and `apex.rs` choose them. That a pair is
//! one is verified by its signs: they differ in these sheets only. So every cell and
//! every face that is reported exists for any choice of witnesses. That none is left out rests
//! on the choice: each cell around the point is bounded by a sheet, and each piece of a
//! sheet that others cut out has a pair.

use std::cmp::Ordering;

use cyltrace::solid::{Composition, Location};

use super::face::{Face, note};
use super::leaf::Leaf;
use super::place::Place;
use super::ring::{Number, Vector};
use super::sheet::Sheet;
use super::{apex, smooth};

/// What is around a point.
#[derive(Clone, Debug)]
pub(super) struct Around {
    pub location: Location,
    pub faces: Vec<Face>,
}

/// A sheet through the point, of a leaf that is not decided there.
pub(super) struct Active<'a> {
    pub sheet: &'a Sheet,
    pub leaf: usize,
    /// Which of the leaf's sheets it is.
    index: usize,
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
    composition: &'a Composition,
    signs: Vec<Vec<Ordering>>,
    leaves: &'a [Leaf],
    pub active: Vec<Active<'a>>,
    found: [bool; 2],
    faces: Vec<Face>,
}

impl Around {
    pub fn of(composition: &Composition, leaves: &[Leaf], place: &Place) -> Self {
        let sign_of = |sheet: &Sheet| sheet.value(place).sign();
        let signs: Vec<Vec<Ordering>> = leaves
            .iter()
            .map(|leaf| leaf.sheets.iter().map(sign_of).collect())
            .collect();
        Self::with_signs(composition, leaves, signs, place)
    }

    /// The same, with the signs of all sheets at the point.
    pub fn with_signs(
        composition: &Composition,
        leaves: &[Leaf],
        signs: Vec<Vec<Ordering>>,
        place: &Place,
    ) -> Self {
        let decided: Vec<Option<bool>> = leaves
            .iter()
            .zip(&signs)
            .map(|(leaf, signs)| leaf.decide(signs))
            .collect();
        if let Some(decided) = decided.iter().copied().collect::<Option<Vec<bool>>>() {
            let location = match is_inside(composition, &decided) {
                true => Location::Inside,
                false => Location::Outside,
            };
            return Self {
                location,
                faces: Vec::new(),
            };
        }
        let mut active = Vec::new();
        for (number, leaf) in leaves.iter().enumerate() {
            if decided[number].is_some() {
                continue;
            }
            for (index, sheet) in leaf.sheets.iter().enumerate() {
                if signs[number][index] == Ordering::Equal {
                    active.push(Active {
                        sheet,
                        leaf: number,
                        index,
                        gradient: sheet.gradient(place),
                    });
                }
            }
        }
        let mut survey = Survey {
            composition,
            signs,
            leaves,
            active,
            found: [false; 2],
            faces: Vec::new(),
        };
        smooth::survey(&mut survey);
        apex::survey(&mut survey);
        Self {
            location: match survey.found {
                [false, true] => Location::Inside,
                [_, false] => Location::Outside,
                [true, true] => Location::Boundary,
            },
            faces: survey.faces,
        }
    }
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
fn is_inside(composition: &Composition, leaves: &[bool]) -> bool {
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
