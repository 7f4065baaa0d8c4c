//! Translates messages of the TOML parser for users, with advice.

use super::error::SceneError;
use super::formats;
use super::names::{quoted, suggestion};
use super::source::Source;
use crate::solid::SolidKind;

/// The top-level keys for arrays of tables, `[[...]]`, besides those of solids and of their
/// files.
const LISTS: [&str; 9] = [
    "material",
    "point_light",
    "sphere_light",
    "rectangle_light",
    "clip",
    "prototype",
    "instance",
    "instance_table",
    "scatter",
];
/// The other top-level keys.
const SINGLE: [&str; 12] = [
    "background",
    "camera",
    "film",
    "render",
    "sun",
    "sky",
    "legend",
    "scale_bar",
    "axes",
    "outlines",
    "depth_cue",
    "environment",
];

/// Whether a top-level key is an array of tables.
fn is_list(key: &str) -> bool {
    LISTS.contains(&key) || formats::KEYS.contains(&key) || key.parse::<SolidKind>().is_ok()
}

/// The most characters that are shown from the beginning and from the end of a message,
/// which may repeat keys and values of any length.
const LONGEST_PART: usize = 300;

/// The error of the TOML parser or of a value's type.
pub(super) fn toml_error(source: &Source, error: &toml::de::Error) -> SceneError {
    let place = error.span().unwrap_or(0..0);
    let (message, help) = explain(error.message(), source.line_text(place.start));
    match help {
        Some(help) => source.error_with_help(place, message, help),
        None => source.error(place, message),
    }
}

/// The message for users, and advice if possible, for a message of the parser about a place
/// in `line`.
fn explain(message: &str, line: &str) -> (String, Option<String>) {
    if message.contains("max recursion depth met") {
        return ("the values are nested too deeply".to_owned(), None);
    }
    if let Some((key, expected)) = unknown_field(message) {
        return unknown_key(key, &expected, line);
    }
    let line = line.trim();
    let path = header(line);
    let key = path.or_else(|| line.split_once('=').map(|(key, _)| key.trim()));
    let last = path.and_then(|path| path.rsplit('.').next()).or(key);
    if let (Some(key), Some(last)) = (key, last) {
        let wants_list = message.starts_with("invalid type: map, expected a sequence")
            || (message == "duplicate key" && path.is_some() && !line.starts_with("[["));
        if wants_list && is_list(last) {
            return (
                format!("[{key}] is a single table, but {last} must be an array of tables"),
                Some(format!("write [[{key}]] in front of each")),
            );
        }
        if line.starts_with("[[") && SINGLE.contains(&last) {
            return (
                format!("[[{key}]] is an array of tables, but {last} must be a single table"),
                Some(format!("write [{key}] once")),
            );
        }
    }
    let lines: Vec<&str> = message.lines().collect();
    (without_middle(&lines.join(", ")), None)
}

/// The unknown key and the accepted keys in a message about an unknown key.
fn unknown_field(message: &str) -> Option<(&str, Vec<&str>)> {
    let rest = message.strip_prefix("unknown field `")?;
    let (key, expected) = rest.split_at(rest.rfind("`, expected ")?);
    // The odd pieces are between two backquotes; the first quote ends `key`.
    Some((key, expected[1..].split('`').skip(1).step_by(2).collect()))
}

fn unknown_key(key: &str, expected: &[&str], line: &str) -> (String, Option<String>) {
    let message = format!("unknown key {}", quoted(key));
    let is_top = is_list(key) || SINGLE.contains(&key);
    let help = if !is_top {
        suggestion(key, expected.iter().copied(), "keys")
    } else if line.trim_start().starts_with('[') {
        format!("{key} is a top-level key: it cannot be in another table")
    } else {
        format!(
            "top-level keys go before the first [table]: put {key} above it; here it belongs to the preceding table"
        )
    };
    (message, Some(help))
}

/// The path in a line such as `[a.b]` or `[[a.b]]`.
fn header(line: &str) -> Option<&str> {
    let inner = line.strip_prefix('[')?;
    let inner = inner.strip_prefix('[').unwrap_or(inner);
    inner.split_once(']').map(|(path, _)| path.trim())
}

/// Beginning and end of a long message.
fn without_middle(message: &str) -> String {
    let beginning = message.char_indices().nth(LONGEST_PART);
    let end = message.char_indices().nth_back(LONGEST_PART);
    match (beginning, end) {
        (Some((first, _)), Some((last, _))) if first < last => {
            format!("{}[...]{}", &message[..first], &message[last..])
        }
        _ => message.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_field_of_any_wording_is_parsed() {
        for (message, key, expected) in [
            ("unknown field `a`, expected `b`", "a", &["b"][..]),
            ("unknown field `a`, expected `b` or `c`", "a", &["b", "c"]),
            (
                "unknown field `a`b`, expected one of `c`, `d`, `e`",
                "a`b",
                &["c", "d", "e"],
            ),
        ] {
            let found = unknown_field(message).expect(message);
            assert_eq!(found, (key, expected.to_vec()), "{message}");
        }
        assert_eq!(unknown_field("missing field `a`"), None);
    }

    #[test]
    fn unknown_message_is_shown_without_its_middle() {
        let (message, help) = explain("bad\nvalue", "x = 1");
        assert_eq!((message.as_str(), help), ("bad, value", None));
        let (message, _) = explain(&"x".repeat(10_000), "x = 1");
        assert_eq!(message.len(), 2 * LONGEST_PART + "[...]".len() + 1);
    }
}
