//! Memory: what the program has used, and sizes as people write them.

use std::fs;

pub use cyltrace_output::readable;

/// The greatest resident size of this process so far, in bytes, where the
/// system tells it as Linux does.
pub fn peak_resident_bytes() -> Option<u64> {
    kibibytes_of(&fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// Has the system forget the greatest size so far, so that
/// [`peak_resident_bytes`] starts anew; without effect where it cannot.
pub fn forget_peak() {
    // Linux alone has this file, and a refusal leaves a peak that is too great
    // but true of the program as a whole.
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// The bytes of a line such as `VmHWM:  1234 kB`; the kernel's kB are 1024 bytes.
pub fn kibibytes_of(told: &str, name: &str) -> Option<u64> {
    let line = told.lines().find_map(|line| line.strip_prefix(name))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// A number of bytes as people write it: `500MB`, `4GiB`, `1.5 TB`, `1000`.
/// The error is a message.
pub fn parse_size(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, u64); 10] = [
        ("", 1),
        ("b", 1),
        ("kb", 1_000),
        ("mb", 1_000_000),
        ("gb", 1_000_000_000),
        ("tb", 1_000_000_000_000),
        ("kib", 1 << 10),
        ("mib", 1 << 20),
        ("gib", 1 << 30),
        ("tib", 1 << 40),
    ];
    let end = text
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(text.len());
    let (number, unit) = text.split_at(end);
    let unit = unit.trim().to_ascii_lowercase();
    let factor = UNITS.iter().find(|(name, _)| *name == unit);
    let bytes = match (number.parse::<u64>(), number.parse::<f64>(), factor) {
        (Ok(whole), _, Some((_, factor))) => whole.checked_mul(*factor),
        // Beyond u64 the conversion would give its greatest number.
        (_, Ok(part), Some((_, factor))) => Some(part * *factor as f64)
            .filter(|bytes| *bytes < u64::MAX as f64)
            .map(|bytes| bytes as u64),
        _ => None,
    };
    bytes
        .filter(|&bytes| bytes > 0)
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
