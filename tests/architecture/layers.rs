//! The rule that a folder of the library uses only those above it.
//!
//! Between crates the compiler guards the layers: cargo allows no circle.

use super::tokens::{Token, tokens};

/// The folders of the library from the top of the table in `docs/architecture.md`; a folder
/// may use those in earlier rows.
const ROWS: [&[&str]; 5] = [
    &["math"],
    &["solid"],
    &["embree"],
    &["scene"],
    &["tracer", "meshes"],
];

/// What a folder must not use although it is further up.
const MUST_NOT_USE: [(&str, &str); 3] = [
    ("embree", "solid"),
    ("scene", "embree"),
    ("meshes", "embree"),
];

/// A folder of the library uses only those above it.
pub fn layers(file: &str, source: &str) -> Vec<String> {
    let path = file.trim_start_matches("src/");
    let (layer, depth) = match path.split_once('/') {
        Some((layer, rest)) => (layer, module_depth(rest)),
        None => return Vec::new(),
    };
    let Some(own_row) = row(layer) else {
        return vec![format!("{file}: \"{layer}\" is not in the table of layers")];
    };
    let tokens = tokens(source);
    let mut complaints = Vec::new();
    for (used, line) in uses(&tokens, depth) {
        if used == layer {
            continue;
        }
        let known = MUST_NOT_USE.contains(&(layer, used.as_str()));
        let above = row(&used).is_none_or(|used_row| used_row < own_row);
        if used == "*" || used == "as" {
            complaints.push(format!("{file}:{line}: hides which layers it uses"));
        } else if known || !above {
            complaints.push(format!(
                "{file}:{line}: \"{layer}\" must not use \"{used}\""
            ));
        }
    }
    complaints
}

/// How many `super` lead from a file of a layer's folder to the crate.
fn module_depth(path_in_layer: &str) -> usize {
    let parts = path_in_layer.split('/').count();
    parts + usize::from(!path_in_layer.ends_with("mod.rs"))
}

fn row(layer: &str) -> Option<usize> {
    ROWS.iter().position(|row| row.contains(&layer))
}

/// The names that follow the crate's own, and their lines.
fn uses(tokens: &[Token], depth: usize) -> Vec<(String, usize)> {
    let mut found = Vec::new();
    for (index, token) in tokens.iter().enumerate() {
        let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
        let mut at = match token.text.as_str() {
            "crate" | "cyltrace" => index + 1,
            "super" if depth > 0 && (index == 0 || text(index - 1) != "::") => {
                let mut supers = 1;
                let mut at = index + 1;
                while text(at) == "::" && text(at + 1) == "super" {
                    supers += 1;
                    at += 2;
                }
                if supers < depth {
                    continue;
                }
                at
            }
            _ => continue,
        };
        if text(at) == "as" {
            found.push((String::from("as"), token.line));
        }
        if text(at) != "::" {
            continue;
        }
        at += 1;
        if text(at) != "{" {
            found.push((text(at).to_owned(), token.line));
            continue;
        }
        // Of a group, the names that open its items.
        let mut nesting = 0;
        loop {
            match text(at) {
                "{" => nesting += 1,
                "}" => nesting -= 1,
                _ => {}
            }
            if nesting == 1 && matches!(text(at), "{" | ",") && text(at + 1) != "}" {
                found.push((text(at + 1).to_owned(), token.line));
            }
            at += 1;
            if nesting == 0 || at >= tokens.len() {
                break;
            }
        }
    }
    found
}
