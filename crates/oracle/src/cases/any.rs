//! The families of all kinds of solids under one roof.
//!
//! Those of cylinders keep their names; that of another solid begins with its kind,
//! as in `cone-rim`.

use std::fmt::Debug;
use std::str::FromStr;

use super::Problem;
use super::{
    CuboidFamily, DiskFamily, Family, Inputs, SphereFamily, TaperFamily, TaperSolid, UnknownFamily,
    family_named,
};
use cyltrace::math::Ray;
use cyltrace::solid::{AnySolid, Caps, SolidKind};

/// A solid and a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// The solid.
    pub solid: AnySolid,
    /// The ray.
    pub ray: Ray,
}

impl From<Problem> for Case {
    fn from(problem: Problem) -> Self {
        let Problem { cylinder, ray } = problem;
        Self {
            solid: cylinder.into(),
            ray,
        }
    }
}

/// A family of cases of some kind of solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AnyFamily {
    /// Of cylinders.
    Cylinder(Family),
    /// Of cones.
    Cone(TaperFamily),
    /// Of rounded cones.
    RoundedCone(TaperFamily),
    /// Of spheres.
    Sphere(SphereFamily),
    /// Of cuboids.
    Cuboid(CuboidFamily),
    /// Of disks.
    Disk(DiskFamily),
}

impl AnyFamily {
    /// All families, in the order of tables.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let cylinders = Family::ALL.into_iter().map(Self::Cylinder);
        cylinders
            .chain(TaperFamily::ALL.map(Self::Cone))
            .chain(TaperFamily::ALL.map(Self::RoundedCone))
            .chain(SphereFamily::ALL.map(Self::Sphere))
            .chain(CuboidFamily::ALL.map(Self::Cuboid))
            .chain(DiskFamily::ALL.map(Self::Disk))
            .collect()
    }

    /// The kind of its solids.
    #[must_use]
    pub fn kind(self) -> SolidKind {
        match self {
            Self::Cylinder(_) => SolidKind::Cylinder,
            Self::Cone(_) => SolidKind::Cone,
            Self::RoundedCone(_) => SolidKind::RoundedCone,
            Self::Sphere(_) => SolidKind::Sphere,
            Self::Cuboid(_) => SolidKind::Cuboid,
            Self::Disk(_) => SolidKind::Disk,
        }
    }

    /// The name on the command line and in tables.
    #[must_use]
    pub fn name(self) -> String {
        let of = |family: &dyn Debug| {
            let kind = self.kind().name().replace('_', "-");
            format!("{kind}{}", with_hyphens(&format!("{family:?}")))
        };
        match self {
            Self::Cylinder(family) => family.name().to_owned(),
            Self::Cone(family) | Self::RoundedCone(family) => of(&family),
            Self::Sphere(family) => of(&family),
            Self::Cuboid(family) => of(&family),
            Self::Disk(family) => of(&family),
        }
    }

    /// Case `index`, below 2^32, of the family; the same for the same arguments.
    /// Cones have all combinations of caps in turn.
    ///
    /// # Panics
    /// When none of many draws is a solid and a ray, which no family does.
    #[must_use]
    pub fn case(self, seed: u64, index: u64, inputs: Inputs) -> Case {
        match self {
            Self::Cylinder(family) => family.case(seed, index, inputs).into(),
            Self::Cone(family) => {
                let case = family.case(TaperSolid::Cone, seed, index, inputs);
                let caps = [Caps::Both, Caps::None, Caps::P0, Caps::P1][(index % 4) as usize];
                case_of((case.cone(caps), case.ray))
            }
            Self::RoundedCone(family) => {
                let case = family.case(TaperSolid::RoundedCone, seed, index, inputs);
                case_of((case.rounded_cone(), case.ray))
            }
            Self::Sphere(family) => drawn(index, |index| family.case(seed, index, inputs)),
            Self::Cuboid(family) => drawn(index, |index| family.case(seed, index, inputs)),
            Self::Disk(family) => drawn(index, |index| family.case(seed, index, inputs)),
        }
    }
}

/// The first draw that is a case: some round to none.
fn drawn<S: Into<AnySolid>>(index: u64, draw: impl Fn(u64) -> Option<(S, Ray)>) -> Case {
    let drawn = (0..64).find_map(|again| draw(index | again << 32));
    case_of(drawn.expect("more than nine in ten draws are cases"))
}

fn case_of<S: Into<AnySolid>>((solid, ray): (S, Ray)) -> Case {
    Case {
        solid: solid.into(),
        ray,
    }
}

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
