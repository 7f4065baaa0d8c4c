//! Files that appear only when they are complete.
//!
//! What is written goes to a temporary file beside the target, which is
//! renamed at the end, so the old file stays whole until the new
//! one is. Devices and pipes, which cannot be replaced, are written
//! to directly.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::unfinished::UnfinishedFile;

/// An error when writing a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The directory of the file does not exist, or is not a directory.
    #[error("cannot write {path:?}: the directory {directory:?} does not exist")]
    NoDirectory {
        /// The path as given.
        path: PathBuf,
        /// Its directory.
        directory: PathBuf,
    },
    /// The path is a directory.
    #[error("cannot write {path:?}: it is a directory")]
    IsDirectory {
        /// The path as given.
        path: PathBuf,
    },
    /// No file can be created in the directory.
    #[error(
        "cannot write {path:?}: no file can be created in the directory {directory:?}: {reason}"
    )]
    Directory {
        /// The path as given.
        path: PathBuf,
        /// Its directory.
        directory: PathBuf,
        /// The system's error.
        reason: io::ErrorKind,
    },
    /// The file exists and is write-protected.
    #[error("cannot write {path:?}: the file exists and is write-protected")]
    WriteProtected {
        /// The path as given.
        path: PathBuf,
    },
    /// The system cannot create, write or rename the file.
    #[error("cannot write {path:?}")]
    System {
        /// The path as given.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
}

impl FileError {
    /// The error of a write to a new file, of the kind of `source`. It names the file as the
    /// user stated it, as the system's error does not.
    #[must_use]
    pub fn of_write(path: &Path, source: io::Error) -> io::Error {
        let (kind, path) = (source.kind(), path.into());
        io::Error::new(kind, Self::System { path, source })
    }
}

/// A file that will create or replace another. Unless [`NewFile::finish`] is
/// reached, nothing of it stays.
#[derive(Debug)]
pub struct NewFile {
    /// The file as the user stated it, which errors name.
    path: PathBuf,
    /// The same without symbolic links.
    target: PathBuf,
    writer: BufWriter<Sink>,
}

#[derive(Debug)]
enum Sink {
    Temporary(UnfinishedFile),
    Device(File),
}

impl NewFile {
    /// Checks that a file can be written to `path`, as far as possible without creating
    /// it.
    ///
    /// # Errors
    /// When the directory does not exist, `path` is a directory, or a file
    /// there may not be written to.
    pub fn check(path: &Path) -> Result<(), FileError> {
        let target = followed(path).map_err(|source| FileError::System {
            path: path.into(),
            source,
        })?;
        let directory = directory_of(&target);
        if !directory.is_dir() {
            return Err(FileError::NoDirectory {
                path: path.into(),
                directory: directory.into(),
            });
        }
        if path.is_dir() {
            return Err(FileError::IsDirectory { path: path.into() });
        }
        if let Ok(existing) = fs::metadata(path)
            && existing.is_file()
            && (existing.permissions().readonly()
                || fs::OpenOptions::new().write(true).open(path).is_err())
        {
            return Err(FileError::WriteProtected { path: path.into() });
        }
        Ok(())
    }

