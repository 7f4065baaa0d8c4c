//! Families by their names, of cylinders and of any kind of solid.

/// A name that is no family's.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no family {name:?}; the families are {}", known.join(", "))]
pub struct UnknownFamily {
    /// The name as given.
    pub name: String,
    /// The names that there are.
    pub known: Vec<String>,
}

/// Finds the family with a name among all of its type.
pub fn family_named<F: Copy>(
    name: &str,
    all: impl IntoIterator<Item = F>,
    name_of: impl Fn(F) -> String,
) -> Result<F, UnknownFamily> {
    let mut known = Vec::new();
    for family in all {
        let one = name_of(family);
        if one == name {
            return Ok(family);
        }
        known.push(one);
    }
    let name = name.to_owned();
    Err(UnknownFamily { name, known })
}
