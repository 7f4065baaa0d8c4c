//! Solvers, the exact ones beside them, lanes and filters.

mod cone;
mod exact_solver;
mod filters;
mod flat;
mod lanes;
mod passing_lines;
mod pose;
mod start_of_range;
mod tessellation;
