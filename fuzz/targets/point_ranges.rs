//! See `cyltrace_fuzz::point_ranges`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::point_ranges(bytes));
