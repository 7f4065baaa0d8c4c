//! The families of all kinds of solids under one roof.
//!
//! Those of cylinders keep their names; that of another solid begins with its kind,
//! as in `cone-rim`.

use std::fmt::Debug;
use std::str::FromStr;

use super::{Inputs, Problem, UnknownFamily, family_named};
use cyltrace::for_each_solid;
use cyltrace::math::Ray;
use cyltrace::solid::{AnySolid, ConvexSolid, SolidKind};

/// A solid and a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// The solid.
    pub solid: AnySolid,
    /// The ray.
    pub ray: Ray,
}

impl From<Problem> for Case {
    fn from(Problem { cylinder, ray }: Problem) -> Self {
        Self {
            solid: cylinder.into(),
            ray,
        }
    }
}

/// A kind of solid with families of hard cases.
pub trait HardCases: ConvexSolid + Into<AnySolid> {
    /// The families.
    type Family: Copy + Debug + 'static;

    /// All of them, in the order of tables.
    const FAMILIES: &'static [Self::Family];

    /// The name of a family: that of the kind and its own.
    #[must_use]
    fn family_name(family: Self::Family) -> String {
        let kind = Self::KIND.name().replace('_', "-");
        format!("{kind}{}", with_hyphens(&format!("{family:?}")))
    }

    /// Draw `index`, below 2^38, of a family; the same for the same arguments. `None` where
    /// the numbers round to no case, which fewer than one in ten do.
    fn draw(family: Self::Family, seed: u64, index: u64, inputs: Inputs) -> Option<(Self, Ray)>;
}

/// The first draw that is a case: some round to none.
fn case_of<S: HardCases>(family: S::Family, seed: u64, index: u64, inputs: Inputs) -> Case {
    let drawn = (0..64).find_map(|again| S::draw(family, seed, index | again << 32, inputs));
    let (solid, ray) = drawn.expect("more than nine in ten draws are cases");
    Case {
        solid: solid.into(),
        ray,
    }
}

macro_rules! any_family {
    ($({ $type:ident $name:ident $list:ident $($rest:tt)* })*) => {
        /// A family of cases of some kind of solid.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum AnyFamily {
            $(
                #[doc = concat!("Of ", stringify!($list), ".")]
                $type(<cyltrace::solid::$type as HardCases>::Family),
            )*
        }

        impl AnyFamily {
            /// All families, in the order of tables.
            #[must_use]
            pub fn all() -> Vec<Self> {
                let mut all = Vec::new();
                $(all.extend(cyltrace::solid::$type::FAMILIES.iter().copied().map(Self::$type));)*
                all.sort_by_key(|family| family.kind().code());
                all
            }

            /// The kind of its solids.
            #[must_use]
            pub fn kind(self) -> SolidKind {
                match self {
                    $(Self::$type(_) => SolidKind::$type,)*
                }
            }

            /// The name on the command line and in tables.
            #[must_use]
            pub fn name(self) -> String {
                match self {
                    $(Self::$type(family) => cyltrace::solid::$type::family_name(family),)*
                }
            }

            /// Case `index`, below 2^32, of the family; the same for the same arguments.
            ///
            /// # Panics
            /// When none of many draws is a solid and a ray, which no family does.
            #[must_use]
            pub fn case(self, seed: u64, index: u64, inputs: Inputs) -> Case {
                match self {
                    $(Self::$type(family) => case_of::<cyltrace::solid::$type>(family, seed, index, inputs),)*
                }
            }
        }
    };
}

for_each_solid!(any_family);

/// `-exact-rim` of `ExactRim`.
pub(super) fn with_hyphens(name: &str) -> String {
    let mut hyphened = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() {
            hyphened.push('-');
        }
        hyphened.extend(letter.to_lowercase());
    }
    hyphened
}

impl FromStr for AnyFamily {
    type Err = UnknownFamily;

    fn from_str(name: &str) -> Result<Self, UnknownFamily> {
        family_named(name, Self::all(), Self::name)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn names_are_distinct_and_read_back() {
        let all = AnyFamily::all();
        let names: HashSet<String> = all.iter().map(|family| family.name()).collect();
        assert_eq!(names.len(), all.len());
        for family in all {
            assert_eq!(family.name().parse(), Ok(family));
        }
        for name in [
            "nominal",
            "cone-rim",
            "rounded-cone-through-apex",
            "cuboid-edge",
        ] {
            assert!(names.contains(name), "{name}: {names:?}");
        }
    }

    #[test]
    fn every_index_of_every_family_is_a_case_of_its_kind() {
        for family in AnyFamily::all() {
            for inputs in Inputs::ALL {
                let cases: Vec<Case> = (0..200)
                    .map(|index| family.case(3, index, inputs))
                    .collect();
                for case in &cases {
                    assert!(case.ray.is_valid(), "{case:?}");
                    assert_eq!(case.solid.kind(), family.kind());
                }
                assert!(cases[0] != cases[1] && cases[0] == family.case(3, 0, inputs));
            }
        }
    }
}
