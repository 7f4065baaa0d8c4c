//! Opens files that are read from beginning to end: regular files and pipes. It rejects
//! devices, because most never end, and named pipes without a writer.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use crate::scene::error::SceneError;

/// Opens a file or a pipe.
///
/// # Errors
/// If the file cannot be opened, is neither, or is a named pipe without a writer.
pub(in crate::scene) fn open(path: &Path) -> Result<File, SceneError> {
    open_any(path).map_err(|source| SceneError::Unreadable {
        path: path.to_owned(),
        source,
    })
}

fn open_any(path: &Path) -> io::Result<File> {
    // The kind is checked first: opening a pipe waits, and opening a device may have effects.
    let kind = fs::metadata(path)?.file_type();
    if kind.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if kind.is_file() {
        return File::open(path);
    }
    #[cfg(unix)]
    if std::os::unix::fs::FileTypeExt::is_fifo(&kind) {
        return open_pipe(path);
    }
    Err(io::Error::other(
        "it is a device or a socket: a file or a pipe is needed",
    ))
}

/// Opens a named pipe once a program writes to it.
#[cfg(unix)]
fn open_pipe(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;

    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
    use rustix::io::retry_on_intr;

    use crate::scene::limits::PIPE_PATIENCE;

    let file = File::options()
        .read(true)
        .custom_flags(OFlags::NONBLOCK.bits().cast_signed())
        .open(path)?;
    // A pipe is ready if it has bytes, or had a writer.
    let patience = Timespec {
        tv_sec: PIPE_PATIENCE.as_secs().cast_signed(),
        tv_nsec: 0,
    };
    let ready = retry_on_intr(|| poll(&mut [PollFd::new(&file, PollFlags::IN)], Some(&patience)))?;
    if ready == 0 {
        return Err(io::Error::other(format!(
            "it is a pipe that no program has written to for {} seconds",
            PIPE_PATIENCE.as_secs()
        )));
    }
    fcntl_setfl(&file, fcntl_getfl(&file)? - OFlags::NONBLOCK)?;
    Ok(file)
}
