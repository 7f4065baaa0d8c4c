//! Reads whole regular files, up to a size limit.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// The bytes of a file.
///
/// # Errors
/// If the file cannot be read, has more than `greatest` bytes, or is not a regular file. A
/// device may never end, and opening a pipe waits for a writer.
pub(super) fn read_regular(path: &Path, greatest: u64) -> io::Result<Vec<u8>> {
    let found = fs::metadata(path)?;
    if !found.is_file() {
        return Err(io::Error::other(
            "it is a device, a pipe or a socket: a regular file is needed",
        ));
    }
    if found.len() > greatest {
        return Err(too_large(greatest));
    }
    let mut bytes = Vec::with_capacity(usize::try_from(found.len()).unwrap_or(0));
    // The file may have grown since, and files in /proc report no size.
    File::open(path)?
        .take(greatest + 1)
        .read_to_end(&mut bytes)?;
    if bytes.len() as u64 > greatest {
        return Err(too_large(greatest));
    }
    Ok(bytes)
}

fn too_large(greatest: u64) -> io::Error {
    io::Error::other(format!("it has more than {greatest} bytes"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_up_to_the_greatest_size() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("file");
        fs::write(&path, "12345").expect("written");
        assert_eq!(read_regular(&path, 5).expect("read"), b"12345");
        let error = read_regular(&path, 4).expect_err("too large").to_string();
        assert_eq!(error, "it has more than 4 bytes");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn other_than_regular_files_are_rejected_without_reading() {
        for path in ["/dev/zero", "/dev/urandom", "/dev/null", "/"] {
            let error = read_regular(Path::new(path), 5).expect_err("no file");
            assert!(
                error.to_string().contains("regular file"),
                "{path}: {error}"
            );
        }
        // The file reports no size, and has more than 5 bytes.
        let error = read_regular(Path::new("/proc/self/status"), 5).expect_err("too large");
        assert_eq!(error.to_string(), "it has more than 5 bytes");
    }
}
