//! Values that the command line names.

use clap::builder::{PossibleValuesParser, TypedValueParser};

/// Accepts the names of some values; clap's error and help list them.
pub fn one_of<T>(
    values: impl IntoIterator<Item = T>,
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let values: Vec<T> = values.into_iter().collect();
    let names: Vec<&str> = values.iter().map(|&value| name(value)).collect();
    PossibleValuesParser::new(names).map(move |given| {
        let known = values.iter().find(|&&value| name(value) == given);
        *known.expect("clap accepts no other name")
    })
}
