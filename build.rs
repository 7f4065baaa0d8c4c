//! Finds Embree and generates its bindings.
fn main() {}
