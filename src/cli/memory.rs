//! The memory that the program has used.

use std::fs;

/// The greatest resident size of this process so far, in bytes, where the
/// system tells it as Linux does.
pub fn peak_resident_bytes() -> Option<u64> {
    peak_in_status(&fs::read_to_string("/proc/self/status").ok()?)
}

/// The line `VmHWM:  1234 kB`; the kernel's kB are 1024 bytes.
fn peak_in_status(status: &str) -> Option<u64> {
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// A number of bytes for people, in powers of ten.
pub fn readable(bytes: u64) -> String {
    let units = ["B", "kB", "MB", "GB", "TB"];
    let mut value = bytes as f64;
    let mut unit = 0;
    while value >= 1000.0 && unit + 1 < units.len() {
        value /= 1000.0;
        unit += 1;
    }
    let decimals = usize::from(unit > 0 && value < 100.0);
    format!("{value:.decimals$} {}", units[unit])
}

/// A number of bytes from a text such as `500MB` or `4GiB`.
pub fn parse(text: &str) -> Result<u64, String> {
    const UNITS: [(&str, u64); 9] = [
        ("", 1),
        ("B", 1),
        ("kB", 1000),
        ("MB", 1_000_000),
        ("GB", 1_000_000_000),
        ("KiB", 1 << 10),
        ("MiB", 1 << 20),
        ("GiB", 1 << 30),
        ("TiB", 1 << 40),
    ];
    let end = text.find(|c: char| !c.is_ascii_digit());
    let (number, unit) = text.split_at(end.unwrap_or(text.len()));
    let unit = unit.trim();
    let factor = UNITS
        .iter()
        .find(|(name, _)| name.eq_ignore_ascii_case(unit));
    let number: Option<u64> = number.parse().ok();
    number
        .zip(factor)
        .and_then(|(number, (_, factor))| number.checked_mul(*factor))
        .filter(|&bytes| bytes > 0)
        .ok_or_else(|| "it must be a size such as 500MB or 4GiB".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_with_and_without_units() {
        for (text, bytes) in [
            ("1", 1),
            ("500MB", 500_000_000),
            ("4GiB", 4 << 30),
            ("64 kib", 64 << 10),
        ] {
            assert_eq!(parse(text), Ok(bytes));
        }
        for text in ["", "0", "GiB", "4 Gibberish", "-1", "99999999999TiB"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn status_with_peak_read_in_bytes() {
        let status = "Name:\tx\nVmPeak:\t  99 kB\nVmHWM:\t    1234 kB\nVmRSS:\t 5 kB\n";
        assert_eq!(peak_in_status(status), Some(1234 * 1024));
        assert_eq!(peak_in_status("Name:\tx\n"), None);
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
}
