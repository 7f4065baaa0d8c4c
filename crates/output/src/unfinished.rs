//! The temporary files of outputs that are not finished.
//!
//! A temporary file is removed when its owner is dropped. A program that has to end
//! without unwinding, as on a second Ctrl-C, drops nothing. So every temporary file
//! is registered here from before it exists until it is renamed or removed, and
//! [`remove_unfinished`] removes those that are registered. The registry is locked
//! while a file is created, renamed or removed: a program that keeps the lock until
//! it ends leaves each output either whole or as it was.

use std::fs::{self, File};
use std::io;
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::NamedTempFile;

/// How the name of every temporary file begins.
const PREFIX: &str = ".cyltrace-";

/// Whether a file has the name of a temporary file. While no process writes to it, it was left
/// behind by one that was killed.
#[must_use]
pub fn is_unfinished(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default();
    name.as_encoded_bytes().starts_with(PREFIX.as_bytes())
}

/// The temporary files that exist.
static REGISTERED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A registered temporary file.
#[derive(Debug)]
pub(super) struct UnfinishedFile {
    /// None once it has been renamed.
    file: Option<NamedTempFile>,
}

impl UnfinishedFile {
    /// Creates a temporary file with a new name.
    pub fn create_in(directory: &Path) -> io::Result<Self> {
        let mut registered = registered();
        let file = temporary_in(directory)?;
        registered.push(file.path().to_owned());
        Ok(Self { file: Some(file) })
    }

    /// The file itself. Its errors do not name it, as users have not named it.
    pub fn file(&mut self) -> &mut File {
        let file = self.file.as_mut().expect("persist consumes self");
        file.as_file_mut()
    }

    /// Moves the file to its place.
    pub fn persist(mut self, target: &Path) -> io::Result<()> {
        let mut registered = registered();
        let file = self.file.take().expect("persist consumes self");
        forget(&mut registered, file.path());
        // On failure the error owns the file and removes it when dropped.
        file.persist(target)
            .map(|_| ())
            .map_err(|error| error.error)
    }
}

impl Drop for UnfinishedFile {
    fn drop(&mut self) {
        if let Some(file) = self.file.take() {
            let mut registered = registered();
            forget(&mut registered, file.path());
            drop(file);
        }
    }
}

/// Removes the temporary files of all outputs that are not finished. None is
/// created or renamed while the returned guard lives, so a program that ends
/// without dropping it leaves none behind.
///
/// `None` if another thread has not released the registry within `patience`: the
/// file system does not respond, and the files cannot be removed.
pub fn remove_unfinished(patience: Duration) -> Option<UnfinishedGuard> {
    let start = Instant::now();
    let mut registered = loop {
        match REGISTERED.try_lock() {
            Ok(registered) => break registered,
            Err(TryLockError::Poisoned(poisoned)) => break poisoned.into_inner(),
            Err(TryLockError::WouldBlock) if start.elapsed() > patience => return None,
            Err(TryLockError::WouldBlock) => thread::sleep(Duration::from_millis(1)),
        }
    };
    for path in mem::take(&mut *registered) {
        // A file that cannot be removed stays; the program ends all the same.
        let _ = fs::remove_file(path);
    }
    Some(UnfinishedGuard { _lock: registered })
}

/// While it lives, no temporary file is created or renamed.
#[derive(Debug)]
pub struct UnfinishedGuard {
    _lock: MutexGuard<'static, Vec<PathBuf>>,
}

fn registered() -> MutexGuard<'static, Vec<PathBuf>> {
    // The list is whole after a panic: no step on it can panic half-way.
    REGISTERED.lock().unwrap_or_else(PoisonError::into_inner)
}

fn forget(registered: &mut Vec<PathBuf>, path: &Path) {
    registered.retain(|other| other != path);
}

fn temporary_in(directory: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    // Temporary files are private by default; this one is to be as readable
    // as the user's umask lets any file be.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(directory)
}
