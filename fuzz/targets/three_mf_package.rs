//! See `cyltrace_fuzz::three_mf_package`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::three_mf_package(bytes));
