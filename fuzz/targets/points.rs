//! See `cyltrace_fuzz::points`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::points(bytes));
