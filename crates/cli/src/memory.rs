//! The memory of the program.

use std::fs;

pub use cyltrace_output::{parse_size, readable};

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn status_with_peak_read_in_bytes() {
        let status = "Name:\tx\nVmPeak:\t  99 kB\nVmHWM:\t    1234 kB\nVmRSS:\t 5 kB\n";
        assert_eq!(kibibytes_of(status, "VmHWM:"), Some(1234 * 1024));
        assert_eq!(kibibytes_of("Name:\tx\n", "VmHWM:"), None);
    }
}
