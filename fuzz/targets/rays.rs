//! See `cyltrace_fuzz::rays`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::rays(bytes));
