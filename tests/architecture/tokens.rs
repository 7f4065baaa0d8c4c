//! A lexer that is just good enough to tell Rust code from comments, strings
//! and character literals.

/// A word, a number, `::` or a single other character of the code.
#[derive(Debug, PartialEq, Eq)]
pub struct Token {
    /// The text as written.
    pub text: String,
    /// The line, counted from 1.
    pub line: usize,
}

/// The tokens of `source` without comments and literals.
pub fn tokens(source: &str) -> Vec<Token> {
    let mut found = Vec::new();
    let mut rest = source;
    let mut line = 1;
    while let Some(first) = rest.chars().next() {
        let length = skipped(rest);
        let (length, is_token) = match length {
            Some(length) => (length, false),
            None if is_word(first) => (word(rest), true),
            None if rest.starts_with("::") => (2, true),
            None => (first.len_utf8(), !first.is_whitespace()),
        };
        let (text, after) = rest.split_at(length);
        if is_token {
            let text = text.to_owned();
            found.push(Token { text, line });
        }
        line += text.matches('\n').count();
        rest = after;
    }
    found
}

/// The length of the comment or literal that `rest` starts with.
fn skipped(rest: &str) -> Option<usize> {
    if rest.starts_with("//") {
        return Some(rest.find('\n').unwrap_or(rest.len()));
    }
    if rest.starts_with("/*") {
        return Some(block_comment(rest));
    }
    let prefix = word(rest);
    if !matches!(&rest[..prefix], "" | "b" | "c" | "r" | "br" | "cr") {
        return None;
    }
    let quoted = &rest[prefix..];
    let is_raw = rest[..prefix].ends_with('r');
    if is_raw && quoted.starts_with(['#', '"']) {
        let hashes = quoted.len() - quoted.trim_start_matches('#').len();
        if !quoted[hashes..].starts_with('"') {
            return None;
        }
        let end = format!("\"{}", "#".repeat(hashes));
        let body = &quoted[hashes + 1..];
        let length = body.find(&end).map_or(body.len(), |at| at + end.len());
        return Some(prefix + hashes + 1 + length);
    }
    if quoted.starts_with('"') {
        return Some(prefix + escaped(quoted, '"'));
    }
    // A quote opens a character unless it is a lifetime: 'a' against 'a.
    let mut characters = quoted.strip_prefix('\'')?.chars();
    let is_escape = characters.next()? == '\\';
    if is_escape || characters.next() == Some('\'') {
        return Some(prefix + escaped(quoted, '\''));
    }
    None
}

/// The length of a block comment; they nest.
fn block_comment(rest: &str) -> usize {
    let mut nesting = 0_usize;
    let mut at = 0;
    while at < rest.len() {
        if rest[at..].starts_with("/*") {
            nesting += 1;
            at += 2;
        } else if rest[at..].starts_with("*/") {
            nesting -= 1;
            at += 2;
            if nesting == 0 {
                return at;
            }
        } else {
            at += rest[at..].chars().next().map_or(1, char::len_utf8);
        }
    }
    at
}

/// The length of a literal between two `quote`s, with backslash escapes.
fn escaped(rest: &str, quote: char) -> usize {
    let mut characters = rest.char_indices().skip(1);
    while let Some((at, character)) = characters.next() {
        if character == '\\' {
            characters.next();
        } else if character == quote {
            return at + quote.len_utf8();
        }
    }
    rest.len()
}

/// The length of the word that `rest` starts with.
fn word(rest: &str) -> usize {
    rest.find(|character| !is_word(character))
        .unwrap_or(rest.len())
}

fn is_word(character: char) -> bool {
    character.is_alphanumeric() || character == '_'
}

#[test]
fn tokens_of_comments_and_literals_are_left_out() {
    let source = "a /* b /* c */ d */ \"e \\\" f\" r#\"g \" h\"# b'i' '\\'' // j\nk::<'l>";
    let found: Vec<(String, usize)> = tokens(source)
        .into_iter()
        .map(|token| (token.text, token.line))
        .collect();
    let expected = [
        ("a", 1),
        ("k", 2),
        ("::", 2),
        ("<", 2),
        ("'", 2),
        ("l", 2),
        (">", 2),
    ];
    assert_eq!(found, expected.map(|(text, line)| (text.to_owned(), line)));
}
