//! The rule that the files of a crate do not import each other in a circle, in whatever
//! folders they are.
//!
//! A file is a module. A name that a module re-exports counts as that of the file that
//! defines it. Between a module and those within it imports may go both ways: `mod.rs` names
//! its files, and they use what it defines. Modules of tests are left out.

use std::collections::{BTreeMap, BTreeSet};

use super::tokens::tokens;
use super::{members, sources};

/// Imports that close a circle, and why they are right.
const ALLOWED: &[(&str, &str, &str)] = &[(
    "tracer/prototype/placements",
    "tracer/prototype/group",
    "a group has placements of groups: the tracer descends through both",
)];

#[test]
fn files_of_every_crate_import_each_other_in_no_circle() {
    let mut found = Vec::new();
    for folder in members() {
        let prefix = format!("{folder}/");
        let files = sources(&folder).into_iter();
        let files = files.map(|(name, text)| (name.replacen(&prefix, "", 1), text));
        let modules = Modules::new(files);
        found.extend(modules.circle().map(|circle| format!("{prefix}: {circle}")));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn files_planted_in_a_circle_are_found() {
    let circle = |files: &[(&str, &str)]| {
        let files = files.iter();
        Modules::new(files.map(|&(name, text)| (name.into(), text.into()))).circle()
    };
    let lib = ("lib.rs", "mod a;\nmod b;\nmod c;");
    let a = ("a.rs", "use crate::b::{self, Deep};");
    let b = ("b/mod.rs", "pub use deep::Deep;\nmod deep;\npub fn f() {}");
    let deep = |text| ("b/deep.rs", text);
    let c = |text| ("c.rs", text);
    let chain = [lib, a, b, deep("use super::f;\nuse super::super::c::C;")];
    assert_eq!(
        circle(&[&chain[..], &[c("// crate::a\nfn c() {}")]].concat()),
        None
    );
    let tests = c("struct C;\n#[cfg(test)]\nmod tests {\n    use crate::a::f;\n}");
    assert_eq!(circle(&[&chain[..], &[tests]].concat()), None);
    for closing in ["fn c() { crate::a::f() }", "use {super::a::A, super::b};"] {
        let found = circle(&[&chain[..], &[c(closing)]].concat());
        assert_eq!(found, Some("a -> b/deep -> c -> a".into()), "{closing}");
    }
}

/// The path of a module from the root of its crate.
type Module = Vec<String>;

/// A path in the code of a module.
struct Named {
    segments: Vec<String>,
    /// Its last segment, or the name after `as`.
    name: String,
}

/// The modules of a crate, each with the paths in its code.
struct Modules(BTreeMap<Module, Vec<Named>>);

impl Modules {
    /// The modules in files with these names and texts.
    fn new(files: impl Iterator<Item = (String, String)>) -> Self {
        let module = |name: &str| {
            let mut module: Module = name
                .trim_end_matches(".rs")
                .split('/')
                .map(str::to_owned)
                .collect();
            module.pop_if(|last| ["mod", "lib", "main"].contains(&last.as_str()));
            module
        };
        let modules = files.map(|(name, text)| (module(&name), paths(&text)));
        Self(
            modules
                .filter(|(module, _)| module.last().is_none_or(|last| last != "tests"))
                .collect(),
        )
    }

    /// A circle of imports, if there is one.
    fn circle(&self) -> Option<String> {
        let imports = self.0.keys().map(|module| (module, self.imports(module)));
        let imports: BTreeMap<&Module, BTreeSet<Module>> = imports.collect();
        let mut finished = BTreeSet::new();
        let mut modules = imports.keys();
        modules.find_map(|module| visit(module, &imports, &mut Vec::new(), &mut finished))
    }

    /// The modules that a module imports, without those that it is in and those in it.
    fn imports(&self, module: &Module) -> BTreeSet<Module> {
        let targets = self.0[module].iter().filter_map(|path| {
            let supers = path
                .segments
                .iter()
                .take_while(|one| *one == "super")
                .count();
            let (base, rest) = match path.segments[0].as_str() {
                "crate" => (&[][..], &path.segments[1..]),
                "super" => (
                    module.get(..module.len().checked_sub(supers)?)?,
                    &path.segments[supers..],
                ),
                _ => return None,
            };
            Some(self.resolve(base, rest))
        });
        let is_allowed = |target: &Module| {
            let (from, to) = (module.join("/"), target.join("/"));
            ALLOWED
                .iter()
                .any(|&(one, other, _)| (one, other) == (&from, &to))
        };
        targets
            .filter(|target| !target.starts_with(module) && !module.starts_with(target))
            .filter(|target| !is_allowed(target))
            .collect()
    }

    /// The module that defines what a path from another module names.
    fn resolve(&self, base: &[String], segments: &[String]) -> Module {
        let mut at = base.to_vec();
        for segment in segments {
            at.push(segment.clone());
            if self.0.contains_key(&at) {
                continue;
            }
            at.pop();
            let is_child = |path: &&Named| {
                path.name == *segment
                    && self
                        .0
                        .contains_key(&[&at[..], &path.segments[..1]].concat())
            };
            let exported = self
                .0
                .get(&at)
                .and_then(|paths| paths.iter().find(is_child));
            return exported.map_or(at.clone(), |path| self.resolve(&at, &path.segments));
        }
        at
    }
}

/// The paths of `use` declarations, and those that begin at the crate or at a parent, without
/// those of tests.
fn paths(source: &str) -> Vec<Named> {
    let mut words: Vec<String> = tokens(source).into_iter().map(|token| token.text).collect();
    let tests = words.windows(10).position(|window| {
        window[..8] == ["#", "[", "cfg", "(", "test", ")", "]", "mod"] && window[9] == "{"
    });
    words.truncate(tests.unwrap_or(words.len()));
    let mut found = Vec::new();
    let mut at = 0;
    while at < words.len() {
        let is_use = words[at] == "use";
        let is_start = at == 0 || !["::", "$"].contains(&words[at - 1].as_str());
        if is_use || is_start && ["crate", "super"].contains(&words[at].as_str()) {
            at += usize::from(is_use);
            tree(&words, &mut at, &[], is_use, &mut found);
        } else {
            at += 1;
        }
    }
    found
}

/// Reads a path, or of a `use` declaration a tree of paths, from position `at`.
fn tree(words: &[String], at: &mut usize, prefix: &[String], is_use: bool, found: &mut Vec<Named>) {
    let text = |at: usize| words.get(at).map_or("", String::as_str);
    let mut segments = prefix.to_vec();
    loop {
        if is_use && text(*at) == "{" {
            *at += 1;
            while !["}", ""].contains(&text(*at)) {
                tree(words, at, &segments, is_use, found);
                *at += usize::from(text(*at) == ",");
            }
            *at += 1;
            return;
        }
        segments.push(text(*at).to_owned());
        *at += 1;
        if text(*at) != "::" {
            break;
        }
        *at += 1;
    }
    let mut name = segments[segments.len() - 1].clone();
    if is_use && text(*at) == "as" {
        name = text(*at + 1).to_owned();
        *at += 2;
    }
    let first = segments.iter().position(|segment| segment != "self");
    if let Some(first) = first {
        let segments = segments.split_off(first);
        found.push(Named { segments, name });
    }
}

fn visit(
    module: &Module,
    imports: &BTreeMap<&Module, BTreeSet<Module>>,
    way: &mut Vec<Module>,
    finished: &mut BTreeSet<Module>,
) -> Option<String> {
    if let Some(start) = way.iter().position(|one| one == module) {
        let circle = way[start..].iter().chain([module]);
        let names: Vec<String> = circle.map(|module| module.join("/")).collect();
        return Some(names.join(" -> "));
    }
    if finished.contains(module) {
        return None;
    }
    way.push(module.clone());
    let mut next = imports.get(module).into_iter().flatten();
    let found = next.find_map(|next| visit(next, imports, way, finished));
    way.pop();
    finished.insert(module.clone());
    found
}
