//! The operands of a composition: which sheets bound each, and what is inside.

use std::cmp::Ordering;

use cyltrace::solid::AnySolid;
use cyltrace::with_solid;

use super::sheet::Sheet;

/// A kind of solid that set operations compose.
pub(crate) trait TrueOperand {
    /// The sheets that bound it.
    ///
    /// # Panics
    /// When the solid has no inside.
    fn leaf(&self) -> Leaf;
}

/// An operand: a closed solid with an inside.
#[derive(Clone, Debug)]
pub(crate) struct Leaf {
    pub sheets: Vec<Sheet>,
    inside: Inside,
}

/// What is inside, by the signs of the sheets.
#[derive(Clone, Copy, Debug)]
enum Inside {
    /// Within all sheets.
    All,
    /// Within the first or the second sheet, or within all others, if there are any.
    Either,
}

impl Leaf {
    /// # Panics
    /// When the solid is a disk, which has no inside.
    pub fn new(solid: &AnySolid) -> Self {
        with_solid!(solid, solid => solid.leaf())
    }

    /// What is within all sheets.
    pub fn within(sheets: Vec<Sheet>) -> Self {
        Self {
            sheets,
            inside: Inside::All,
        }
    }

    /// What is within the first or the second sheet, or within all others, if there are any.
    pub fn within_either(sheets: Vec<Sheet>) -> Self {
        Self {
            sheets,
            inside: Inside::Either,
        }
    }

    /// Whether points with these signs are inside. `None` where a zero decides.
    pub fn decide(&self, signs: &[Ordering]) -> Option<bool> {
        let within_all = |signs: &[Ordering]| {
            if signs.contains(&Ordering::Greater) {
                Some(false)
            } else if signs.contains(&Ordering::Equal) {
                None
            } else {
                Some(true)
            }
        };
        match self.inside {
            Inside::All => within_all(signs),
            Inside::Either => {
                let (balls, hull) = signs.split_at(2);
                if balls.contains(&Ordering::Less) {
                    return Some(true);
                }
                let hull = if hull.is_empty() {
                    Some(false)
                } else {
                    within_all(hull)
                };
                match hull {
                    Some(false) if balls.contains(&Ordering::Equal) => None,
                    other => other,
                }
            }
        }
    }
}