    /// Opens a temporary file beside `path`. A symbolic link stays one: the
    /// file that it names is replaced, or created where there is none.
    ///
    /// # Errors
    /// Those of [`NewFile::check`], or when the directory cannot be written
    /// to.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        Self::check(path)?;
        let system = |source| FileError::System {
            path: path.into(),
            source,
        };
        let existing = fs::metadata(path).ok();
        let is_device = existing.as_ref().is_some_and(|file| !file.is_file());
        let target = followed(path).map_err(system)?;
        let sink = if is_device {
            Sink::Device(File::create(&target).map_err(system)?)
        } else {
            let directory = directory_of(&target);
            // The system's own text would name the temporary file.
            let mut temporary =
                UnfinishedFile::create_in(directory).map_err(|error| FileError::Directory {
                    path: path.into(),
                    directory: directory.into(),
                    reason: error.kind(),
                })?;
            if let Some(existing) = existing {
                let permissions = existing.permissions();
                let file = temporary.file();
                file.set_permissions(permissions).map_err(system)?;
            }
            Sink::Temporary(temporary)
        };
        Ok(Self {
            path: path.into(),
            target,
            writer: BufWriter::with_capacity(1 << 16, sink),
        })
    }

    /// Whether nothing shows before [`NewFile::finish`]: not so for devices and
    /// pipes.
    #[must_use]
    pub fn is_replacing(&self) -> bool {
        matches!(self.writer.get_ref(), Sink::Temporary(_))
    }

    /// Writes what is buffered and moves the file to its place.
    ///
    /// # Errors
    /// When writing or renaming fails.
    pub fn finish(self) -> Result<(), FileError> {
        self.finish_with(|_| Ok(()))
    }

    /// As [`NewFile::finish`], and the file is on the disk when it gets its name: after a
    /// crash of the machine it is whole or absent.
    ///
    /// # Errors
    /// When writing, syncing or renaming fails.
    pub fn finish_synced(self) -> Result<(), FileError> {
        self.finish_with(|file| file.sync_all())
    }

    fn finish_with(self, ready: impl Fn(&File) -> io::Result<()>) -> Result<(), FileError> {
        let Self {
            path,
            target,
            writer,
        } = self;
        let sink = writer.into_inner().map_err(io::IntoInnerError::into_error);
        let renamed = match sink {
            Ok(Sink::Temporary(mut file)) => {
                ready(file.file()).and_then(|()| file.persist(&target))
            }
            Ok(Sink::Device(_)) => Ok(()),
            Err(error) => Err(error),
        };
        renamed.map_err(|source| FileError::System { path, source })
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

impl Seek for NewFile {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.writer.seek(position)
    }
}

impl Sink {
    fn file(&mut self) -> &mut File {
        match self {
            Self::Temporary(file) => file.file(),
            Self::Device(file) => file,
        }
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file().flush()
    }
}

impl Seek for Sink {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.file().seek(position)
    }
}

/// The path that symbolic links lead to, whether a file exists there or not.
///
/// # Errors
/// When a link cannot be read, or links lead in a circle.
pub fn followed(path: &Path) -> io::Result<PathBuf> {
    /// As many as Linux follows.
    const MOST_LINKS: usize = 40;
    if let Ok(existing) = fs::canonicalize(path) {
        return Ok(existing);
    }
    let mut path = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        if !path.is_symlink() {
            return Ok(path);
        }
        path = directory_of(&path).join(fs::read_link(&path)?);
    }
    Err(io::Error::other("its symbolic links lead in a circle"))
}

