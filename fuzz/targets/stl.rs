//! See `cyltrace_fuzz::stl`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::stl(bytes));
