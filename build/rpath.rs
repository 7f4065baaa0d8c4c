//! The build script of the crates that link Embree by way of `cyltrace`: puts the library's
//! directory into their programs, where the loader would not look by itself.
//!
//! `build.rs` of the root does this for its own tests; cargo does not pass it on.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Set by the root's build script, `DEP_` and its `links` key in front.
    if let Ok(directory) = std::env::var("DEP_EMBREE_RUNTIME_DIR") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{directory}");
    }
}
