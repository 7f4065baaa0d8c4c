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

use super::face::Face;
use super::leaf::Leaf;
use super::place::Place;
use super::sheet::Sheet;
use super::survey::{Active, Survey, is_inside};
use super::{apex, smooth};

/// What is around a point.
#[derive(Clone, Debug)]
pub(super) struct Around {
    pub location: Location,
    pub faces: Vec<Face>,
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
