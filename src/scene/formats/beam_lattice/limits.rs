//! Rejects XML texts whose parsing takes more than linear time.
//!
//! The parser compares each attribute of an element with those before it, and an element
//! that declares a namespace copies those of the elements around it. So the number of
//! attributes of an element and of namespace prefixes is limited before the parser runs, in
//! one pass over the bytes that only detects where tags, quotes and comments end.

use std::collections::HashSet;

use crate::scene::limits::{MOST_ATTRIBUTES, MOST_NAMESPACES};

/// Checks the limits.
///
/// # Errors
/// The byte at which a limit is exceeded, and a message.
pub(super) fn check(text: &str) -> Result<(), (usize, String)> {
    let bytes = text.as_bytes();
    let mut prefixes = HashSet::new();
    let mut at = 0;
    while let Some(start) = bytes[at..].iter().position(|&byte| byte == b'<') {
        let start = at + start;
        at = match &bytes[start..] {
            [b'<', b'!', b'-', b'-', ..] => after(bytes, start + 4, b"-->"),
            [b'<', b'!', b'[', ..] => after(bytes, start + 3, b"]]>"),
            [b'<', b'?', ..] => after(bytes, start + 2, b"?>"),
            _ => tag(bytes, start, &mut prefixes)?,
        };
    }
    Ok(())
}

/// Checks the tag at `start` and returns its end.
fn tag<'a>(
    bytes: &'a [u8],
    start: usize,
    prefixes: &mut HashSet<&'a [u8]>,
) -> Result<usize, (usize, String)> {
    let mut attributes = 0;
    // An attribute's name is the text between two values; before the first value that text
    // also contains the element's name.
    let mut at = start;
    while let Some(end) = bytes[at..].iter().position(|byte| b">\"'".contains(byte)) {
        let end = at + end;
        if bytes[end] == b'>' {
            return Ok(end + 1);
        }
        attributes += 1;
        if attributes > MOST_ATTRIBUTES {
            let message = format!("the element has more than {MOST_ATTRIBUTES} attributes");
            return Err((start, message));
        }
        let words = bytes[at..end].split(|byte| byte.is_ascii_whitespace() || *byte == b'=');
        let name = words
            .rev()
            .find(|word| !word.is_empty())
            .unwrap_or_default();
        if name.starts_with(b"xmlns") && prefixes.insert(name) && prefixes.len() > MOST_NAMESPACES {
            let message =
                format!("the text declares more than {MOST_NAMESPACES} namespace prefixes");
            return Err((start, message));
        }
        at = after(bytes, end + 1, &bytes[end..=end]);
    }
    Ok(bytes.len())
}

/// The end of the next `mark` from `at` on, or of the text.
fn after(bytes: &[u8], at: usize, mark: &[u8]) -> usize {
    let rest = bytes.get(at..).unwrap_or_default();
    let found = rest.windows(mark.len()).position(|window| window == mark);
    found.map_or(bytes.len(), |found| at + found + mark.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn attributes(count: usize) -> String {
        (0..count).map(|number| format!(" a{number}='>'")).collect()
    }

    #[test]
    fn attributes_of_an_element_are_limited() {
        let most = format!("<a{}/>", attributes(MOST_ATTRIBUTES));
        assert_eq!(check(&most.repeat(3)), Ok(()));
        let more = format!("<!-- ' -->{most}<b{}/>", attributes(MOST_ATTRIBUTES + 1));
        let (at, message) = check(&more).unwrap_err();
        assert!(more[at..].starts_with("<b"), "{at}");
        assert!(message.contains("more than 256 attributes"), "{message}");
        // Text outside of tags is not limited.
        for (start, end) in [
            ("<!--", "-->"),
            ("<![CDATA[", "]]>"),
            ("<?p", "?>"),
            ("", ""),
        ] {
            let text = format!("<a>{start}{}{end}</a>", attributes(MOST_ATTRIBUTES + 1));
            assert_eq!(check(&text), Ok(()), "{start}");
        }
    }

    #[test]
    fn prefixes_are_limited_and_may_be_declared_again() {
        let nested = |count: usize| -> String {
            (0..count)
                .map(|number| format!("<a xmlns:p{number} = \"u\">"))
                .collect()
        };
        assert_eq!(check(&nested(MOST_NAMESPACES).repeat(3)), Ok(()));
        let (_, message) = check(&nested(MOST_NAMESPACES + 1)).unwrap_err();
        assert!(
            message.contains("more than 256 namespace prefixes"),
            "{message}"
        );
    }

    #[test]
    fn texts_that_end_early_are_left_to_the_parser() {
        for text in [
            "<",
            "<a",
            "<a b='",
            "<a b=\"c\"",
            "<!-",
            "<!--",
            "<?",
            "<![",
            "a > ' b",
        ] {
            assert_eq!(check(text), Ok(()), "{text}");
        }
    }
}