/// The directory that a file lies in: `.` for a bare name.
fn directory_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names_in(directory: &Path) -> Vec<PathBuf> {
        let entries = fs::read_dir(directory).expect("readable directory");
        entries.map(|entry| entry.expect("entry").path()).collect()
    }

    #[test]
    fn new_file_dropped_unfinished_nothing_left_and_old_file_kept() {
        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("old");
        fs::write(&path, "old").expect("written");
        let mut file = NewFile::create(&path).expect("created");
        file.write_all(b"new").expect("written");
        drop(file);
        assert_eq!(names_in(directory.path()), std::slice::from_ref(&path));
        assert_eq!(fs::read(&path).expect("read"), b"old");
    }

    #[test]
    fn new_file_finished_replaces_the_old_one() {
        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("old");
        fs::write(&path, "old").expect("written");
        let mut file = NewFile::create(&path).expect("created");
        file.write_all(b"new").expect("written");
        file.finish().expect("finished");
        assert_eq!(names_in(directory.path()), std::slice::from_ref(&path));
        assert_eq!(fs::read(&path).expect("read"), b"new");
    }

    #[cfg(unix)]
    #[test]
    fn new_file_keeps_the_permissions_of_the_old_one() {
        use std::os::unix::fs::PermissionsExt;
        let directory = tempfile::tempdir().expect("directory");
        let mode_of = |path: &Path| fs::metadata(path).expect("there").permissions().mode() & 0o777;
        let replace = |path: &Path| NewFile::create(path).and_then(NewFile::finish);

        let old = directory.path().join("old");
        for mode in [0o600, 0o640, 0o664, 0o755, 0o200] {
            fs::write(&old, "old").expect("written");
            fs::set_permissions(&old, fs::Permissions::from_mode(mode)).expect("set");
            replace(&old).expect("replaced");
            assert_eq!(mode_of(&old), mode, "{mode:o}");
        }
        let (ours, plain) = (
            directory.path().join("ours"),
            directory.path().join("plain"),
        );
        replace(&ours).expect("created");
        fs::write(&plain, "").expect("written");
        assert_eq!(mode_of(&ours), mode_of(&plain), "not the umask's");
    }

    #[cfg(unix)]
    #[test]
    fn new_file_over_a_protected_one_refused_and_old_file_kept() {
        use std::os::unix::fs::PermissionsExt;
        let directory = tempfile::tempdir().expect("directory");
        let path = directory.path().join("old");
        fs::write(&path, "old").expect("written");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).expect("set");
        let message = NewFile::create(&path).expect_err("protected").to_string();
        assert!(message.contains("is write-protected"), "{message}");
        assert_eq!(names_in(directory.path()), std::slice::from_ref(&path));
        assert_eq!(fs::read(&path).expect("read"), b"old");
    }

    /// Nobody creates files in /proc, not even the superuser.
    #[cfg(target_os = "linux")]
    #[test]
    fn new_file_in_a_protected_directory_refused_without_internal_names() {
        let message = NewFile::create(Path::new("/proc/new.csv"))
            .expect_err("not for us")
            .to_string();
        assert!(message.contains("in the directory \"/proc\""), "{message}");
        assert!(message.contains("/proc/new.csv"), "{message}");
        assert!(!message.contains(".cyltrace-"), "{message}");
    }

    #[cfg(unix)]
    #[test]
    fn new_file_through_a_link_or_device_keeps_them() {
        use std::os::unix::fs::{FileTypeExt, symlink};
        let directory = tempfile::tempdir().expect("directory");
        let (target, link) = (
            directory.path().join("target"),
            directory.path().join("link"),
        );
        fs::write(&target, "old").expect("written");
        symlink(&target, &link).expect("linked");
        let mut file = NewFile::create(&link).expect("created");
        file.write_all(b"new").expect("written");
        file.finish().expect("finished");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&target).expect("read"), b"new");

        let null = directory.path().join("null");
        symlink("/dev/null", &null).expect("linked");
        NewFile::create(&null)
            .and_then(NewFile::finish)
            .expect("written");
        let null = fs::metadata("/dev/null").expect("there");
        assert!(null.file_type().is_char_device());
    }

    #[cfg(unix)]
    #[test]
    fn new_file_through_a_dangling_link_creates_what_the_link_names() {
        use std::os::unix::fs::symlink;
        let directory = tempfile::tempdir().expect("directory");
        let within = |name: &str| directory.path().join(name);
        fs::create_dir(within("elsewhere")).expect("created");
        symlink("elsewhere/target", within("inner")).expect("linked");
        symlink("inner", within("outer")).expect("linked");
        let mut file = NewFile::create(&within("outer")).expect("created");
        file.write_all(b"new").expect("written");
        file.finish().expect("finished");
        assert!(within("outer").is_symlink() && within("inner").is_symlink());
        let written = fs::read(within("elsewhere/target")).expect("read");
        assert_eq!(written, b"new");

        symlink("missing/target", within("lost")).expect("linked");
        let message = NewFile::create(&within("lost"))
            .expect_err("lost")
            .to_string();
        assert!(message.contains("does not exist"), "{message}");
        symlink("circle", within("circle")).expect("linked");
        let error = NewFile::create(&within("circle")).expect_err("circular");
        assert!(format!("{error:?}").contains("circle"), "{error:?}");
    }

    #[test]
    fn new_file_in_unusable_places_refused_by_name() {
        let directory = tempfile::tempdir().expect("directory");
        let missing = directory.path().join("missing/file");
        let message = NewFile::create(&missing)
            .expect_err("no directory")
            .to_string();
        assert!(
            message.contains("does not exist") && message.contains("missing"),
            "{message}"
        );
        let message = NewFile::create(directory.path())
            .expect_err("taken")
            .to_string();
        assert!(message.contains("is a directory"), "{message}");
    }
}
