//! See `cyltrace_fuzz::obj`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::obj(bytes));
