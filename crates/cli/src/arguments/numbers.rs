//! Numbers on the command line. The error of each function is a message that says what
//! would be right; clap names the argument.

use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};

use cyltrace::scene::{Film, GREATEST_PIXELS, GREATEST_THREADS};
use cyltrace::solid::tessellation::{GREATEST_SEGMENTS, LEAST_SEGMENTS};

/// Reads a whole number from 1 to `greatest`.
pub fn count_up_to<N: TryFrom<NonZeroU64>>(
    greatest: u64,
) -> impl Fn(&str) -> Result<N, String> + Clone + Send + Sync + 'static {
    move |text| {
        let count = text.parse().ok();
        count
            .filter(|count: &NonZeroU64| count.get() <= greatest)
            .and_then(|count| N::try_from(count).ok())
            .ok_or_else(|| format!("it must be a whole number from 1 to {greatest}"))
    }
}

/// A number of threads or processes.
pub fn parse_threads(text: &str) -> Result<NonZeroUsize, String> {
    count_up_to(GREATEST_THREADS as u64)(text)
}

/// A whole number of 64 bits.
pub fn parse_seed(text: &str) -> Result<u64, String> {
    let seed = text.parse();
    seed.map_err(|_| format!("it must be a whole number from 0 to {}", u64::MAX))
}

/// A number that is not negative.
pub fn parse_length(text: &str) -> Result<f64, String> {
    let length = text.parse();
    length
        .ok()
        .filter(|length: &f64| length.is_finite() && *length >= 0.0)
        .ok_or_else(|| "it must be a finite number from 0".to_owned())
}

/// Width and height of a picture: `1280x720`.
pub fn parse_size(text: &str) -> Result<Film, String> {
    let size = text.split_once(['x', 'X']).and_then(|(width, height)| {
        let width: NonZeroU32 = width.parse().ok()?;
        let height: NonZeroU32 = height.parse().ok()?;
        let pixels = u64::from(width.get()) * u64::from(height.get());
        (pixels <= GREATEST_PIXELS).then_some(Film {
            width: width.get(),
            height: height.get(),
        })
    });
    size.ok_or_else(|| {
        format!("it must be two whole numbers above 0, such as 1280x720, and at most {GREATEST_PIXELS} pixels")
    })
}

/// The number of sides of a mesh.
pub fn parse_segments(text: &str) -> Result<u32, String> {
    let segments = text.parse().ok();
    segments
        .filter(|segments| (LEAST_SEGMENTS..=GREATEST_SEGMENTS).contains(segments))
        .ok_or_else(|| {
            format!("it must be a whole number from {LEAST_SEGMENTS} to {GREATEST_SEGMENTS}")
        })
}
