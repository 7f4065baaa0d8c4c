//! See `cyltrace_fuzz::traced_scene`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::traced_scene(bytes));
