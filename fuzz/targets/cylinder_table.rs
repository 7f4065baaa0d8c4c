//! See `cyltrace_fuzz::cylinder_table`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::cylinder_table(bytes));
