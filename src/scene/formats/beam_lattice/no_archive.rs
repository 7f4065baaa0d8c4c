//! 3MF files without the feature `three-mf`: an error that names the feature.

use std::convert::Infallible;

use toml::Spanned;

use super::part::Part;
use crate::scene::error::SceneError;
use crate::scene::source::Source;

/// An archive, which nothing can open.
pub(super) struct Package(Infallible);

impl Package {
    pub fn open(source: &Source, file: &Spanned<String>) -> Result<Self, SceneError> {
        let message = "this build of cyltrace cannot read 3MF files";
        let help = "enable the feature three-mf of the crate cyltrace";
        Err(source.error_with_help(file.span(), message, help))
    }

    pub fn error(&self, _message: String) -> SceneError {
        match self.0 {}
    }

    pub fn read(&mut self, _name: &str) -> Result<Part, SceneError> {
        match self.0 {}
    }
}
