//! The table of formats in `docs/formats.md` is what the library says of its formats.

use std::fmt::Write;
use std::path::Path;

use cyltrace::meshes::Format;
use cyltrace::scene::SOLID_FORMATS;

const BEGIN: &str = "<!-- formats: made from the code by tests/scenes/formats_table.rs -->\n";
const END: &str = "<!-- end of formats -->\n";

fn endings(extensions: &[&str]) -> String {
    let endings: Vec<_> = extensions.iter().map(|one| format!("`.{one}`")).collect();
    endings.join(", ")
}

fn table() -> String {
    let mut text = String::from("| files | contain | read by | written by |\n|---|---|---|---|\n");
    for format in SOLID_FORMATS {
        let endings = endings(format.extensions);
        let _ = writeln!(
            text,
            "| {endings} | {} | scenes (`[[{}]]`) | |",
            format.what, format.key
        );
    }
    for &format in Format::ALL {
        let written = match format.is_written() {
            true => "`tessellate`",
            false => "",
        };
        let endings = endings(&[format.extension()]);
        let _ = writeln!(
            text,
            "| {endings} | a mesh in {} | `check --mesh` | {written} |",
            format.name()
        );
    }
    text
}

/// `CYLTRACE_UPDATE=1 cargo test --release --test scenes formats_table` writes the table.
#[test]
fn table_of_formats_in_the_docs_is_that_of_the_code() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/formats.md");
    let text = std::fs::read_to_string(&path).expect("the document");
    let (before, rest) = text.split_once(BEGIN).expect("the beginning of the table");
    let (found, after) = rest.split_once(END).expect("the end of the table");
    if std::env::var_os("CYLTRACE_UPDATE").is_some() {
        std::fs::write(&path, [before, BEGIN, &table(), END, after].concat()).expect("written");
        return;
    }
    assert_eq!(found, table(), "the table in {}", path.display());
}
