//! A 3MF file from outside: a zip archive, in which `_rels/.rels` names the part
//! that is the model, a text in XML.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::PathBuf;

use roxmltree::Document;
use toml::Spanned;
use zip::ZipArchive;
use zip::result::ZipError;

use crate::scene::error::SceneError;
use crate::scene::names::quoted;
use crate::scene::source::Source;

const RELATIONSHIPS: &str = "_rels/.rels";
/// The type of the relationship that names the model.
const MODEL: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/// Most bytes of a part, some 16 million beams. A small archive may claim to hold
/// anything.
const MOST_BYTES: u64 = 1 << 30;

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
    Document::parse(&part.text).map_err(|error| SceneError::Row {
        path: part.path.clone(),
        line: u64::from(error.pos().row),
        column: None,
        message: format!("this is no XML: {error}"),
        help: None,
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

    /// The text of a part, without a byte order mark.
    fn read(&mut self, name: &str) -> Result<Part, SceneError> {
        let path = self.path.join(name);
        let mut bytes = Vec::new();
        let read = self.archive.by_name(name).and_then(|part| {
            let mut part = part.take(MOST_BYTES + 1);
            Ok(part.read_to_end(&mut bytes)?)
        });
        match read {
            Ok(_) => {}
            Err(ZipError::FileNotFound) => {
                return Err(self.error(format!("the archive holds no {}", quoted(name))));
            }
            Err(error) => {
                return Err(self.error(format!("cannot read {}: {error}", quoted(name))));
            }
        }
        if bytes.len() as u64 > MOST_BYTES {
            return Err(self.error(format!(
                "{} is larger than {MOST_BYTES} bytes, the most that is read",
                quoted(name)
            )));
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
