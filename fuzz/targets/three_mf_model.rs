//! See `cyltrace_fuzz::three_mf_model`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::three_mf_model(bytes));
