//! The rule that a folder of the library, or of the check, uses only those above it.
//!
//! Between crates the compiler guards the layers: cargo allows no circle.

use super::tokens::{Token, tokens};

/// The folders of a crate, or files beside its root.
struct Layers {
    /// Where its sources are.
    sources: &'static str,
    /// The name that its sources may use for the crate itself.
    name: &'static str,
    /// From the top: a folder may use those in earlier rows.
    rows: &'static [&'static [&'static str]],
    /// What a folder must not use although it is further up.
    must_not_use: &'static [(&'static str, &'static str)],
}

/// The library, in the order of the table in `docs/architecture.md`.
const LIBRARY: Layers = Layers {
    sources: "src/",
    name: "cyltrace",
    rows: &[
        &["math"],
        &["solid"],
        &["embree"],
        &["scene"],
        &["tracer", "meshes"],
    ],
    must_not_use: &[
        ("embree", "solid"),
        ("scene", "embree"),
        ("meshes", "embree"),
    ],
};

/// The check: geometry below verdicts below reports.
const CHECK: Layers = Layers {
    sources: "crates/check/src/",
    name: "cyltrace_check",
    rows: &[
        &["settings", "reported_hit"],
        &["outcome", "replay"],
        &["tally"],
        &["partial_outcome"],
        &["solids"],
        &["bounding_meshes"],
        &["rays"],
        &["verdict", "external"],
        &["report"],
        &["run"],
    ],
    must_not_use: &[("external", "bounding_meshes")],
};

/// A folder of the library or of the check uses only those above it.
pub fn layers(file: &str, source: &str) -> Vec<String> {
    let of_file = [CHECK, LIBRARY]
        .into_iter()
        .find_map(|layers| Some((file.strip_prefix(layers.sources)?, layers)));
    let Some((path, layers)) = of_file else {
        return Vec::new();
    };
    let (layer, depth) = match path.split_once('/') {
        Some((layer, rest)) => (layer, module_depth(rest)),
        // The root of a crate uses all, and a file beside it is a layer of the check.
        None if path == "lib.rs" || layers.name == "cyltrace" => return Vec::new(),
        None => (path.trim_end_matches(".rs"), 1),
    };
    let Some(own_row) = layers.row(layer) else {
        return vec![format!("{file}: \"{layer}\" is not in the table of layers")];
    };
    let tokens = tokens(source);
    let mut complaints = Vec::new();
    for (used, line) in uses(&tokens, layers.name, depth) {
        if used == layer {
            continue;
        }
        let known = layers.must_not_use.contains(&(layer, used.as_str()));
        let above = layers.row(&used).is_none_or(|row| row < own_row);
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

impl Layers {
    fn row(&self, layer: &str) -> Option<usize> {
        self.rows.iter().position(|row| row.contains(&layer))
    }
}

/// How many `super` lead from a file of a layer's folder to the crate.
fn module_depth(path_in_layer: &str) -> usize {
    let parts = path_in_layer.split('/').count();
    parts + usize::from(!path_in_layer.ends_with("mod.rs"))
}

/// The names that follow the crate's own, and their lines.
fn uses(tokens: &[Token], name: &str, depth: usize) -> Vec<(String, usize)> {
    let mut found = Vec::new();
    for (index, token) in tokens.iter().enumerate() {
        let text = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
        let mut at = match token.text.as_str() {
            "crate" => index + 1,
            own if own == name => index + 1,
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
