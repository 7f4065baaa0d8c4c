//! Tables for other programs.

use serde::Serialize;

/// Rows as comma-separated values under the names of their fields. Cells are quoted if
/// they need it, and empty for `None`.
///
/// # Panics
/// If a row is not a structure of numbers and texts.
#[must_use]
pub fn csv(rows: &[impl Serialize]) -> String {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).expect("a row is a flat structure");
    }
    let bytes = writer.into_inner().expect("memory is never full");
    String::from_utf8(bytes).expect("text in, text out")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Row {
        name: &'static str,
        size: Option<f64>,
    }

    #[test]
    fn csv_has_a_header_quotes_and_empty_cells() {
        let row = |name, size| Row { name, size };
        let text = csv(&[row("a,b", Some(1e-15)), row("say \"c\"", None)]);
        assert_eq!(text, "name,size\n\"a,b\",1e-15\n\"say \"\"c\"\"\",\n");
    }
}
