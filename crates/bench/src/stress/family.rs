//! The families of single solids and of set operations under one roof.

use std::str::FromStr;

use cyltrace_oracle::cases::{AnyFamily, ComposedFamily, UnknownFamily, family_named};

/// A family of cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StressFamily {
    /// Of single solids.
    Solid(AnyFamily),
    /// Of set operations.
    Composed(ComposedFamily),
}

impl StressFamily {
    /// All families, in the order of tables.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let solids = AnyFamily::all().into_iter().map(Self::Solid);
        let composed = ComposedFamily::ALL.map(Self::Composed);
        solids.chain(composed).collect()
    }

    /// The name on the command line and in tables.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Solid(family) => family.name(),
            Self::Composed(family) => family.name(),
        }
    }
}

impl From<AnyFamily> for StressFamily {
    fn from(family: AnyFamily) -> Self {
        Self::Solid(family)
    }
}

impl From<ComposedFamily> for StressFamily {
    fn from(family: ComposedFamily) -> Self {
        Self::Composed(family)
    }
}

impl FromStr for StressFamily {
    type Err = UnknownFamily;

    fn from_str(name: &str) -> Result<Self, UnknownFamily> {
        family_named(name, Self::all(), Self::name)
    }
}
