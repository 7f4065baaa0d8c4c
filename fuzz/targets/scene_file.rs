//! See `cyltrace_fuzz::scene_file`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::scene_file(bytes));
