//! Numbers on the command line. The program's own functions read them, from its own files:
//! a library has no use for them.

use cyltrace::scene::{GREATEST_PIXELS, GREATEST_THREADS};
use cyltrace::solid::tessellation::{GREATEST_SEGMENTS, LEAST_SEGMENTS};

#[allow(
    dead_code,
    unused_imports,
    reason = "most of it is about memory, not numbers"
)]
#[path = "../../crates/cli/src/memory.rs"]
mod memory;
#[path = "../../crates/cli/src/arguments/numbers.rs"]
mod numbers;

/// A number, as each kind of argument reads it: it is one within its limits, which reads
/// back when it is written, or there is a message.
///
/// # Panics
/// When something is wrong with what it becomes.
pub fn numbers(bytes: &[u8]) {
    // Arguments that are not UTF-8 are refused before.
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    if let Some(count) = judged(numbers::parse_threads(text)) {
        assert!(count.get() <= GREATEST_THREADS, "{count}");
        assert_eq!(numbers::parse_threads(&count.to_string()), Ok(count));
    }
    if let Some(seed) = judged(numbers::parse_seed(text)) {
        assert_eq!(numbers::parse_seed(&seed.to_string()), Ok(seed));
    }
    if let Some(length) = judged(numbers::parse_length(text)) {
        assert!(length.is_finite() && length >= 0.0, "{length}");
        assert_eq!(numbers::parse_length(&format!("{length:?}")), Ok(length));
    }
    if let Some(film) = judged(numbers::parse_size(text)) {
        let pixels = u64::from(film.width) * u64::from(film.height);
        assert!((1..=GREATEST_PIXELS).contains(&pixels), "{film:?}");
        let written = format!("{}x{}", film.width, film.height);
        assert_eq!(numbers::parse_size(&written), Ok(film));
    }
    if let Some(segments) = judged(numbers::parse_segments(text)) {
        assert!((LEAST_SEGMENTS..=GREATEST_SEGMENTS).contains(&segments));
    }
    if let Some(bytes) = judged(memory::parse_size(text)) {
        assert!(bytes > 0);
        assert_eq!(memory::parse_size(&bytes.to_string()), Ok(bytes));
    }
}

/// The number, or nothing where a message says what would be right.
fn judged<T>(outcome: Result<T, String>) -> Option<T> {
    match outcome {
        Ok(number) => Some(number),
        Err(message) => {
            assert!(message.starts_with("it must be "), "{message}");
            None
        }
    }
}
