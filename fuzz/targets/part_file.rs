//! See `cyltrace_fuzz::part_file`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::part_file(bytes));
