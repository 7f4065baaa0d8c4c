//! Choices by name.

use pyo3::prelude::*;

use crate::arrays::value_error;

/// The one of a name.
///
/// # Errors
/// When there is none.
pub fn one_of<T: Copy, const N: usize>(
    what: &str,
    name: &str,
    all: [T; N],
    name_of: impl Fn(T) -> &'static str,
) -> PyResult<T> {
    let mut choices = all.into_iter();
    choices.find(|&one| name_of(one) == name).ok_or_else(|| {
        let names = all.map(name_of).join(", ");
        value_error(format!("{what} is \"{name}\": it must be one of {names}"))
    })
}
