//! The C interface as a shared library, for C programs in this repository:
//! `cargo build --release --example cyltrace_c` makes
//! `target/release/examples/libcyltrace_c.so` from the library as it is
//! built already, in a second or two. For other programs there is
//! `cargo rustc --release --lib --crate-type cdylib`.

pub use cyltrace::capi::*;
