//! The memory of the program, and sizes of memory as text.

use std::fs;

use bytesize::ByteSize;
pub use cyltrace_output::readable;

/// The peak resident size of this process in bytes, if the system reports it as Linux
/// does.
pub fn peak_resident_bytes() -> Option<u64> {
    kibibytes_of(&fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// Resets the peak that [`peak_resident_bytes`] returns, if the system supports it.
pub fn forget_peak() {
    // Only Linux has this file. If it cannot be written, the peak remains that of the
    // whole run.
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// The bytes of a line such as `VmHWM:  1234 kB`; the kernel's kB are 1024 bytes.
pub fn kibibytes_of(status: &str, name: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// A size in bytes such as `500MB`, `4GiB`, `1.5 TB` or `1000`. The error is a message.
pub fn parse_size(text: &str) -> Result<u64, String> {
    let size: Option<ByteSize> = text.parse().ok();
    // `ByteSize` gives its greatest number for one beyond u64.
    size.map(|size| size.0)
        .filter(|&bytes| (1..u64::MAX).contains(&bytes))
        .ok_or_else(|| "it must be a number of bytes above 0, such as 500MB or 4GiB".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn status_with_peak_read_in_bytes() {
        let status = "Name:\tx\nVmPeak:\t  99 kB\nVmHWM:\t    1234 kB\nVmRSS:\t 5 kB\n";
        assert_eq!(kibibytes_of(status, "VmHWM:"), Some(1234 * 1024));
        assert_eq!(kibibytes_of("Name:\tx\n", "VmHWM:"), None);
    }

    #[test]
    fn readable_bytes_three_digits_and_unit() {
        for (bytes, text) in [
            (0, "0 B"),
            (999, "999 B"),
            (64_000, "64.0 kB"),
            (1_234_000_000, "1.2 GB"),
        ] {
            assert_eq!(readable(bytes), text);
        }
    }

    #[test]
    fn sizes_are_read_in_their_units_or_refused() {
        for (text, bytes) in [
            ("1", 1),
            ("64 kB", 64_000),
            ("64KiB", 65_536),
            ("4GiB", 4 << 30),
            ("1.5mb", 1_500_000),
            ("0.5 TiB", 1 << 39),
        ] {
            assert_eq!(parse_size(text), Ok(bytes), "{text}");
        }
        for text in [
            "",
            "0",
            "GiB",
            "-1",
            "1e9",
            "4 XB",
            "1.2.3MB",
            "99999999TiB",
            "0.1",
            "1e400",
            "inf",
        ] {
            assert!(parse_size(text).is_err(), "{text}");
        }
    }
}
