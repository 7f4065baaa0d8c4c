//! The rule that the files of a folder do not import each other in a circle.

use std::collections::{BTreeMap, BTreeSet};

use super::tokens::tokens;

/// The files of a folder by their names without `.rs`, each with its text.
pub type Folder = BTreeMap<String, String>;

/// A circle of imports by `super::NAME` among the files of a folder, if there is one.
/// `mod.rs` is left out: it names all files, and none of them imports it.
pub fn circle(folder: &Folder) -> Option<Vec<String>> {
    let imports: BTreeMap<&str, BTreeSet<String>> = folder
        .iter()
        .filter(|(name, _)| *name != "mod")
        .map(|(name, text)| (name.as_str(), imported(folder, name, text)))
        .collect();
    let mut finished = BTreeSet::new();
    let mut files = imports.keys();
    files.find_map(|file| visit(file, &imports, &mut Vec::new(), &mut finished))
}

/// The files that a file imports.
fn imported(folder: &Folder, own: &str, text: &str) -> BTreeSet<String> {
    let tokens = tokens(text);
    let names = tokens.windows(3).filter_map(|window| match window {
        [parent, separator, name] if parent.text == "super" && separator.text == "::" => {
            Some(name.text.clone())
        }
        _ => None,
    });
    names
        .filter(|name| name != own && name != "mod" && folder.contains_key(name))
        .collect()
}

fn visit(
    file: &str,
    imports: &BTreeMap<&str, BTreeSet<String>>,
    way: &mut Vec<String>,
    finished: &mut BTreeSet<String>,
) -> Option<Vec<String>> {
    if let Some(start) = way.iter().position(|one| one == file) {
        return Some(way[start..].to_vec());
    }
    if finished.contains(file) {
        return None;
    }
    way.push(file.to_owned());
    let found = imports[file]
        .iter()
        .find_map(|next| visit(next, imports, way, finished));
    way.pop();
    finished.insert(file.to_owned());
    found
}
