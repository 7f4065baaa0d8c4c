//! The zip archive of a 3MF file.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::PathBuf;

use toml::Spanned;
use zip::ZipArchive;
use zip::result::ZipError;

use super::part::Part;
use crate::scene::error::SceneError;
use crate::scene::limits::MOST_PART_BYTES;
use crate::scene::names::quoted;
use crate::scene::source::Source;

/// An archive, with its place in the scene file.
pub(super) struct Package<'a> {
    source: &'a Source,
    file: &'a Spanned<String>,
    path: PathBuf,
    archive: ZipArchive<BufReader<File>>,
}

impl<'a> Package<'a> {
    pub fn open(source: &'a Source, file: &'a Spanned<String>) -> Result<Self, SceneError> {
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

    /// An error of the archive as a whole.
    pub fn error(&self, message: String) -> SceneError {
        let message = format!("{}: {message}", self.path.display());
        self.source.error(self.file.span(), message)
    }

    /// The name of a part in the archive; case is ignored.
    fn stored_name(&self, name: &str) -> String {
        if self.archive.index_for_name(name).is_some() {
            return name.to_owned();
        }
        let stored = self.archive.file_names().filter_map(Result::ok);
        let mut same = stored.filter(|stored| stored.eq_ignore_ascii_case(name));
        same.next().map_or_else(|| name.to_owned(), Into::into)
    }

    /// The text of a part, without a byte order mark.
    pub fn read(&mut self, name: &str) -> Result<Part, SceneError> {
        let path = self.path.join(name);
        let mut bytes = Vec::new();
        let stored = self.stored_name(name);
        // The stated length of a part is checked before it is unpacked. It may be wrong, so
        // unpacking also stops at the limit.
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
                    "{} is larger than the limit of {MOST_PART_BYTES} bytes",
                    quoted(name)
                )));
            }
            Err(ZipError::FileNotFound) => {
                return Err(self.error(format!("the archive contains no {}", quoted(name))));
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
