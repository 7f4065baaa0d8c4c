//! See `cyltrace_fuzz::swc`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::swc(bytes));
