//! A 3MF file from outside: a zip archive, in which `_rels/.rels` names the part
//! that is the model, a text in XML.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::PathBuf;

use roxmltree::{Document, ParsingOptions};
use toml::Spanned;
use zip::ZipArchive;
use zip::result::ZipError;

use super::limits;
use crate::scene::error::SceneError;
use crate::scene::limits::{MOST_PART_BYTES, MOST_XML_NODES};
use crate::scene::names::{printable, quoted};
use crate::scene::source::Source;

const RELATIONSHIPS: &str = "_rels/.rels";
/// The type of the relationship that names the model.
const MODEL: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/// A part of the archive.
pub(super) struct Part {
    /// The archive's path and, below it, the part's.
    pub path: PathBuf,
    pub text: String,
}

/// Reads the model of the 3MF file that a scene file names.
pub(super) fn model_part(source: &Source, file: &Spanned<String>) -> Result<Part, SceneError> {
    let mut package = Package::open(source, file)?;
    let relationships = package.read(RELATIONSHIPS)?;
    let document = parsed(&relationships)?;
    let model = document
        .descendants()
        .filter(|node| {
            node.has_tag_name((
                "http://schemas.openxmlformats.org/package/2006/relationships",
                "Relationship",
            ))
        })
        .find(|node| node.attribute("Type") == Some(MODEL))
        .and_then(|node| node.attribute("Target"));
    let Some(model) = model else {
        return Err(package.error(format!("{RELATIONSHIPS} names no 3D model")));
    };
    package.read(model.trim_start_matches('/'))
}

/// The elements of a part.
pub(super) fn parsed(part: &Part) -> Result<Document<'_>, SceneError> {
    let error = |line: u64, message| SceneError::Row {
        path: part.path.clone(),
        line,
        column: None,
        message,
        help: None,
    };
    limits::check(&part.text).map_err(|(at, message)| {
        let before = &part.text.as_bytes()[..at];
        let line = before.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
        error(line, message)
    })?;
    let options = ParsingOptions {
        nodes_limit: MOST_XML_NODES,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(&part.text, options).map_err(|wrong| {
        let line = u64::from(wrong.pos().row);
        let wrong = printable(&wrong.to_string());
        error(line, format!("this is no XML: {wrong}"))
    })
}

/// An archive, and where the scene file names it.
struct Package<'a> {
    source: &'a Source,
    file: &'a Spanned<String>,
    path: PathBuf,
    archive: ZipArchive<BufReader<File>>,
}

impl<'a> Package<'a> {
    fn open(source: &'a Source, file: &'a Spanned<String>) -> Result<Self, SceneError> {
        let path = source.resolve(file.get_ref());
        let unreadable = |error: io::Error| {
            let path = path.clone();
            source.unreadable(
                file,
                SceneError::Unreadable {
                    path,
                    source: error,
                },
            )
        };
        let reader = BufReader::new(File::open(&path).map_err(unreadable)?);
        let archive = ZipArchive::new(reader).map_err(|error| match error {
            ZipError::Io(error) => unreadable(error),
            other => source.error_with_help(
                file.span(),
                format!("cannot read {}: {other}", path.display()),
                "a beam lattice is a .3mf file, which is a zip archive",
            ),
        })?;
        Ok(Self {
            source,
            file,
            path,
            archive,
        })
    }

    /// That something is wrong with the archive as a whole.
    fn error(&self, message: String) -> SceneError {
        let message = format!("{}: {message}", self.path.display());
        self.source.error(self.file.span(), message)
    }

    /// The name of a part as the archive has it: those of parts differ by more than case.
    fn stored_name(&self, name: &str) -> String {
        if self.archive.index_for_name(name).is_some() {
            return name.to_owned();
        }
        let stored = self.archive.file_names().filter_map(Result::ok);
        let mut same = stored.filter(|stored| stored.eq_ignore_ascii_case(name));
        same.next().map_or_else(|| name.to_owned(), Into::into)
    }

    /// The text of a part, without a byte order mark.
    fn read(&mut self, name: &str) -> Result<Part, SceneError> {
        let path = self.path.join(name);
        let mut bytes = Vec::new();
        let stored = self.stored_name(name);
        // A part is refused by the length that the archive states, and if that is not true,
        // once it has unpacked to more than the limit.
        let read = self.archive.by_name(&stored).and_then(|part| {
            let stated = part.size();
            if stated <= MOST_PART_BYTES {
                part.take(MOST_PART_BYTES + 1).read_to_end(&mut bytes)?;
            }
            Ok(stated.max(bytes.len() as u64))
        });
        match read {
            Ok(length) if length <= MOST_PART_BYTES => {}
            Ok(_) => {
                return Err(self.error(format!(
                    "{} is larger than {MOST_PART_BYTES} bytes, the most that is read",
                    quoted(name)
                )));
            }
            Err(ZipError::FileNotFound) => {
                return Err(self.error(format!("the archive holds no {}", quoted(name))));
            }
            Err(error) => {
                return Err(self.error(format!("cannot read {}: {error}", quoted(name))));
            }
        }
        let utf16 = bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]);
        let mut text = String::from_utf8(bytes).map_err(|error| {
            let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            SceneError::Encoding {
                path: path.clone(),
                line: before.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1,
                column: None,
                utf16,
            }
        })?;
        if text.starts_with('\u{feff}') {
            text.drain(..'\u{feff}'.len_utf8());
        }
        Ok(Part { path, text })
    }
}
