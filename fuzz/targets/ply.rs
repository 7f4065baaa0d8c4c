//! See `cyltrace_fuzz::ply`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::ply(bytes));
