//! Tables for other programs.

/// A table as comma-separated values, quoted where they need it.
///
/// # Panics
/// When a row has not as many cells as there are headings.
#[must_use]
pub fn csv(headings: &[&str], rows: &[Vec<String>]) -> String {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    writer
        .write_record(headings)
        .expect("memory takes all that is written");
    for row in rows {
        writer
            .write_record(row)
            .expect("every row has as many cells as there are headings");
    }
    let bytes = writer.into_inner().expect("memory is never full");
    String::from_utf8(bytes).expect("text in, text out")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_cells_with_commas_and_quotes_are_quoted() {
        let rows = [vec![String::from("a,b"), String::from("say \"c\"")]];
        let text = csv(&["one", "two"], &rows);
        assert_eq!(text, "one,two\n\"a,b\",\"say \"\"c\"\"\"\n");
    }
}
