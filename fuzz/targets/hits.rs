//! See `cyltrace_fuzz::hits`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::hits(bytes));
