//! Sizes of memory as text.

use bytesize::ByteSize;

/// A number of bytes for people, in powers of ten.
#[must_use]
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

/// A size in bytes such as `500MB`, `4GiB`, `1.5 TB` or `1000`.
///
/// # Errors
/// If it is no such size, or 0: a message.
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
