//! See `cyltrace_fuzz::command_line_numbers`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cyltrace_fuzz::command_line_numbers(bytes));
