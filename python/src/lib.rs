//! The part of the Python package `cyltrace` that is in Rust, its module `_core`.
//!
//! The Python part validates shapes and types and documents everything; it hands over
//! contiguous arrays of f64. This part finds wrong rows, adds solids, traces and renders,
//! always without the interpreter's lock.

mod arrays;
mod check;
mod choice;
mod found;
mod picture;
mod placement;
mod rows;
mod scene;
mod shown;
mod solid;
mod statement;
mod tracer;
mod work;

use cyltrace::scene::GREATEST_RAYS;
use cyltrace_check::Class;
use pyo3::prelude::*;

/// See `python/cyltrace/_core.pyi`.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<scene::PyScene>()?;
    module.add_class::<solid::PySolid>()?;
    module.add_class::<tracer::PyTracer>()?;
    module.add_class::<found::Found>()?;
    module.add_class::<check::PyCheck>()?;
    module.add_class::<picture::PyInsets>()?;
    module.add_class::<picture::Rendered>()?;
    module.add_function(wrap_pyfunction!(check::check, module)?)?;
    module.add_function(wrap_pyfunction!(check::check_hits, module)?)?;
    module.add_function(wrap_pyfunction!(check::parse_size, module)?)?;
    module.add_function(wrap_pyfunction!(picture::render, module)?)?;
    module.add_function(wrap_pyfunction!(picture::png, module)?)?;
    module.add_function(wrap_pyfunction!(picture::write_picture, module)?)?;
    module.add("CHANNELS", picture::channels())?;
    let kinds: Vec<&str> = found::kinds().map(|kind| kind.name()).collect();
    module.add("SOLIDS", kinds)?;
    let parts: Vec<&str> = found::PARTS.iter().map(|part| part.name()).collect();
    module.add("PARTS", parts)?;
    let classes: Vec<&str> = Class::ALL.iter().map(|class| class.name()).collect();
    module.add("CLASSES", classes)?;
    module.add("GREATEST_RAYS", GREATEST_RAYS)?;
    module.add("VERSION", env!("CARGO_PKG_VERSION"))?;
    Ok(())
}
