//! The folder of the parts of a picture that one run of `render --workers` makes.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use cyltrace_output::is_unfinished;
use cyltrace_parts::Survey;

/// The file that a run locks, so that no other works in its folder.
const LOCK: &str = "lock";

/// A folder that is locked.
pub struct Folder {
    pub path: PathBuf,
    /// The lock is released when the file is closed.
    _lock: File,
}

impl Folder {
    /// Creates and locks the folder of a picture. One that is there already is used only if
    /// `is_resumed`.
    pub fn open(output: &Path, is_resumed: bool) -> anyhow::Result<Self> {
        let mut name = output.as_os_str().to_owned();
        name.push(".parts");
        let path = PathBuf::from(name);
        let is_there = path.exists();
        fs::create_dir_all(&path).with_context(|| format!("cannot create the folder {path:?}"))?;
        let lock = File::create(path.join(LOCK));
        let lock = lock.with_context(|| format!("cannot write into the folder {path:?}"))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => bail!("another run is making the parts in {path:?}"),
            // A file system without locks.
            Err(TryLockError::Error(_)) => {}
        }
        if is_there && !is_resumed {
            bail!(
                "{path:?} is there already, with parts of an earlier run: add --resume to use them, or remove it"
            );
        }
        Ok(Self { path, _lock: lock })
    }

    /// The number of parts of an earlier run with this fingerprint.
    pub fn earlier_parts(&self, fingerprint: Option<&str>) -> Option<u64> {
        let survey = Survey::of(&self.path).ok()?;
        let headers = survey.wholes.iter().map(|whole| whole.parts[0].header());
        let mut same = headers.filter(|header| Some(header.fingerprint.as_str()) == fingerprint);
        same.next().map(|header| header.number.of())
    }

    /// Removes parts and then the folder, if nothing else is in it.
    pub fn remove(self, parts: &[PathBuf]) -> anyhow::Result<()> {
        for part in parts {
            fs::remove_file(part).with_context(|| format!("cannot remove {part:?}"))?;
        }
        self.remove_if_empty();
        Ok(())
    }

    /// Removes the folder if it contains nothing but the lock and temporary files of processes
    /// that were killed. Returns whether it did.
    pub fn remove_if_empty(&self) -> bool {
        let Ok(entries) = fs::read_dir(&self.path) else {
            return false;
        };
        let own: Option<Vec<PathBuf>> = entries
            .map(|entry| {
                let path = entry.ok()?.path();
                let is_own = path.file_name()? == LOCK || is_unfinished(&path);
                is_own.then_some(path)
            })
            .collect();
        let Some(own) = own else {
            return false;
        };
        own.iter().all(|path| fs::remove_file(path).is_ok()) && fs::remove_dir(&self.path).is_ok()
    }
}
