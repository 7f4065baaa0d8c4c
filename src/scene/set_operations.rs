//! Set operations: the keys of their tables, and the tree of solids that they state.

use glam::DVec3;
use serde::Deserialize;
use toml::Spanned;

use super::error::SceneError;
use super::pose::{self, Motion};
use super::solid_keys::{SolidTable, solid_table};
use super::solids::{SceneSolid, SolidKeys};
use super::source::Source;
use super::values::Keys;
use crate::for_each_solid;
use crate::solid::{AnySolid, Composition, SolidKind};

solid_table! {
    /// `[[union]]`, `[[intersection]]`, `[[difference]]`
    CompositionKeys {
        of: Operands,
    }
}

/// The operands of a set operation.
pub(super) type Operands = Spanned<Vec<Spanned<Keys<OperandKeys>>>>;

impl CompositionKeys {
    pub fn of(&self) -> &Operands {
        &self.of
    }
}

macro_rules! operand_keys {
    ($({ $type:ident $name:ident $($rest:tt)* })*) => {
        /// An operand of a set operation: exactly one of these keys.
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct OperandKeys {
            $($name: Option<Spanned<Keys<<crate::solid::$type as SceneSolid>::Keys>>>,)*
            pub union: Option<Keys<CompositionKeys>>,
            pub intersection: Option<Keys<CompositionKeys>>,
            pub difference: Option<Keys<CompositionKeys>>,
        }

        impl OperandKeys {
            /// The solids among the keys, each with its place.
            pub fn solids(&self) -> impl Iterator<Item = Spanned<&dyn SolidKeys>> {
                let all = [$(self.$name.as_ref().map(|stated| {
                    let Keys(keys) = stated.get_ref();
                    Spanned::new(stated.span(), keys as &dyn SolidKeys)
                })),*];
                all.into_iter().flatten()
            }
        }
    };
}

for_each_solid!(operand_keys);

/// The set operation of a table.
#[derive(Clone, Copy)]
pub(super) enum Operation {
    Union,
    Intersection,
    Difference,
}

impl Operation {
    /// The kind of its solids.
    pub fn kind(self) -> SolidKind {
        match self {
            Self::Union => SolidKind::Union,
            Self::Intersection => SolidKind::Intersection,
            Self::Difference => SolidKind::Difference,
        }
    }

    /// The solid of a table of this operation.
    pub fn of(self, source: &Source, keys: &CompositionKeys) -> Result<Composition, SceneError> {
        let operands = keys.of().get_ref().iter();
        let operands = operands.map(|keys| operand(source, keys));
        let mut operands = operands.collect::<Result<Vec<_>, _>>()?;
        // The operands live as long as the scene.
        operands.shrink_to_fit();
        if operands.is_empty() {
            return Err(source.error_with_help(
                keys.of().span(),
                "of is empty: a set operation needs at least one solid",
                "of = [{ cuboid = { half_widths = [1, 1, 1] } }, { sphere = { center = [1, 0, 0], radius = 1 } }]",
            ));
        }
        let unmoved = match self {
            Self::Union => Composition::Union(operands),
            Self::Intersection => Composition::Intersection(operands),
            Self::Difference => Composition::Difference(operands),
        };
        // An operation has an operand, so it has a first solid.
        let center = unmoved
            .solids()
            .first()
            .map_or(DVec3::ZERO, AnySolid::center);
        Motion::new(source, &keys.pose(), keys.of().span())?.of_composition(unmoved, center)
    }
}

/// The number of operands of a set operation, including those of nested operations.
pub(super) fn operand_count(keys: &CompositionKeys) -> u64 {
    let of_operand = |operand: &OperandKeys| -> u64 {
        let nested = [&operand.union, &operand.intersection, &operand.difference];
        let nested = nested.into_iter().flatten();
        1 + nested.map(|Keys(keys)| operand_count(keys)).sum::<u64>()
    };
    let operands = keys.of().get_ref().iter().map(Spanned::get_ref);
    operands.map(|Keys(keys)| of_operand(keys)).sum()
}

/// Reads an operand: a solid or another set operation.
fn operand(source: &Source, keys: &Spanned<Keys<OperandKeys>>) -> Result<Composition, SceneError> {
    let place = keys.span();
    let Keys(keys) = keys.get_ref();
    let nested = [
        (Operation::Union, &keys.union),
        (Operation::Intersection, &keys.intersection),
        (Operation::Difference, &keys.difference),
    ];
    let nested = nested
        .into_iter()
        .filter_map(|(operation, keys)| keys.as_ref().map(|Keys(keys)| (operation, keys)));
    let stated: Vec<_> = keys
        .solids()
        .map(Stated::Solid)
        .chain(nested.map(|(operation, keys)| Stated::Nested(operation, keys)))
        .collect();
    let [stated] = stated.as_slice() else {
        // A disk has no inside.
        let kinds = SolidKind::all().filter(|&kind| kind != SolidKind::Disk);
        let names: Vec<&str> = kinds.map(SolidKind::name).collect();
        return Err(source.error_with_help(
            place,
            format!(
                "an operand must be one solid, but this has {}",
                stated.len()
            ),
            format!(
                "write {{ cylinder = {{ ... }} }} or another of {}, each in its own braces",
                names.join(", ")
            ),
        ));
    };
    match stated {
        Stated::Solid(keys) => closed(source, keys),
        Stated::Nested(operation, keys) => {
            check_part(source, *keys)?;
            operation.of(source, keys)
        }
    }
}

/// The content of an operand.
enum Stated<'a> {
    Solid(Spanned<&'a dyn SolidKeys>),
    Nested(Operation, &'a CompositionKeys),
}

/// Reads a solid, which must have an inside.
fn closed(source: &Source, stated: &Spanned<&dyn SolidKeys>) -> Result<Composition, SceneError> {
    let keys = *stated.get_ref();
    check_part(source, keys)?;
    let solid = pose::solid(source, keys)?;
    if solid.is_closed() {
        return Ok(Composition::Solid(solid));
    }
    Err(match keys.caps_place() {
        Some(caps) => source.error(
            caps,
            "a solid in a set operation must be closed: caps must be \"both\"",
        ),
        None => source.error(
            stated.span(),
            format!(
                "a {} has no inside: it cannot be part of a set operation",
                solid.kind()
            ),
        ),
    })
}

/// Checks that a part of a set operation has no material, number or values of its own.
fn check_part<T: SolidTable + ?Sized>(source: &Source, keys: &T) -> Result<(), SceneError> {
    let wrong = |place, what| {
        let message =
            format!("a set operation has one {what}: set it next to the key of, not in a part");
        Err(source.error(place, message))
    };
    match (keys.material(), keys.primitive(), keys.values()) {
        (None, None, None) => Ok(()),
        (Some(material), ..) => wrong(material.span(), "material"),
        (None, Some(primitive), _) => wrong(primitive.span(), "primitive number"),
        (None, None, Some(values)) => wrong(values.span(), "value of a column"),
    }
}
