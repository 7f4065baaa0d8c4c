//! A page that needs nothing but itself.
//!
//! Colours follow the reader's preference for light or dark. Headings of tables
//! wrap, so that a dozen columns fit a page; a table that is still too wide
//! scrolls by itself, with a shadow at the edge behind which there is more.

use std::fmt::Write as _;

use base64::prelude::{BASE64_STANDARD, Engine as _};

/// The page's looks. Figures bring their own.
const STYLE: &str = "\
:root { color-scheme: light dark; --ink: #1c1e21; --paper: #ffffff; --faint: #6b7178; --rule: #d9dde2; --shade: #f3f5f7; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e6e9; --paper: #16181b; --faint: #9aa1a9; --rule: #363b41; --shade: #1f2226; } }
body { margin: 0 auto; padding: 1rem; max-width: 64rem; font: 16px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper); }
h1 { font-size: 1.5rem; line-height: 1.25; }
h2 { font-size: 1.15rem; margin-top: 2rem; }
p.note { color: var(--faint); font-size: 0.9rem; }
.wide { overflow-x: auto; margin: 1rem 0; background: linear-gradient(to right, var(--paper), var(--paper)) left / 1.5rem 100% no-repeat local, linear-gradient(to left, var(--paper), var(--paper)) right / 1.5rem 100% no-repeat local, linear-gradient(to right, var(--faint), transparent) left / 0.75rem 100% no-repeat scroll, linear-gradient(to left, var(--faint), transparent) right / 0.75rem 100% no-repeat scroll; }
.entry { overflow-wrap: anywhere; }
.entry code { display: block; color: var(--faint); font-size: 0.8rem; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(18rem, 1fr)); gap: 1rem; }
.pictures figure { margin: 0; }
.pictures img { display: block; width: 100%; image-rendering: pixelated; border: 1px solid var(--rule); }
figcaption { color: var(--faint); font-size: 0.9rem; }
.wide svg { display: block; width: 100%; min-width: 40rem; height: auto; }
table { border-collapse: collapse; font-size: 0.85rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.2rem 0.5rem; text-align: right; border-bottom: 1px solid var(--rule); }
td { white-space: nowrap; }
th { vertical-align: bottom; }
@media (max-width: 60rem) { th, td { padding: 0.2rem 0.3rem; font-size: 0.75rem; } }
th:first-child, td:first-child { text-align: left; position: sticky; left: 0; background: var(--paper); }
thead th { background: var(--shade); }
thead th:first-child { background: var(--shade); }
";

/// A page that is being written from top to bottom.
#[derive(Clone, Debug)]
pub struct Page {
    title: String,
    body: String,
}

impl Page {
    /// An empty page.
    #[must_use]
    pub fn new(title: &str) -> Self {
        let title = escape(title);
        let body = format!("<h1>{title}</h1>\n");
        Self { title, body }
    }

    /// Adds a heading.
    pub fn heading(&mut self, text: &str) {
        let _ = writeln!(self.body, "<h2>{}</h2>", escape(text));
    }

    /// Adds a paragraph.
    pub fn paragraph(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", escape(text));
    }

    /// Adds a paragraph of small print.
    pub fn note(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p class=\"note\">{}</p>", escape(text));
    }

    /// Adds an entry of a list: its first line as a paragraph, the others below
    /// as code, each on lines of its own and broken where they are too long.
    pub fn entry(&mut self, text: &str) {
        let mut lines = text.lines().map(|line| escape(line.trim()));
        let first = lines.next().unwrap_or_default();
        let others: String = lines.map(|line| format!("<code>{line}</code>")).collect();
        let _ = writeln!(self.body, "<p class=\"entry\">{first}{others}</p>");
    }

    /// Adds a figure that was made as SVG.
    pub fn figure(&mut self, svg: &str) {
        let _ = writeln!(self.body, "<div class=\"wide\">\n{svg}</div>");
    }

    /// Adds pictures beside one another, each the bytes of a PNG file and what
    /// it shows. They become part of the page.
    pub fn pictures(&mut self, pictures: &[(&[u8], &str)]) {
        self.body += "<div class=\"pictures\">\n";
        for (png, caption) in pictures {
            let (data, caption) = (BASE64_STANDARD.encode(png), escape(caption));
            let _ = writeln!(
                self.body,
                "<figure><img alt=\"{caption}\" src=\"data:image/png;base64,{data}\"><figcaption>{caption}</figcaption></figure>"
            );
        }
        self.body += "</div>\n";
    }

    /// Adds a table; its first column names the rows.
    pub fn table(&mut self, headings: &[impl AsRef<str>], rows: &[Vec<String>]) {
        let row = |tag: &str, cells: &mut dyn Iterator<Item = &str>| {
            let cells: String = cells
                .map(|cell| format!("<{tag}>{}</{tag}>", escape(cell)))
                .collect();
            format!("<tr>{cells}</tr>\n")
        };
        let head = row("th", &mut headings.iter().map(AsRef::as_ref));
        let body: String = rows
            .iter()
            .map(|cells| row("td", &mut cells.iter().map(String::as_str)))
            .collect();
        let _ = write!(
            self.body,
            "<div class=\"wide\"><table>\n<thead>\n{head}</thead>\n<tbody>\n{body}</tbody>\n</table></div>\n"
        );
    }

    /// The whole document.
    #[must_use]
    pub fn finish(&self) -> String {
        let Self { title, body } = self;
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n{body}</body>\n</html>\n"
        )
    }
}

/// Text that markup takes as text, in an element or an attribute.
#[must_use]
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            other => escaped.push(other),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn page_text_is_escaped_and_nothing_is_fetched() {
        let mut page = Page::new("a < b");
        page.heading("\"c\" & d");
        page.paragraph("<script>");
        page.table(&["name", "<n>"], &[vec!["x&y".into(), "1".into()]]);
        page.figure("<svg></svg>\n");
        page.entry("first <\n  second\n");
        let text = page.finish();
        for part in [
            "<title>a &lt; b</title>",
            "<h2>&quot;c&quot; &amp; d</h2>",
            "<p>&lt;script&gt;</p>",
            "<th>&lt;n&gt;</th>",
            "<td>x&amp;y</td>",
            "<svg></svg>",
            "first &lt;<code>second</code>",
            "prefers-color-scheme: dark",
        ] {
            assert!(text.contains(part), "no {part} in\n{text}");
        }
        for foreign in ["http", "src=", "@import", "url("] {
            assert!(!text.contains(foreign), "{foreign} in\n{text}");
        }
    }
}
