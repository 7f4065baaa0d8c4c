//! Names that users type: how messages quote them, and suggestions for unknown names.

use std::fmt::Write;

/// The most characters of a user's text that a message repeats.
const LONGEST_QUOTE: usize = 60;
/// The most names that a message lists.
const MOST_LISTED: usize = 40;

/// The text in double quotes, with control characters escaped. A long text is cut.
pub(super) fn quoted(text: &str) -> String {
    match text.char_indices().nth(LONGEST_QUOTE) {
        None => format!("{text:?}"),
        Some((end, _)) => format!("{:?}...", &text[..end]),
    }
}

/// Escapes the control characters in a message of a library. The message may repeat
/// characters of a file, and a terminal would obey them.
pub(super) fn printable(message: &str) -> String {
    let mut text = String::new();
    for c in message.chars() {
        match c.is_control() {
            true => text.extend(c.escape_default()),
            false => text.push(c),
        }
    }
    text
}

/// Replaces every control character but line feeds by U+FFFD, which keeps the width of lines.
pub(super) fn printable_lines(text: &str) -> String {
    let shown = |c: char| match c.is_control() && c != '\n' {
        true => char::REPLACEMENT_CHARACTER,
        false => c,
    };
    text.chars().map(shown).collect()
}

/// The help for an unknown name: the nearest of the known names, and a list of all.
/// `what` is their plural.
pub(super) fn suggestion<'n>(
    wrong: &str,
    names: impl IntoIterator<Item = &'n str>,
    what: &str,
) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    if names.is_empty() {
        return format!("no {what} are defined");
    }
    let mut text = String::new();
    if let Some(near) = nearest(wrong, &names) {
        let _ = write!(text, "did you mean {}? ", quoted(near));
    }
    let listed: Vec<String> = names
        .iter()
        .take(MOST_LISTED)
        .map(|name| quoted(name))
        .collect();
    let _ = write!(text, "the {what} are {}", listed.join(", "));
    if names.len() > MOST_LISTED {
        let _ = write!(text, " and {} more", names.len() - MOST_LISTED);
    }
    text
}

/// The name with the smallest edit distance, if that is at most a third of the letters
/// or 1: with more edits it would be another word.
fn nearest<'n>(wrong: &str, names: &[&'n str]) -> Option<&'n str> {
    let wrong: Vec<char> = wrong.chars().take(LONGEST_QUOTE).collect();
    let allowed = (wrong.len() / 3).max(1);
    names
        .iter()
        .map(|name| (edits(&wrong, name), *name))
        .filter(|(count, _)| *count <= allowed)
        .min_by_key(|(count, _)| *count)
        .map(|(_, name)| name)
}

/// The edit distance that counts inserted, deleted, replaced and transposed letters
/// ("optimal string alignment"), ignoring case.
fn edits(wrong: &[char], name: &str) -> usize {
    let name: Vec<char> = name.chars().take(2 * LONGEST_QUOTE).collect();
    let same =
        |row: usize, column: usize| name[row].to_lowercase().eq(wrong[column].to_lowercase());
    // costs[row][column] is the distance from the first `column` letters of `wrong` to
    // the first `row` letters of `name`.
    let mut costs = vec![vec![0; wrong.len() + 1]; name.len() + 1];
    costs[0] = (0..=wrong.len()).collect();
    for row in 1..=name.len() {
        costs[row][0] = row;
        for column in 1..=wrong.len() {
            let replaced = costs[row - 1][column - 1] + usize::from(!same(row - 1, column - 1));
            let mut cost = replaced
                .min(costs[row - 1][column] + 1)
                .min(costs[row][column - 1] + 1);
            if row > 1 && column > 1 && same(row - 1, column - 2) && same(row - 2, column - 1) {
                cost = cost.min(costs[row - 2][column - 2] + 1);
            }
            costs[row][column] = cost;
        }
    }
    costs[name.len()][wrong.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggestion_near_name_is_offered_first() {
        let text = suggestion("raduis", ["length", "radius"], "columns");
        assert_eq!(
            text,
            "did you mean \"radius\"? the columns are \"length\", \"radius\""
        );
        let case = suggestion("startx", ["startX"], "columns");
        assert!(case.contains("did you mean \"startX\""), "{case}");
        let swapped = suggestion("brak", ["bark"], "materials");
        assert!(swapped.contains("did you mean \"bark\""), "{swapped}");
    }

    #[test]
    fn suggestion_far_names_are_only_listed() {
        assert_eq!(
            suggestion("oak", ["pine"], "trees"),
            "the trees are \"pine\""
        );
        assert_eq!(suggestion("oak", [], "trees"), "no trees are defined");
    }

    #[test]
    fn quoted_long_text_is_cut_between_characters() {
        let text = quoted(&"é".repeat(1000));
        assert_eq!(text, format!("\"{}\"...", "é".repeat(60)));
        assert_eq!(quoted("a\u{1b}[0m\n"), "\"a\\u{1b}[0m\\n\"");
    }
}
