//! The files that the documentation names exist, and its links lead somewhere.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Pages whose paths are from the root of the repository.
const WITH_PATHS: [&str; 3] = [
    "docs/accuracy.md",
    "docs/architecture.md",
    "docs/derivations.md",
];

#[test]
fn paths_in_documents_exist() {
    let complaints = WITH_PATHS.map(|page| wrong_paths(page, &read(page)));
    let complaints = complaints.concat();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn paths_planted_are_found() {
    for text in [
        "`src/nowhere.rs`",
        "`ray.rs`",
        "`math/ray.rs`",
        "see `src/nowhere`,",
        "| `src/math/` | `no_such_module` |",
        "    ```text\n    ```\n`nowhere.rs`",
    ] {
        assert_eq!(wrong_paths("page.md", text).len(), 1, "{text}");
    }
    for text in [
        "`src/math/ray.rs`, `tests/tracing`, `a / b`, `1/pi`, `src/solid/KIND.rs`",
        "| `src/math/` | `ray` |",
        "```text\n`nowhere.rs`\n```",
    ] {
        assert!(wrong_paths("page.md", text).is_empty(), "{text}");
    }
}

#[test]
fn links_in_documents_lead_to_a_file_and_a_heading() {
    let folder = fs::read_dir(root().join("docs")).expect("the folder of the documentation");
    let names = folder.map(|entry| entry.expect("an entry").file_name());
    let pages = names
        .filter_map(|name| name.into_string().ok())
        .filter(|name| name.ends_with(".md"))
        .map(|name| format!("docs/{name}"));
    let pages = pages.chain(["README.md".into(), "CHANGELOG.md".into()]);
    let complaints: Vec<String> = pages
        .flat_map(|page| wrong_links(&page, &read(&page)))
        .collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn links_planted_are_found() {
    for text in [
        "[a](nowhere.md)",
        "![a](docs/nowhere.jpg)",
        "[a](docs/check.md#nowhere)",
        "[a](#b)",
    ] {
        assert_eq!(wrong_links("README.md", text).len(), 1, "{text}");
    }
    let text = "# A `b`, C\n[a](docs/check.md) [a](#a-b-c) [a](https://example.com)";
    assert_eq!(wrong_links("README.md", text), Vec::<String>::new());
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(page: &str) -> String {
    fs::read_to_string(root().join(page)).unwrap_or_else(|error| panic!("{page}: {error}"))
}

/// The paths of a page that do not exist. In a row of a table whose first cell is a folder,
/// the other words in backticks are files or folders in that folder.
fn wrong_paths(page: &str, text: &str) -> Vec<String> {
    let mut complaints = Vec::new();
    for (number, line) in prose(text) {
        let spans: Vec<&str> = line.split('`').skip(1).step_by(2).collect();
        let folder = match spans.first().copied() {
            Some(first) if line.starts_with("| `") && first.ends_with('/') => Some(first),
            _ => None,
        };
        for span in spans {
            let exists = match folder {
                Some(folder) if is_word(span) => {
                    let path = root().join(folder).join(span);
                    path.exists() || path.with_extension("rs").exists()
                }
                _ => !is_path(span) || root().join(span).exists(),
            };
            if !exists {
                complaints.push(format!("{page}:{number}: there is no {span}"));
            }
        }
    }
    complaints
}

/// Lines outside blocks of code, with their numbers.
fn prose(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut is_code = false;
    (1..).zip(text.lines()).filter(move |(_, line)| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_fence && !is_code
    })
}

/// Whether a span is the name of a module or a folder.
fn is_word(span: &str) -> bool {
    span.chars().all(|c| c.is_ascii_lowercase() || c == '_')
}

/// Whether a span names a file or a folder of the repository. Placeholders in upper case
/// do not.
fn is_path(span: &str) -> bool {
    const FOLDERS: [&str; 8] = [
        "src/",
        "crates/",
        "tests/",
        "docs/",
        "scenes/",
        "scripts/",
        "fuzz/",
        "examples/",
    ];
    let is_plain = span
        .chars()
        .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || "_-./".contains(c));
    let is_file = [".rs", ".sh", ".toml", ".md", ".h"]
        .iter()
        .any(|end| span.ends_with(end) && span.len() > end.len());
    is_plain && (is_file || FOLDERS.iter().any(|folder| span.starts_with(folder)))
}

/// The links of a page that lead nowhere.
fn wrong_links(page: &str, text: &str) -> Vec<String> {
    let folder = Path::new(page).parent().expect("a folder");
    let mut complaints = Vec::new();
    for (number, line) in prose(text) {
        let targets = line.split("](").skip(1);
        for target in targets.filter_map(|rest| rest.split_once(')')) {
            let target = target.0;
            if target.contains("://") {
                continue;
            }
            let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
            let path: PathBuf = match file {
                "" => root().join(page),
                file => root().join(folder).join(file),
            };
            let leads = match (file, anchor) {
                ("", anchor) => anchors(text).contains(anchor),
                (_, "") => path.exists(),
                (_, anchor) => {
                    fs::read_to_string(&path).is_ok_and(|text| anchors(&text).contains(anchor))
                }
            };
            if !leads {
                complaints.push(format!("{page}:{number}: {target} leads nowhere"));
            }
        }
    }
    complaints
}

/// The anchors of the headings of a page.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = prose(text).filter_map(|(_, line)| line.strip_prefix('#'));
    let titles = headings.map(|rest| rest.trim_start_matches('#').trim().to_lowercase());
    let anchors = titles.map(|title| {
        let kept = title
            .chars()
            .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
        kept.map(|c| if c == ' ' { '-' } else { c }).collect()
    });
    anchors.collect()
}
