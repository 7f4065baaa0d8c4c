//! The oracle and the families of hard cases.

mod cases;
mod composed;
mod placed;
